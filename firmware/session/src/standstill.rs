//! Standstill detector. A still finger feels almost nothing while its current rises, so the tracker ramps the friction
//! down at standstill, and up again when the finger moves.

use frixel_control::StandstillRamp;
use frixel_control::is_past;

/// Below this speed the finger counts as slow; after [`STILL_AFTER_S`] of being slow it counts as still.
const SLOW_BELOW_M_PER_S: f32 = 2e-3;
/// Above this speed a still finger counts as moving.
const MOVING_ABOVE_M_PER_S: f32 = 5e-3;
const STILL_AFTER_S: f32 = 50e-3;
/// Duration of a whole ramp, down or up.
const RAMP_S: f32 = 10e-3;

/// The detector's timing in ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StandstillTiming {
    still_after_ticks: u32,
    slope_per_tick: f32,
}

impl StandstillTiming {
    pub(crate) fn new(tick_hz: u32) -> Self {
        let still_after_ticks = (STILL_AFTER_S * tick_hz as f32) as u32;
        Self { still_after_ticks, slope_per_tick: 1.0 / (RAMP_S * tick_hz as f32) }
    }
}

/// Detects that the finger stands still, from the speed at each touch report.
///
/// The ramp down is scheduled when the finger becomes slow, and begins in the future. A report of a faster finger
/// cancels it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Standstill {
    ramp: StandstillRamp,
    slow_since_tick: Option<u32>,
}

impl Standstill {
    /// Initial state: a finger that has just touched the screen counts as moving.
    pub(crate) const MOVING: Self = Self { ramp: StandstillRamp::MOVING, slow_since_tick: None };

    /// Takes the velocity at a tick, in m/s, and returns the ramp from then on.
    pub(crate) fn take(&mut self, [x, y]: [f32; 2], now_tick: u32, timing: &StandstillTiming) -> StandstillRamp {
        let speed_squared = x * x + y * y;
        let gain = self.ramp.gain_at(now_tick);
        let now = StandstillRamp { from_tick: now_tick, gain, slope_per_tick: self.ramp.slope_per_tick };
        let is_still = self.ramp.slope_per_tick < 0.0 && is_past(self.ramp.from_tick, now_tick);
        self.ramp = if is_still {
            self.slow_since_tick = None;
            let moves = speed_squared > MOVING_ABOVE_M_PER_S * MOVING_ABOVE_M_PER_S;
            if moves { StandstillRamp { slope_per_tick: timing.slope_per_tick, ..now } } else { now }
        } else {
            let is_slow = speed_squared < SLOW_BELOW_M_PER_S * SLOW_BELOW_M_PER_S;
            self.slow_since_tick = if is_slow { Some(self.slow_since_tick.unwrap_or(now_tick)) } else { None };
            match self.slow_since_tick {
                // Finish the ramp up first: it is shorter than `STILL_AFTER_S`.
                _ if gain < 1.0 => now,
                Some(since_tick) => {
                    let still_tick = since_tick.wrapping_add(timing.still_after_ticks);
                    let from_tick = if is_past(still_tick, now_tick) { now_tick } else { still_tick };
                    StandstillRamp { from_tick, gain: 1.0, slope_per_tick: -timing.slope_per_tick }
                }
                None => StandstillRamp { from_tick: now_tick, ..StandstillRamp::MOVING },
            }
        };
        self.ramp
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Run {
        standstill: Standstill,
        now_tick: u32,
        /// Ticks from one report to the next.
        period_ticks: u32,
        least_gain: f32,
    }

    impl Run {
        /// The tick counter wraps on the way.
        fn new(period_ticks: u32) -> Self {
            let standstill = Standstill::MOVING;
            Self { standstill, now_tick: u32::MAX - 3000, period_ticks, least_gain: 1.0 }
        }

        /// Reports a speed for some ticks, and returns the gain after them.
        fn run_for(&mut self, speed_m_per_s: f32, ticks: u32) -> f32 {
            let timing = StandstillTiming::new(40_000);
            let mut gain = 1.0;
            let mut ramp = self.standstill.take([0.0, -speed_m_per_s], self.now_tick, &timing);
            for tick in 1..=ticks {
                self.now_tick = self.now_tick.wrapping_add(1);
                if tick % self.period_ticks == 0 {
                    ramp = self.standstill.take([0.0, -speed_m_per_s], self.now_tick, &timing);
                }
                gain = ramp.gain_at(self.now_tick);
                self.least_gain = self.least_gain.min(gain);
            }
            gain
        }
    }

    #[test]
    fn a_finger_slow_for_50_ms_is_ramped_away_in_10_ms_and_back_above_5_mm_per_s() {
        for period_ticks in [1, 2, 5, 80, 400, 4_000] {
            let mut run = Run::new(period_ticks);
            assert!(run.run_for(1.9e-3, 2000) >= 1.0, "{period_ticks}");
            let middle = run.run_for(1.9e-3, 200);
            assert!((middle - 0.5).abs() < 0.02, "{period_ticks}: {middle}");
            assert!(run.run_for(1.9e-3, 205) <= 1e-3, "{period_ticks}");
            assert!(run.run_for(4.9e-3, 4000) <= 0.0, "between the two speeds a still finger stays still");
            assert!(run.run_for(5.1e-3, 405) >= 1.0, "{period_ticks}");
        }
    }

    #[test]
    fn the_speed_is_that_of_both_axes() {
        let timing = StandstillTiming::new(40_000);
        for (velocity_m_per_s, is_slow) in
            [([1.9e-3, 0.0], true), ([-1.9e-3, 0.0], true), ([2.1e-3, 0.0], false), ([1.5e-3, 1.5e-3], false)]
        {
            let ramp = { Standstill::MOVING }.take(velocity_m_per_s, 0, &timing);
            assert_eq!(ramp.slope_per_tick < 0.0, is_slow, "{velocity_m_per_s:?}");
        }
    }

    #[test]
    fn a_pause_shorter_than_50_ms_is_not_still() {
        let mut run = Run::new(2);
        for _ in 0..10 {
            assert!(run.run_for(0.0, 1900) >= 1.0);
            assert!(run.run_for(3e-3, 2) >= 1.0);
        }
        assert!(run.least_gain >= 1.0);
    }

    #[test]
    fn a_finger_that_stops_on_the_way_back_is_ramped_away_50_ms_later() {
        let mut run = Run::new(80);
        run.run_for(0.0, 2_600);
        assert!((run.run_for(0.1, 200) - 0.5).abs() < 0.02, "on its way back");
        assert!(run.run_for(0.0, 1_990) >= 1.0);
        assert!(run.run_for(0.0, 500) <= 0.0);
    }
}
