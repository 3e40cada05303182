//! Estimates the current place of the finger from late, infrequent and noisy touch samples.
//!
//! A Kalman filter of place, velocity and acceleration along each axis. The acceleration is random and decays with a
//! time constant (R. A. Singer, IEEE Transactions on Aerospace and Electronic Systems 6(4), 1970, 473). Both axes share
//! the covariance. It grows with the time between samples, so that after a lost sample, the filter gives the next one
//! more weight; a filter with constant gains does not.

/// Time constant of the finger's acceleration, in s. From 0.03 to 0.1, the error on human strokes changes by only a
/// twentieth.
const ACCELERATION_S: f32 = 0.04;
/// Standard deviation of the acceleration of a finger at rest, in m/s^2.
const ACCELERATION_M_PER_S2: f32 = 0.3;
/// Standard deviation of the acceleration per m/s of recent speed, in 1/s, added to that of a finger at rest, since a
/// fast finger also turns fast. On strokes with the acceleration of smoothed recordings, the error is smallest at 4 to
/// 8; with that of unsmoothed ones, at 12 to 20 (`docs/design/touch.md`).
const ACCELERATION_PER_SPEED_PER_S: f32 = 8.0;
/// Time constant with which the recent speed decays, in s.
const RECENT_S: f32 = 0.5;
/// Standard deviation of a measured place, in m: between the 0.02 mm of an infrared frame and the quantisation of a
/// screen with pixels of 0.18 mm (0.18 mm over the root of 12).
const MEASURED_M: f32 = 0.05e-3;
/// Standard deviation of the time of a sample, in intervals between reports.
const JITTER_INTERVALS: f32 = 0.04;
/// Standard deviation of the velocity of a finger at touch-down, in m/s.
const FIRST_VELOCITY_M_PER_S: f32 = 0.3;
/// Distance from the expected place, in m, beyond which a sample belongs to another touch and restarts the filter.
const JUMP_M: f32 = 5e-3;
/// Longest step for which the transition is computed, in units of [`ACCELERATION_S`]. Tracks are shorter.
const STEP_MAX: f32 = 3.0;

/// Singer's transition of place, velocity and acceleration over a time.
#[derive(Clone, Copy, Debug)]
struct Transition {
    time_s: f32,
    /// Fraction of the acceleration that remains.
    remainder: f32,
    /// Velocity per initial acceleration, in s.
    velocity_s: f32,
    /// Place per initial acceleration, in s^2.
    place_s2: f32,
}

impl Transition {
    /// The transition over a time of 0 or more.
    fn over(time_s: f32) -> Self {
        let x = time_s * (1.0 / ACCELERATION_S);
        let x = if x < STEP_MAX { x } else { STEP_MAX };
        // Quotients for (1 - e^-x) / x and (x - 1 + e^-x) / x^2 without cancellation; their errors are below 4 % up to
        // 3.
        let velocity = 1.0 / (1.0 + x * (0.5 + x * (1.0 / 12.0)));
        let place = 1.0 / (2.0 + x * (2.0 / 3.0 + x * (1.0 / 18.0)));
        Self { time_s, remainder: 1.0 - x * velocity, velocity_s: time_s * velocity, place_s2: time_s * time_s * place }
    }
}

/// Position, velocity and acceleration along one axis, in m, m/s and m/s^2.
#[derive(Clone, Copy, Debug)]
struct Axis {
    position: f32,
    velocity: f32,
    acceleration: f32,
}

impl Axis {
    const ZERO: Self = Self { position: 0.0, velocity: 0.0, acceleration: 0.0 };

    fn after(&self, step: &Transition) -> Self {
        Self {
            position: self.position + step.time_s * self.velocity + step.place_s2 * self.acceleration,
            velocity: self.velocity + step.velocity_s * self.acceleration,
            acceleration: step.remainder * self.acceleration,
        }
    }

    /// Corrects the state by a measured position. Gains are in 1, 1/s and 1/s^2.
    fn correct(&mut self, measured: f32, [position, velocity, acceleration]: [f32; 3]) {
        let residual = measured - self.position;
        self.position += position * residual;
        self.velocity += velocity * residual;
        self.acceleration += acceleration * residual;
    }
}

/// Covariance of position `p`, velocity `v` and acceleration `a`, in SI units; the same for both axes.
#[derive(Clone, Copy, Debug)]
struct Covariance {
    pp: f32,
    pv: f32,
    pa: f32,
    vv: f32,
    va: f32,
    aa: f32,
}

impl Covariance {
    const ZERO: Self = Self { pp: 0.0, pv: 0.0, pa: 0.0, vv: 0.0, va: 0.0, aa: 0.0 };

    /// After the first sample of a finger.
    fn first(acceleration_variance: f32) -> Self {
        let vv = FIRST_VELOCITY_M_PER_S * FIRST_VELOCITY_M_PER_S;
        Self { pp: MEASURED_M * MEASURED_M, vv, aa: acceleration_variance, ..Self::ZERO }
    }

