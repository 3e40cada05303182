//! A still finger feels next to nothing while its current rises: its envelope is ramped away, and comes back when it
//! moves (DESIGN section 3).

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
///
/// The speed is that of the last sample: between two samples nothing new is known of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stillness {
    /// The finger moves fast enough, and the gain is 1: a tick has nothing to do.
    steady: bool,
    /// The last sample was below the speed of a still finger.
    slow: bool,
    slow_ticks: u32,
    gain: f32,
    /// What is added to the gain at every tick: less than zero while the finger is still.
    gain_step: f32,
}

impl Stillness {
    /// A finger that has just come down is taken to move.
    pub(crate) const MOVING: Self = Self { steady: true, slow: false, slow_ticks: 0, gain: 1.0, gain_step: 0.0 };

    /// Takes the velocity of a new sample, in m/s.
    pub(crate) fn take(&mut self, [x, y]: [f32; 2]) {
        let speed_squared = x * x + y * y;
        self.slow = speed_squared < STILL_BELOW_M_PER_S * STILL_BELOW_M_PER_S;
        if !self.slow {
            self.slow_ticks = 0;
        }
        if self.gain_step < 0.0 && speed_squared > MOVING_ABOVE_M_PER_S * MOVING_ABOVE_M_PER_S {
            self.gain_step = -self.gain_step;
        }
        self.steady = !self.slow && self.gain >= 1.0;
    }

    /// On the friction asked for, from 0 to 1.
    #[inline]
    pub(crate) fn gain(&self) -> f32 {
        self.gain
    }

    /// Goes on by a tick, and returns whether the gain is below 1.
    #[inline]
    pub(crate) fn advance(&mut self, timing: &StillnessTiming) -> bool {
        !self.steady && self.ramp(timing)
    }

    /// A tick at which the finger is slow, or the gain is not 1.
    #[inline(never)]
    fn ramp(&mut self, timing: &StillnessTiming) -> bool {
        if self.slow {
            self.slow_ticks = self.slow_ticks.saturating_add(1);
            if self.slow_ticks >= timing.still_after_ticks {
                self.gain_step = -timing.ramp_step;
            }
        }
        let gain = self.gain + self.gain_step;
        if gain >= 1.0 {
            self.gain = 1.0;
            self.steady = !self.slow;
            return false;
        }
        self.gain = if gain > 0.0 { gain } else { 0.0 };
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(stillness: &mut Stillness, speed_m_per_s: f32, ticks: u32) -> f32 {
        let timing = StillnessTiming::new(40_000);
        stillness.take([0.0, -speed_m_per_s]);
        for _ in 0..ticks {
            let moves = stillness.advance(&timing);
            assert_eq!(moves, stillness.gain() < 1.0);
        }
        stillness.gain()
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
