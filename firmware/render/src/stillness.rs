//! A still finger feels next to nothing while its current rises: its envelope is ramped away, and comes back when it
//! moves (DESIGN section 3).

use crate::estimator::Estimate;

/// Below this speed the finger counts as still, when it stays there for [`STILL_AFTER_S`].
const STILL_BELOW_M_PER_S: f32 = 2e-3;
/// Above this speed a still finger counts as moving.
const MOVING_ABOVE_M_PER_S: f32 = 5e-3;
const STILL_AFTER_S: f32 = 50e-3;
/// Time of a whole ramp, either way.
const RAMP_S: f32 = 10e-3;

/// The ramp's timing in ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StillnessTiming {
    still_after_ticks: u32,
    ramp_step: f32,
}

impl StillnessTiming {
    pub(crate) fn new(tick_hz: u32) -> Self {
        Self { still_after_ticks: (STILL_AFTER_S * tick_hz as f32) as u32, ramp_step: 1.0 / (RAMP_S * tick_hz as f32) }
    }
}

/// Whether the finger is still, and how far the ramp has come.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stillness {
    phase: Phase,
    slow_ticks: u32,
    gain: f32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// The finger moves, and the gain is 1.
    Moving,
    /// The finger moves, and the gain rises.
    Returning,
    /// The finger is still, and the gain falls or is zero.
    Still,
}

impl Stillness {
    /// A finger that has just come down is taken to move.
    pub(crate) const MOVING: Self = Self { phase: Phase::Moving, slow_ticks: 0, gain: 1.0 };

    /// Takes one tick's estimate and returns the gain on the friction asked for, from 0 to below 1; `None` where it is
    /// 1.
    #[inline]
    pub(crate) fn update(&mut self, estimate: &Estimate, timing: &StillnessTiming) -> Option<f32> {
        let speed_squared = estimate.velocity_x_m_per_s * estimate.velocity_x_m_per_s
            + estimate.velocity_y_m_per_s * estimate.velocity_y_m_per_s;
        let slow = speed_squared < STILL_BELOW_M_PER_S * STILL_BELOW_M_PER_S;
        self.slow_ticks = if slow { self.slow_ticks.saturating_add(1) } else { 0 };
        if self.phase == Phase::Moving && self.slow_ticks < timing.still_after_ticks {
            return None;
        }
        self.ramp(speed_squared, timing)
    }

    /// A tick at which the gain moves or is not 1.
    fn ramp(&mut self, speed_squared: f32, timing: &StillnessTiming) -> Option<f32> {
        let moving_again = speed_squared > MOVING_ABOVE_M_PER_S * MOVING_ABOVE_M_PER_S;
        self.phase = match self.phase {
            Phase::Still if moving_again => Phase::Returning,
            Phase::Moving | Phase::Returning if self.slow_ticks >= timing.still_after_ticks => Phase::Still,
            phase => phase,
        };
        if self.phase == Phase::Still {
            self.gain = (self.gain - timing.ramp_step).max(0.0);
            return Some(self.gain);
        }
        self.gain += timing.ramp_step;
        if self.gain < 1.0 {
            return Some(self.gain);
        }
        *self = Self { slow_ticks: self.slow_ticks, ..Self::MOVING };
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(stillness: &mut Stillness, speed_m_per_s: f32, ticks: u32) -> f32 {
        let timing = StillnessTiming::new(40_000);
        let estimate = Estimate { velocity_y_m_per_s: speed_m_per_s, ..Estimate::default() };
        (0..ticks).fold(1.0, |_, _| stillness.update(&estimate, &timing).unwrap_or(1.0))
    }

    #[test]
    fn a_finger_slow_for_50_ms_is_ramped_away_in_10_ms_and_back_above_5_mm_per_s() {
        let mut stillness = Stillness::MOVING;
        assert!(run(&mut stillness, 1.9e-3, 1999) >= 1.0);
        let middle = run(&mut stillness, 1.9e-3, 201);
        assert!((middle - 0.5).abs() < 0.01, "{middle}");
        assert!(run(&mut stillness, 1.9e-3, 200) <= 1e-3);
        assert!(run(&mut stillness, 4.9e-3, 4000) <= 0.0, "between the two speeds a still finger stays still");
        assert!(run(&mut stillness, 5.1e-3, 401) >= 1.0);
    }

    #[test]
    fn a_pause_shorter_than_50_ms_is_not_still() {
        let mut stillness = Stillness::MOVING;
        for _ in 0..10 {
            assert!(run(&mut stillness, 0.0, 1900) >= 1.0);
            assert!(run(&mut stillness, 3e-3, 1) >= 1.0);
        }
    }
}
