//! Estimates where the finger is now from touch samples that are late, rare and noisy.
//!
//! A fading-memory polynomial filter of second degree (g-h-k filter, Brookner, *Tracking and Kalman Filtering Made
//! Easy*, 1998, ch. 1): it fits position, velocity and acceleration to the samples so far, each weighted less by
//! [`FADING`] than the one after it, and is read at any later tick. For the first samples its gains are those of a
//! growing memory, so that it is right from the second sample on.

/// Factor on the weight of all samples so far when another one arrives. With samples at 100 Hz, 10 ms late, noise 0.02
/// mm and jitter 0.5 ms, values from 0.5 to 0.7 are within a tenth of the best for strokes from constant speed to
/// minimum-jerk.
const FADING: f32 = 0.65;

/// For the first samples, up to this number, the gains are those of a growing memory of first degree: a fit of second
/// degree to so few samples amplifies noise too much.
const LINEAR_SAMPLES: u32 = 3;

/// Position, velocity and half the acceleration along one axis, in m, m/s and m/s^2, at the time of the last sample.
#[derive(Clone, Copy, Debug)]
struct Axis {
    position: f32,
    velocity: f32,
    half_acceleration: f32,
}

/// Gains of one update: parts of the residual that go to the position, to the velocity per step, and to half the
/// acceleration per step squared.
#[derive(Clone, Copy, Debug)]
struct Gains {
    position: f32,
    velocity: f32,
    half_acceleration: f32,
}

impl Gains {
    /// Gains of the first sample: it sets the position.
    const OF_FIRST_SAMPLE: Self = Self { position: 1.0, velocity: 0.0, half_acceleration: 0.0 };

    /// The same gains in 1, 1/s and 1/s^2, for so many steps a second.
    fn per_step(&self, per_s: f32) -> Self {
        Self {
            position: self.position,
            velocity: self.velocity * per_s,
            half_acceleration: self.half_acceleration * per_s * per_s,
        }
    }
}

impl Axis {
    const ZERO: Self = Self { position: 0.0, velocity: 0.0, half_acceleration: 0.0 };

    /// Position and velocity at a time after the last sample.
    fn at(&self, time_s: f32) -> (f32, f32) {
        let half_gain = time_s * self.half_acceleration;
        let mean_velocity = self.velocity + half_gain;
        (self.position + time_s * mean_velocity, mean_velocity + half_gain)
    }

    /// Takes a measured position `step_s` after the last sample. Gains are in 1, 1/s and 1/s^2.
    fn update(&mut self, measured: f32, step_s: f32, gains: &Gains) {
        let (position, velocity) = self.at(step_s);
        let residual = measured - position;
        self.position = position + gains.position * residual;
        self.velocity = velocity + gains.velocity * residual;
        self.half_acceleration += gains.half_acceleration * residual;
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
    samples: u32,
    sampled_at_tick: u32,
}

impl Estimator {
    /// An estimator without samples.
    pub(crate) const NEW: Self = Self { axes: [Axis::ZERO; 2], samples: 0, sampled_at_tick: 0 };

    /// Takes a position in m that was measured at a tick, and estimates the finger at that tick. Ignores a sample that
    /// is not newer than the last one, and returns `None`.
    ///
    /// Time steps shorter than `step_min_s` count as `step_min_s`: samples that arrive bunched were not measured so
    /// close together.
    pub(crate) fn take(
        &mut self,
        place_m: [f32; 2],
        at_tick: u32,
        tick_period_s: f32,
        step_min_s: f32,
    ) -> Option<Estimate> {
        let (mut step_s, mut weights) = (0.0, Gains::OF_FIRST_SAMPLE);
        if self.samples > 0 {
            let step_ticks = at_tick.wrapping_sub(self.sampled_at_tick) as i32;
            if step_ticks <= 0 {
                return None;
            }
            step_s = step_ticks as f32 * tick_period_s;
            let per_s = 1.0 / if step_s > step_min_s { step_s } else { step_min_s };
            weights = gains(self.samples).per_step(per_s);
        }
        self.samples = self.samples.saturating_add(1);
        self.sampled_at_tick = at_tick;
        for (axis, place_m) in self.axes.iter_mut().zip(place_m) {
            axis.update(place_m, step_s, &weights);
        }
        Some(self.estimate())
    }

