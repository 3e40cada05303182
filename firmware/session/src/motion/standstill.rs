//! Standstill detector. Friction on a resting finger is nearly imperceptible although its current rises, so the tracker
//! ramps the friction down at standstill, and up again when the finger moves.
//!
//! The detector uses distances instead of the estimated speed: at 100 reports per second, 0.02 mm of noise amount to
//! several mm/s of speed, although the finger rests.

use frixel_control::StandstillRamp;
use frixel_control::is_past;

/// A finger that moves by less than [`SLOW_WITHIN_M`] in this time, in s, counts as still: 1.2 mm/s on average.
const STILL_AFTER_S: f32 = 50e-3;
/// See [`STILL_AFTER_S`]. A larger value would ramp down under creeping fingers, a smaller one would drive a resting
/// finger for more of the time. `cargo test -p frixel-hil-sim --test main resting` measures that time;
/// docs/design/touch.md states it.
const SLOW_WITHIN_M: f32 = 0.06e-3;
/// Distance, in m, by which a still finger must move within [`MOVING_WITHIN_S`] to count as moving: 2 mm/s on average.
/// It exceeds one step of a touchscreen along an axis, 0.18 mm.
const MOVING_BEYOND_M: f32 = 0.2e-3;
/// See [`MOVING_BEYOND_M`].
const MOVING_WITHIN_S: f32 = 100e-3;
/// Duration of a whole ramp, down or up, in s.
const RAMP_S: f32 = 10e-3;

/// The detector's timing in ticks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StandstillTiming {
    still_after_ticks: u32,
    moving_within_ticks: u32,
    slope_per_tick: f32,
}

impl StandstillTiming {
    pub(crate) fn new(tick_hz: u32) -> Self {
        let tick_hz = tick_hz as f32;
        Self {
            still_after_ticks: (STILL_AFTER_S * tick_hz) as u32,
            moving_within_ticks: (MOVING_WITHIN_S * tick_hz) as u32,
            slope_per_tick: 1.0 / (RAMP_S * tick_hz),
        }
    }
}

/// A place of the finger with its time.
#[derive(Clone, Copy, Debug)]
struct Anchor {
    place_m: [f32; 2],
    at_tick: u32,
}

impl Anchor {
    fn is_within(&self, distance_m: f32, [x_m, y_m]: [f32; 2]) -> bool {
        let [anchor_x_m, anchor_y_m] = self.place_m;
        let (x_m, y_m) = (x_m - anchor_x_m, y_m - anchor_y_m);
        x_m * x_m + y_m * y_m <= distance_m * distance_m
    }
}

/// Detects that the finger stands still, from its place at each touch report.
///
/// The ramp down is scheduled in the future while the finger stays near its anchor. A report from farther away cancels
/// it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Standstill {
    ramp: StandstillRamp,
    /// Place of the finger when it last counted as moving or, while it is still, at most [`MOVING_WITHIN_S`] and one
    /// report ago; `None` before the first report.
    anchor: Option<Anchor>,
}

impl Standstill {
    /// Initial state: a finger counts as moving after touch-down.
    pub(crate) const MOVING: Self = Self { ramp: StandstillRamp::MOVING, anchor: None };