    fn advance(&mut self, step: &Transition, acceleration_variance: f32) {
        let Transition { time_s: t, remainder: a, velocity_s: c, place_s2: b } = *step;
        let Self { pp, pv, pa, vv, va, aa } = *self;
        let pa_before_decay = pa + t * va + b * aa;
        let va_before_decay = va + c * aa;
        // Process noise: the variance added to the acceleration in a step, spread evenly over the step.
        let (t2, gained) = (t * t, acceleration_variance * (1.0 - a * a));
        *self = Self {
            pp: pp + t * (2.0 * pv + t * vv) + b * (2.0 * (pa + t * va) + b * aa) + gained * t2 * t2 * (1.0 / 20.0),
            pv: pv + t * vv + b * va + c * pa_before_decay + gained * t2 * t * (1.0 / 8.0),
            pa: a * pa_before_decay + gained * t2 * (1.0 / 6.0),
            vv: vv + c * (va + va_before_decay) + gained * t2 * (1.0 / 3.0),
            va: a * va_before_decay + gained * t * 0.5,
            aa: a * a * aa + gained,
        };
    }

    /// Includes a measurement of the position with this variance, and returns the gains.
    fn correct(&mut self, measured_variance: f32) -> [f32; 3] {
        let per_variance = 1.0 / (self.pp + measured_variance);
        let gains = [self.pp * per_variance, self.pv * per_variance, self.pa * per_variance];
        let [_, velocity, acceleration] = gains;
        self.vv -= velocity * self.pv;
        self.va -= velocity * self.pa;
        self.aa -= acceleration * self.pa;
        let rest = measured_variance * per_variance;
        self.pp *= rest;
        self.pv *= rest;
        self.pa *= rest;
        gains
    }
}

/// Place, velocity and half the acceleration of the finger, in m, m/s and m/s^2 along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) place_m: [f32; 2],
    pub(crate) velocity_m_per_s: [f32; 2],
    pub(crate) half_acceleration_m_per_s2: [f32; 2],
}

/// The filter's state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Estimator {
    axes: [Axis; 2],
    covariance: Covariance,
    /// Largest recent speed, in m/s.
    recent_m_per_s: f32,
    /// Samples since the first one, or since the finger jumped.
    samples: u32,
    sampled_at_tick: u32,
}

impl Estimator {
    /// An estimator without samples.
    pub(crate) const NEW: Self = Self {
        axes: [Axis::ZERO; 2],
        covariance: Covariance::ZERO,
        recent_m_per_s: 0.0,
        samples: 0,
        sampled_at_tick: 0,
    };

    /// Resets the filter: the next position is the first of another finger.
    pub(crate) fn forget(&mut self) {
        self.samples = 0;
    }

    /// Includes a position in m measured at a tick. Returns `false` for a sample that is not newer than the last one,
    /// which is ignored.
    pub(crate) fn take(&mut self, place_m: [f32; 2], at_tick: u32, tick_period_s: f32, interval_s: f32) -> bool {
        let step_ticks = at_tick.wrapping_sub(self.sampled_at_tick) as i32;
        if self.samples > 0 && step_ticks <= 0 {
            return false;
        }
        self.sampled_at_tick = at_tick;
        if self.samples > 0 {
            self.follow(place_m, step_ticks as f32 * tick_period_s, interval_s);
        } else {
            self.begin(place_m);
        }
        true
    }

    /// Time from the last sample to one measured at a tick, in s.
    pub(crate) fn time_to_s(&self, at_tick: u32, tick_period_s: f32) -> f32 {
        at_tick.wrapping_sub(self.sampled_at_tick) as i32 as f32 * tick_period_s
    }

    /// Takes the first position.
    fn begin(&mut self, place_m: [f32; 2]) {
        self.samples = 1;
        self.recent_m_per_s = 0.0;
        self.covariance = Covariance::first(ACCELERATION_M_PER_S2 * ACCELERATION_M_PER_S2);
        self.axes = place_m.map(|position| Axis { position, ..Axis::ZERO });
    }

    /// Whether the velocity was known before the last sample.
    pub(crate) fn expected_last(&self) -> bool {
        self.samples > 2
    }

    /// The finger's state a time after the last sample, in s.
    pub(crate) fn after(&self, time_s: f32) -> Estimate {
        let step = Transition::over(time_s);
        let axes = self.axes.map(|axis| axis.after(&step));
        Estimate {
            place_m: axes.map(|axis| axis.position),
            velocity_m_per_s: axes.map(|axis| axis.velocity),
            half_acceleration_m_per_s2: axes.map(|axis| 0.5 * axis.acceleration),
        }
    }

