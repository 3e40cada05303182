//! Where the finger is now, from touch samples that are late, seldom and noisy.
//!
//! A fading-memory polynomial filter of second degree (g-h-k filter, Brookner, *Tracking and Kalman Filtering Made
//! Easy*, 1998, ch. 1): it fits position, velocity and acceleration to the samples so far, each weighted less by
//! [`FADING`] than the one after it, and is read at any later tick. For the first samples its gains are those of a
//! growing memory, so that it is right from the second sample on.

/// Weight that a sample keeps at the next one. With samples at 100 Hz, 10 ms late, noise 0.02 mm and jitter 0.5 ms,
/// values from 0.5 to 0.7 are within a tenth of the best for strokes from constant speed to minimum-jerk.
const FADING: f32 = 0.65;

/// Most samples whose gains are those of a growing memory of first degree: a fit of second degree to so few amplifies
/// noise too much.
const LINEAR_SAMPLES: u32 = 3;

/// Position, velocity and acceleration along one axis, in m, m/s and m/s^2, at the time of the last sample.
#[derive(Clone, Copy, Debug)]
struct Axis {
    position: f32,
    velocity: f32,
    acceleration: f32,
}

/// Gains of one update.
#[derive(Clone, Copy)]
struct Gains {
    position: f32,
    velocity: f32,
    acceleration: f32,
}

impl Axis {
    const ZERO: Self = Self::resting_at(0.0);

    const fn resting_at(position: f32) -> Self {
        Self { position, velocity: 0.0, acceleration: 0.0 }
    }

    fn at(&self, time_s: f32) -> f32 {
        self.position + time_s * (self.velocity + time_s * (0.5 * self.acceleration))
    }

    fn update(&mut self, measured: f32, step_s: f32, gains: Gains) {
        let predicted = self.at(step_s);
        let residual = measured - predicted;
        self.velocity = self.velocity + step_s * self.acceleration + gains.velocity * residual / step_s;
        self.position = predicted + gains.position * residual;
        self.acceleration += 2.0 * gains.acceleration * residual / (step_s * step_s);
    }
}

/// A finger as estimated at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) x_m: f32,
    pub(crate) y_m: f32,
    pub(crate) velocity_x_m_per_s: f32,
    pub(crate) velocity_y_m_per_s: f32,
}

/// The filter's state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Estimator {
    x: Axis,
    y: Axis,
    samples: u32,
    sampled_at_tick: u32,
}

impl Estimate {
    pub(crate) const ZERO: Self = Self { x_m: 0.0, y_m: 0.0, velocity_x_m_per_s: 0.0, velocity_y_m_per_s: 0.0 };
}

impl Estimator {
    /// Knows nothing yet.
    pub(crate) const NEW: Self = Self { x: Axis::ZERO, y: Axis::ZERO, samples: 0, sampled_at_tick: 0 };

    /// Takes a sample that was true `age_ticks` before `now_tick`. One that is not newer
    /// than the last says nothing.
    pub(crate) fn update(&mut self, now_tick: u32, age_ticks: u32, x_m: f32, y_m: f32, tick_period_s: f32) {
        let sampled_at_tick = now_tick.wrapping_sub(age_ticks);
        let step_ticks = sampled_at_tick.wrapping_sub(self.sampled_at_tick) as i32;
        if self.samples == 0 {
            *self = Self { x: Axis::resting_at(x_m), y: Axis::resting_at(y_m), samples: 1, sampled_at_tick };
        } else if step_ticks > 0 {
            let step_s = step_ticks as f32 * tick_period_s;
            let gains = gains(self.samples);
            self.x.update(x_m, step_s, gains);
            self.y.update(y_m, step_s, gains);
            self.samples = self.samples.saturating_add(1);
            self.sampled_at_tick = sampled_at_tick;
        }
    }

    /// The estimate for `now_tick`; `None` before the first sample.
    #[inline]
    pub(crate) fn at(&self, now_tick: u32, tick_period_s: f32) -> Option<Estimate> {
        if self.samples == 0 {
            return None;
        }
        let time_s = now_tick.wrapping_sub(self.sampled_at_tick) as f32 * tick_period_s;
        Some(Estimate {
            x_m: self.x.at(time_s),
            y_m: self.y.at(time_s),
            velocity_x_m_per_s: self.x.velocity + time_s * self.x.acceleration,
            velocity_y_m_per_s: self.y.velocity + time_s * self.y.acceleration,
        })
    }
}

/// Gains for the sample that comes after `samples` others.
fn gains(samples: u32) -> Gains {
    let n = samples.min(1000) as f32;
    if samples < LINEAR_SAMPLES {
        let d = (n + 1.0) * (n + 2.0);
        return Gains { position: 2.0 * (2.0 * n + 1.0) / d, velocity: 6.0 / d, acceleration: 0.0 };
    }
    let d = (n + 1.0) * (n + 2.0) * (n + 3.0);
    let growing = Gains {
        position: 3.0 * (3.0 * n * n + 3.0 * n + 2.0) / d,
        velocity: 18.0 * (2.0 * n + 1.0) / d,
        acceleration: 30.0 / d,
    };
    let rest = 1.0 - FADING;
    let fading = Gains {
        position: 1.0 - FADING * FADING * FADING,
        velocity: 1.5 * rest * rest * (1.0 + FADING),
        acceleration: 0.5 * rest * rest * rest,
    };
    if growing.position > fading.position { growing } else { fading }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK_S: f32 = 25e-6;

    /// Feeds exact samples of `path` at 100 Hz, 400 ticks late, and returns the error at the end.
    fn error_m(path: impl Fn(f32) -> f32, samples: u32) -> f32 {
        let mut estimator = Estimator::NEW;
        for i in 0..samples {
            let tick = 1000 + 400 * i;
            estimator.update(tick + 400, 400, path(tick as f32 * TICK_S), 0.0, TICK_S);
        }
        let now = 1000 + 400 * samples + 300;
        (estimator.at(now, TICK_S).unwrap().x_m - path(now as f32 * TICK_S)).abs()
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
        estimator.update(1000, 0, 0.01, 0.01, TICK_S);
        estimator.update(1400, 0, 0.02, 0.01, TICK_S);
        let before = estimator.at(1500, TICK_S);
        estimator.update(1410, 10, 0.5, 0.5, TICK_S);
        estimator.update(1410, 11, 0.5, 0.5, TICK_S);
        assert_eq!(estimator.at(1500, TICK_S), before);
    }

    #[test]
    fn the_tick_counter_may_wrap() {
        let mut estimator = Estimator::NEW;
        let start = u32::MAX - 500;
        for i in 0..4 {
            estimator.update(start.wrapping_add(400 * i), 0, 0.001 * i as f32, 0.0, TICK_S);
        }
        let estimate = estimator.at(start.wrapping_add(1600), TICK_S).unwrap();
        assert!((estimate.x_m - 0.004).abs() < 1e-6);
        assert!((estimate.velocity_x_m_per_s - 0.1).abs() < 1e-4);
    }
}
