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
    gain_per_tick: f32,
}

impl StillnessTiming {
    pub(crate) fn new(tick_hz: u32) -> Self {
        let still_after_ticks = (STILL_AFTER_S * tick_hz as f32) as u32;
        Self { still_after_ticks, gain_per_tick: 1.0 / (RAMP_S * tick_hz as f32) }
    }
}

/// Whether the finger is still, and how far the ramp has come.
///
/// The speed is that of the last sample: between two samples nothing new is known of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stillness {
    /// The finger moves fast enough, and the gain is 1: there is nothing to settle.
    steady: bool,
    /// The last sample was below the speed of a still finger.
    slow: bool,
    slow_ticks: u32,
    gain: f32,
    /// What is added to the gain in a tick: less than zero while the finger is still.
    gain_per_tick: f32,
    settled_at_tick: u32,
}

impl Stillness {
    /// A finger that has just come down is taken to move.
    pub(crate) const MOVING: Self =
        Self { steady: true, slow: false, slow_ticks: 0, gain: 1.0, gain_per_tick: 0.0, settled_at_tick: 0 };

    /// Takes the velocity of a new sample, in m/s.
    pub(crate) fn take(&mut self, [x, y]: [f32; 2], now_tick: u32) {
        let speed_squared = x * x + y * y;
        self.slow = speed_squared < STILL_BELOW_M_PER_S * STILL_BELOW_M_PER_S;
        if self.slow {
            if self.steady {
                self.steady = false;
                self.settled_at_tick = now_tick;
            }
            return;
        }
        self.slow_ticks = 0;
        if self.gain >= 1.0 {
            self.steady = true;
        } else if self.gain_per_tick < 0.0 && speed_squared > MOVING_ABOVE_M_PER_S * MOVING_ABOVE_M_PER_S {
            self.gain_per_tick = -self.gain_per_tick;
        }
    }

    /// On the friction asked for, from 0 to 1.
    #[inline]
    pub(crate) fn gain(&self) -> f32 {
        self.gain
    }

    /// The finger moves fast enough, and the gain is 1: there is nothing to [`Self::settle`].
    #[inline]
    pub(crate) fn is_steady(&self) -> bool {
        self.steady
    }

    /// Goes on to a tick, for a finger that is slow or whose gain is not 1. Returns whether the gain has left 1 or come
    /// back to it.
    pub(crate) fn settle(&mut self, now_tick: u32, timing: &StillnessTiming) -> bool {
        let ticks = now_tick.wrapping_sub(self.settled_at_tick);
        self.settled_at_tick = now_tick;
        if self.slow {
            self.slow_ticks = self.slow_ticks.saturating_add(ticks);
            if self.slow_ticks >= timing.still_after_ticks {
                self.gain_per_tick = -timing.gain_per_tick;
            }
        }
        let before = self.gain;
        let gain = before + self.gain_per_tick * ticks as f32;
        if gain >= 1.0 {
            self.gain = 1.0;
            self.steady = !self.slow;
            before < 1.0
        } else {
            self.gain = if gain > 0.0 { gain } else { 0.0 };
            before >= 1.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Run {
        stillness: Stillness,
        now_tick: u32,
        /// Ticks from one settling to the next.
        step_ticks: u32,
    }

    impl Run {
        fn new(step_ticks: u32) -> Self {
            Self { stillness: Stillness::MOVING, now_tick: u32::MAX - 3000, step_ticks }
        }

        fn go_on(&mut self, speed_m_per_s: f32, ticks: u32) -> f32 {
            let timing = StillnessTiming::new(40_000);
            self.stillness.take([0.0, -speed_m_per_s], self.now_tick);
            for _ in 0..ticks / self.step_ticks {
                self.now_tick = self.now_tick.wrapping_add(self.step_ticks);
                self.stillness.settle(self.now_tick, &timing);
                assert!(!self.stillness.is_steady() || self.stillness.gain() >= 1.0);
            }
            self.stillness.gain()
        }
    }

    #[test]
    fn a_finger_slow_for_50_ms_is_ramped_away_in_10_ms_and_back_above_5_mm_per_s() {
        for step_ticks in [1, 2, 5] {
            let mut run = Run::new(step_ticks);
            assert!(run.go_on(1.9e-3, 1995) >= 1.0);
            let middle = run.go_on(1.9e-3, 205);
            assert!((middle - 0.5).abs() < 0.02, "{middle}");
            assert!(run.go_on(1.9e-3, 200) <= 1e-3);
            assert!(run.go_on(4.9e-3, 4000) <= 0.0, "between the two speeds a still finger stays still");
            assert!(run.go_on(5.1e-3, 405) >= 1.0);
        }
    }

    #[test]
    fn a_pause_shorter_than_50_ms_is_not_still() {
        let mut run = Run::new(2);
        for _ in 0..10 {
            assert!(run.go_on(0.0, 1900) >= 1.0);
            assert!(run.go_on(3e-3, 2) >= 1.0);
        }
    }
}