    /// Includes a position measured `step_s` after the last one.
    fn follow(&mut self, place_m: [f32; 2], step_s: f32, interval_s: f32) {
        self.recent_m_per_s *= RECENT_S / (RECENT_S + step_s);
        let acceleration = ACCELERATION_M_PER_S2 + ACCELERATION_PER_SPEED_PER_S * self.recent_m_per_s;
        let jitter_m = JITTER_INTERVALS * interval_s * self.recent_m_per_s;
        let step = Transition::over(step_s);
        self.axes = self.axes.map(|axis| axis.after(&step));
        if self.axes.iter().zip(place_m).any(|(axis, place_m)| (place_m - axis.position).abs() > JUMP_M) {
            self.begin(place_m);
            return;
        }
        self.samples = self.samples.saturating_add(1);
        self.covariance.advance(&step, acceleration * acceleration);
        let gains = self.covariance.correct(MEASURED_M * MEASURED_M + jitter_m * jitter_m);
        for (axis, place_m) in self.axes.iter_mut().zip(place_m) {
            axis.correct(place_m, gains);
        }
        let speed = about_length(self.axes.map(|axis| axis.velocity));
        if speed > self.recent_m_per_s {
            self.recent_m_per_s = speed;
        }
    }
}

/// Length of a vector, within 8 %; the standard deviations above are no more accurate.
fn about_length([x, y]: [f32; 2]) -> f32 {
    let (x, y) = (x.abs(), y.abs());
    if x > y { x + 0.4 * y } else { y + 0.4 * x }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK_S: f32 = 25e-6;
    const INTERVAL_S: f32 = 10e-3;

    fn take(estimator: &mut Estimator, tick: u32, place_m: [f32; 2]) -> bool {
        estimator.take(place_m, tick, TICK_S, INTERVAL_S)
    }

    /// Place and velocity along x at a tick.
    fn x(estimator: &Estimator, tick: u32) -> (f32, f32) {
        let estimate = estimator.after(tick.wrapping_sub(estimator.sampled_at_tick) as f32 * TICK_S);
        (estimate.place_m[0], estimate.velocity_m_per_s[0])
    }

    /// Feeds exact samples of `path` at 100 Hz, 400 ticks late, and returns the error at the end.
    fn error_m(path: impl Fn(f32) -> f32, samples: u32) -> f32 {
        let mut estimator = Estimator::NEW;
        for i in 0..samples {
            let tick = 1000 + 400 * i;
            take(&mut estimator, tick, [path(tick as f32 * TICK_S), 0.0]);
        }
        let now = 1000 + 400 * samples + 300;
        (x(&estimator, now).0 - path(now as f32 * TICK_S)).abs()
    }

    #[test]
    fn a_steady_finger_is_found_from_the_second_sample_on() {
        for samples in [2, 3, 4, 5, 20, 200] {
            assert!(error_m(|t| 0.01 + 0.1 * t, samples) < 2e-6, "{samples}");
        }
    }

    /// The filter lets an acceleration decay, because no hand accelerates for long. Under 0.4 m/s^2 a filter without an
    /// acceleration would be wrong by 0.1 mm: over the 17.5 ms since the last sample and half an interval before it.
    #[test]
    fn constant_acceleration_leaves_a_small_error() {
        let found_m = error_m(|t| 0.01 + 0.02 * t + 0.2 * t * t, 40);
        assert!(found_m < 60e-6, "{found_m}");
    }

    #[test]
    fn the_transition_is_the_exponential_one() {
        for step in 1..110 {
            let time_s = 1e-3 * step as f32;
            let x = f64::from(time_s) / f64::from(ACCELERATION_S);
            let Transition { remainder, velocity_s, place_s2, .. } = Transition::over(time_s);
            let decay = (-x).exp();
            let close = |found: f32, expected: f64, within: f64| {
                assert!((f64::from(found) - expected).abs() <= within, "{time_s} s: {found}, expected {expected}");
            };
            close(remainder, decay, 0.03);
            close(velocity_s / time_s, (1.0 - decay) / x, 0.03);
            close(place_s2 / (time_s * time_s), (x - 1.0 + decay) / (x * x), 0.01);
        }
    }

    /// The covariance depends only on the times of the samples, and stays positive for any of them.
    #[test]
    fn the_covariance_stays_positive() {
        for (ticks, speed) in [(5, 0.0), (80, 0.1), (400, 1.0), (3_999, 0.3)] {
            let mut estimator = Estimator::NEW;
            for i in 0..20_000_u32 {
                // A sample in three is a tick after the one before.
                let tick = ticks * i + if i % 3 == 0 { ticks - 1 } else { 0 };
                take(&mut estimator, tick, [speed * tick as f32 * TICK_S, 0.0]);
                let Covariance { pp, pv, pa, vv, va, aa } = estimator.covariance;
                assert!(pp > 0.0 && vv > 0.0 && aa > 0.0, "{ticks}: {:?}", estimator.covariance);
                let within = |cross: f32, a: f32, b: f32| cross * cross <= a * b * 1.01;
                assert!(within(pv, pp, vv) && within(pa, pp, aa) && within(va, vv, aa), "{:?}", estimator.covariance);
            }
        }
    }

    #[test]
    fn repeated_and_backward_samples_change_nothing() {
        let mut estimator = Estimator::NEW;
        take(&mut estimator, 1000, [0.01, 0.01]);
        assert!(take(&mut estimator, 1400, [0.02, 0.01]));
        let before = estimator.after(0.01);
        assert!(!take(&mut estimator, 1400, [0.5, 0.5]));
        assert!(!take(&mut estimator, 1399, [0.5, 0.5]));
        assert_eq!(estimator.after(0.01), before);
    }
}