    /// Takes the place at a tick, in m, and returns the ramp from then on.
    pub(crate) fn take(&mut self, place_m: [f32; 2], now_tick: u32, timing: &StandstillTiming) -> StandstillRamp {
        let here = Anchor { place_m, at_tick: now_tick };
        let anchor = self.anchor.get_or_insert(here);
        let gain = self.ramp.gain_at(now_tick);
        let now = StandstillRamp { from_tick: now_tick, gain, slope_per_tick: self.ramp.slope_per_tick };
        let is_still = self.ramp.slope_per_tick < 0.0 && is_past(self.ramp.from_tick, now_tick);
        let (near_m, ticks) = if is_still {
            (MOVING_BEYOND_M, timing.moving_within_ticks)
        } else {
            (SLOW_WITHIN_M, timing.still_after_ticks)
        };
        let is_near = anchor.is_within(near_m, place_m);
        let until_tick = anchor.at_tick.wrapping_add(ticks);
        let is_old = is_past(until_tick, now_tick);
        if !is_near || (is_still && is_old) {
            *anchor = here;
        }
        self.ramp = if is_still {
            StandstillRamp { slope_per_tick: if is_near { now.slope_per_tick } else { timing.slope_per_tick }, ..now }
        } else if gain < 1.0 {
            // Finish the ramp up first: it is shorter than `STILL_AFTER_S`.
            now
        } else if is_near {
            let from_tick = if is_old { now_tick } else { until_tick };
            StandstillRamp { from_tick, gain: 1.0, slope_per_tick: -timing.slope_per_tick }
        } else {
            StandstillRamp { from_tick: now_tick, ..StandstillRamp::MOVING }
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
        y_m: f64,
        /// Ticks from one report to the next.
        period_ticks: u32,
    }

    impl Run {
        /// The tick counter wraps on the way.
        fn new(period_ticks: u32) -> Self {
            let standstill = Standstill::MOVING;
            Self { standstill, now_tick: u32::MAX - 3000, y_m: 0.03, period_ticks }
        }

        /// Moves at a speed for some ticks, and returns the gain after them.
        fn run_for(&mut self, speed_m_per_s: f64, ticks: u32) -> f32 {
            let timing = StandstillTiming::new(40_000);
            let mut gain = 1.0;
            let mut ramp = self.standstill.take([0.01, self.y_m as f32], self.now_tick, &timing);
            for tick in 1..=ticks {
                self.now_tick = self.now_tick.wrapping_add(1);
                self.y_m -= speed_m_per_s / 40_000.0;
                if tick % self.period_ticks == 0 {
                    ramp = self.standstill.take([0.01, self.y_m as f32], self.now_tick, &timing);
                }
                gain = ramp.gain_at(self.now_tick);
            }
            gain
        }
    }

    #[test]
    fn a_finger_slow_for_50_ms_is_ramped_down_in_10_ms_and_up_above_2_mm_per_s() {
        for period_ticks in [1, 2, 5, 80, 400, 2_000] {
            let mut run = Run::new(period_ticks);
            assert!(run.run_for(1.1e-3, 2000) >= 1.0, "{period_ticks}");
            let middle = run.run_for(1.1e-3, 200);
            assert!((middle - 0.5).abs() < 0.02, "{period_ticks}: {middle}");
            assert!(run.run_for(1.1e-3, 205) <= 1e-3, "{period_ticks}");
            assert!(
                run.run_for(1.6e-3, 8000) <= 0.0,
                "{period_ticks}: between the two speeds a still finger stays still"
            );
            run.run_for(3e-3, 4800);
            assert!(run.run_for(3e-3, 405) >= 1.0, "{period_ticks}");
        }
    }

    #[test]
    fn the_distance_is_that_of_both_axes() {
        let timing = StandstillTiming::new(40_000);
        for (place_m, is_slow) in
            [([0.05e-3, 0.0], true), ([-0.05e-3, 0.0], true), ([0.07e-3, 0.0], false), ([0.05e-3, -0.05e-3], false)]
        {
            let mut standstill = Standstill::MOVING;
            standstill.take([0.0; 2], 0, &timing);
            assert_eq!(standstill.take(place_m, 400, &timing).slope_per_tick < 0.0, is_slow, "{place_m:?}");
        }
    }

    /// Between two places 0.05 mm apart, 100 times a second, the speed is 5 mm/s.
    #[test]
    fn a_finger_that_only_trembles_is_still() {
        let timing = StandstillTiming::new(40_000);
        let mut standstill = Standstill::MOVING;
        let mut gain = 1.0;
        for report in 0..100_u32 {
            let place_m = [if report.is_multiple_of(2) { 0.0 } else { 0.05e-3 }, 0.0];
            let ramp = standstill.take(place_m, 400 * report, &timing);
            gain = ramp.gain_at(400 * report + 399);
            assert!(gain <= 0.0 || report < 6, "report {report}: {gain}");
        }
        assert!(gain <= 0.0);
    }

    #[test]
    fn a_finger_that_stops_during_the_ramp_up_is_ramped_down_50_ms_later() {
        let mut run = Run::new(80);
        run.run_for(0.0, 2_600);
        run.run_for(0.1, 160);
        let on_the_way_back = run.run_for(0.1, 240);
        assert!(on_the_way_back > 0.3 && on_the_way_back < 1.0, "{on_the_way_back}");
        assert!(run.run_for(0.0, 1_900) >= 1.0);
        assert!(run.run_for(0.0, 700) <= 0.0);
    }
}