    /// The finger at the time of the last sample.
    fn estimate(&self) -> Estimate {
        Estimate {
            place_m: self.axes.map(|axis| axis.position),
            velocity_m_per_s: self.axes.map(|axis| axis.velocity),
            half_acceleration_m_per_s2: self.axes.map(|axis| axis.half_acceleration),
        }
    }
}

/// Gains for the sample after `samples` others.
fn gains(samples: u32) -> &'static Gains {
    GAINS.get(samples as usize).unwrap_or(&FADING_GAINS)
}

/// Gains for the first samples, indexed by the number of samples before.
static GAINS: [Gains; FADING_SAMPLES] = {
    let mut gains = [FADING_GAINS; FADING_SAMPLES];
    let mut samples = 0;
    while samples < FADING_SAMPLES {
        gains[samples] = growing_gains(samples as u32);
        samples += 1;
    }
    gains
};

/// Number of samples from which the gains of a growing memory would be below those of a fading one.
const FADING_SAMPLES: usize = {
    let mut samples = 0;
    while growing_gains(samples as u32).position > FADING_GAINS.position {
        samples += 1;
    }
    samples
};

/// Gains of a fading memory of second degree.
static FADING_GAINS: Gains = {
    let rest = 1.0 - FADING;
    Gains {
        position: 1.0 - FADING * FADING * FADING,
        velocity: 1.5 * rest * rest * (1.0 + FADING),
        half_acceleration: 0.5 * rest * rest * rest,
    }
};

/// Gains of a growing memory: a fit to all samples so far.
const fn growing_gains(samples: u32) -> Gains {
    let n = samples as f32;
    if samples < LINEAR_SAMPLES {
        let d = (n + 1.0) * (n + 2.0);
        return Gains { position: 2.0 * (2.0 * n + 1.0) / d, velocity: 6.0 / d, half_acceleration: 0.0 };
    }
    let d = (n + 1.0) * (n + 2.0) * (n + 3.0);
    Gains {
        position: 3.0 * (3.0 * n * n + 3.0 * n + 2.0) / d,
        velocity: 18.0 * (2.0 * n + 1.0) / d,
        half_acceleration: 30.0 / d,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK_S: f32 = 25e-6;
    const STEP_MIN_S: f32 = 2.5e-3;

    fn take(estimator: &mut Estimator, tick: u32, place_m: [f32; 2]) -> Option<Estimate> {
        estimator.take(place_m, tick, TICK_S, STEP_MIN_S)
    }

    /// Place and velocity along x at a tick.
    fn x(estimator: &Estimator, tick: u32) -> (f32, f32) {
        let [x, _] = estimator.axes;
        x.at(tick.wrapping_sub(estimator.sampled_at_tick) as f32 * TICK_S)
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

    #[test]
    fn constant_acceleration_leaves_no_error_in_the_end() {
        assert!(error_m(|t| 0.01 + 0.02 * t + 0.5 * t * t, 60) < 5e-6);
    }

    #[test]
    fn repeated_and_backward_samples_change_nothing() {
        let mut estimator = Estimator::NEW;
        take(&mut estimator, 1000, [0.01, 0.01]);
        let before = take(&mut estimator, 1400, [0.02, 0.01]);
        assert_eq!(take(&mut estimator, 1400, [0.5, 0.5]), None);
        assert_eq!(take(&mut estimator, 1399, [0.5, 0.5]), None);
        assert_eq!(Some(estimator.estimate()), before);
    }

    #[test]
    fn the_tick_counter_may_wrap() {
        let mut estimator = Estimator::NEW;
        let start = u32::MAX - 500;
        for i in 0..4 {
            take(&mut estimator, start.wrapping_add(400 * i), [0.001 * i as f32, 0.0]);
        }
        let (place_m, velocity_m_per_s) = x(&estimator, start.wrapping_add(1600));
        assert!((place_m - 0.004).abs() < 1e-6);
        assert!((velocity_m_per_s - 0.1).abs() < 1e-4);
    }

    /// One report that is late by nearly a period and then bunched with the next one.
    #[test]
    fn a_bunched_sample_does_not_throw_the_finger_away() {
        let mut estimator = Estimator::NEW;
        let at = |tick: u32| 0.1 * TICK_S * tick as f32;
        let mut worst_m = 0.0_f32;
        for report in 0..40_u32 {
            // The place is that of the right time, the tick that it is said to be of is not.
            let tick = 400 * report;
            let said = if report == 20 { tick + 396 } else { tick };
            take(&mut estimator, said, [at(tick), 0.0]);
            for later in [0, 200, 399] {
                let now = tick + 400 + later;
                worst_m = worst_m.max((x(&estimator, now).0 - at(now)).abs());
            }
        }
        assert!(worst_m < 5e-3, "{worst_m}");
    }
}
