//! A still finger feels next to nothing while its current rises: its envelope is ramped away, and comes back when it
//! moves (DESIGN section 3).

use crate::deadline::is_past;

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
    /// The gain is on its way to one of its ends: there is something to [`Self::settle`].
    ramping: bool,
    gain: f32,
    /// What is added to the gain in a tick: less than zero for a finger that is still, and zero for one that is not.
    gain_per_tick: f32,
    settled_at_tick: u32,
    /// When a finger that is slow will be still.
    still_at_tick: Option<u32>,
}

impl Stillness {
    /// A finger that has just come down is taken to move.
    pub(crate) const MOVING: Self =
        Self { ramping: false, gain: 1.0, gain_per_tick: 0.0, settled_at_tick: 0, still_at_tick: None };

    /// Takes the velocity of a new sample, in m/s.
    pub(crate) fn take(&mut self, [x, y]: [f32; 2], now_tick: u32, timing: &StillnessTiming) {
        let speed_squared = x * x + y * y;
        if self.gain_per_tick < 0.0 {
            if speed_squared > MOVING_ABOVE_M_PER_S * MOVING_ABOVE_M_PER_S {
                self.ramp(timing.gain_per_tick, now_tick);
            }
        } else if !(speed_squared < STILL_BELOW_M_PER_S * STILL_BELOW_M_PER_S) {
            self.still_at_tick = None;
        } else if self.still_at_tick.is_none() {
            self.still_at_tick = Some(now_tick.wrapping_add(timing.still_after_ticks));
        }
    }

    /// When [`Self::expire`] has to be asked.
    pub(crate) fn still_at_tick(&self) -> Option<u32> {
        self.still_at_tick
    }

    /// Begins to ramp a finger away that has been slow for long enough.
    pub(crate) fn expire(&mut self, now_tick: u32, timing: &StillnessTiming) {
        if let Some(tick) = self.still_at_tick
            && is_past(tick, now_tick)
        {
            self.still_at_tick = None;
            self.ramp(-timing.gain_per_tick, now_tick);
        }
    }

    fn ramp(&mut self, gain_per_tick: f32, now_tick: u32) {
        self.gain_per_tick = gain_per_tick;
        self.settled_at_tick = now_tick;
        self.ramping = true;
    }

    /// On the friction asked for, from 0 to 1.
    #[inline]
    pub(crate) fn gain(&self) -> f32 {
        self.gain
    }

    /// The gain is on its way: there is something to [`Self::settle`].
    #[inline]
    pub(crate) fn is_ramping(&self) -> bool {
        self.ramping
    }

    /// Goes on to a tick with a gain that is on its way.
    #[inline(never)]
    pub(crate) fn settle(&mut self, now_tick: u32) {
        let ticks = now_tick.wrapping_sub(self.settled_at_tick);
        self.settled_at_tick = now_tick;
        let gain = self.gain + self.gain_per_tick * ticks as f32;
        self.gain = gain;
        if self.gain_per_tick > 0.0 && gain >= 1.0 {
            self.gain = 1.0;
            self.gain_per_tick = 0.0;
            self.ramping = false;
        } else if self.gain_per_tick < 0.0 && gain <= 0.0 {
            self.gain = 0.0;
            self.ramping = false;
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
            self.stillness.take([0.0, -speed_m_per_s], self.now_tick, &timing);
            for tick in 0..ticks {
                self.now_tick = self.now_tick.wrapping_add(1);
                self.stillness.expire(self.now_tick, &timing);
                if self.stillness.is_ramping() && tick % self.step_ticks == 0 {
                    self.stillness.settle(self.now_tick);
                }
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
            assert!(run.go_on(1.9e-3, 200 + step_ticks) <= 1e-3);
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
