//! Turns touch reports into tracks.
//!
//! Reports are late, infrequent and noisy, but the tick needs a position at any time. The tracker makes an immutable
//! [`Track`] from each report with new data. Tracks and lifts become orders, one after the other. The tracker reads no
//! clock: it receives tick counts.

use frixel_layers::range::LENGTH_MAX_M;

use super::estimator::{Estimate, Estimator};
use super::standstill::{Standstill, StandstillTiming};
use frixel_control::{Board, Order, Track, is_past, stale_after_ticks};
use frixel_wire::touch::Touch;

/// Age in s above which samples are ignored.
const SAMPLE_AGE_MAX_S: f32 = 0.1;
/// Time in which a new track approaches the estimate, in intervals between reports. A track is a single parabola, which
/// moves away from the estimate after reaching it. The time is longer than one interval, so that the next track starts
/// before this one turns, even if its report is late.
const BLEND_INTERVALS: f32 = 1.5;
/// Two samples closer than this, in intervals between reports, were bunched: the report of the first was delayed.
const BUNCHED_INTERVALS: f32 = 0.25;
/// Weight of the newest interval between reports in the running mean.
const INTERVAL_SHARE: f32 = 0.125;

/// Constants of the board's touch source, computed once.
#[derive(Clone, Copy, Debug)]
struct Timing {
    tick_period_s: f32,
    stale_after_ticks: u32,
    sample_age_max_ticks: u32,
    report_period_s: f32,
    standstill: StandstillTiming,
}

/// A measured position of the finger.
#[derive(Clone, Copy, Debug)]
struct Sample {
    place_m: [f32; 2],
    /// Tick at which the finger was at this place.
    at_tick: u32,
    /// Tick at which its report arrived.
    reported_at_tick: u32,
}

/// Turns touch reports into tracks.
///
/// Reports wait until [`Self::next_order`] takes them. A newer position replaces a waiting one, but never a waiting
/// lift: the lift and the following touch-down are two orders.
pub struct Tracker {
    timing: Timing,
    /// Whether a lift waits for [`Self::next_order`].
    lift: bool,
    /// A position that waits for [`Self::next_order`], after the lift.
    sample: Option<Sample>,
    /// Time of the newest reported position. It is kept when the finger is lost, so that a source that repeats an old
    /// position does not bring the finger back.
    newest_at_tick: Option<u32>,
    estimator: Estimator,
    /// The estimator before the last sample.
    estimator_before: Estimator,
    standstill: Standstill,
    /// Number of the last track's contact.
    contact: u32,
    /// The last track; `None` without a finger.
    track: Option<Track>,
    /// Time at which the last report was taken.
    reported_at_tick: u32,
    /// Mean time between reports, at most the board's report period, in s. It is kept between touches, since the source
    /// stays the same.
    interval_s: f32,
}

impl Tracker {
    /// A tracker without a finger.
    pub fn new(board: &Board) -> Self {
        Self {
            timing: Timing {
                tick_period_s: board.tick_period_s(),
                stale_after_ticks: stale_after_ticks(board),
                sample_age_max_ticks: board.ticks(SAMPLE_AGE_MAX_S),
                report_period_s: board.limits.touch_report_period_s,
                standstill: StandstillTiming::new(board.tick_hz),
            },
            lift: false,
            sample: None,
            newest_at_tick: None,
            estimator: Estimator::NEW,
            estimator_before: Estimator::NEW,
            standstill: Standstill::MOVING,
            contact: 0,
            track: None,
            reported_at_tick: 0,
            interval_s: board.limits.touch_report_period_s,
        }
    }

    /// Takes a report that arrived at `now_tick`. A position that is too old, not newer than the last one, or outside
    /// any screen is ignored: the source may be stuck, and repeated reports must not keep the output enabled.
    pub fn report(&mut self, touch: Touch, now_tick: u32) {
        match touch {
            Touch::Up => {
                self.lift = true;
                self.sample = None;
                self.newest_at_tick = None;
            }
            Touch::Down { x_m, y_m, age_ticks } => {
                let is_newer = self.newest_at_tick.is_none_or(|tick| age_ticks < now_tick.wrapping_sub(tick));
                let is_somewhere = [x_m, y_m].into_iter().all(|place_m| place_m.abs() <= LENGTH_MAX_M as f32);
                if is_newer && is_somewhere && age_ticks <= self.timing.sample_age_max_ticks {
                    let at_tick = now_tick.wrapping_sub(age_ticks);
                    self.newest_at_tick = Some(at_tick);
                    self.sample = Some(Sample { place_m: [x_m, y_m], at_tick, reported_at_tick: now_tick });
                }
            }
        }
    }

    /// Drops a finger whose last track has ended; the next report begins another contact. Must be called at least once
    /// before the tick counter wraps.
    pub fn expire(&mut self, now_tick: u32) {
        if self.track.is_some_and(|track| is_past(track.until_tick, now_tick)) {
            self.track = None;
        }
    }

    /// The next order resulting from the reports: a lift or a track. If the scene `predicts`, the track leads to the
    /// finger's current place; otherwise it stays at the measured one.
    // Not inlined into the main loop, whose stack would otherwise hold its values permanently.
    #[inline(never)]
    pub fn next_order<'a>(&mut self, predicts: bool) -> Option<Order<'a>> {
        if core::mem::take(&mut self.lift) {
            self.track = None;
            return Some(Order::Lift);
        }
        let sample = self.sample.take()?;
        self.track(&sample, predicts).map(Order::Track)
    }

    fn track(&mut self, sample: &Sample, predicts: bool) -> Option<Track> {
        let Sample { place_m, at_tick, reported_at_tick } = *sample;
        let timing = self.timing;
        self.expire(reported_at_tick);
        if self.track.is_none() {
            self.contact = self.contact.wrapping_add(1);
            self.estimator.forget();
            self.standstill = Standstill::MOVING;
        } else {
            self.measure_interval(reported_at_tick);
            // The last report was delayed until this one, so its place is older than stated: revert it.
            if self.estimator.time_to_s(at_tick, timing.tick_period_s) < BUNCHED_INTERVALS * self.interval_s {
                self.estimator = self.estimator_before;
            }
        }
        self.estimator_before = self.estimator;
        self.reported_at_tick = reported_at_tick;
        if !self.estimator.take(place_m, at_tick, timing.tick_period_s, self.interval_s) {
            return None;
        }
        let age_ticks = reported_at_tick.wrapping_sub(at_tick);
        let now = self.estimator.after(age_ticks as f32 * timing.tick_period_s);
        let (from_tick, estimate) =
            if predicts { (reported_at_tick, now) } else { (at_tick, self.estimator.after(0.0)) };
        let leads_on = predicts && self.estimator.expected_last();
        let before_m = self
            .track
            .filter(|_| leads_on)
            .map(|track| track.place_m(track.elapsed_s(reported_at_tick, timing.tick_period_s)));
        let path = Path::from(before_m, &estimate, BLEND_INTERVALS * self.interval_s);
        let ticks = timing.stale_after_ticks.min(timing.sample_age_max_ticks - age_ticks) + 1;
        // The estimate at the sample instead of now, since prediction adds noise. The time is the report's, on which
        // the ramp depends.
        let ramp = self.standstill.take(self.estimator.after(0.0).place_m, reported_at_tick, &timing.standstill);
        let track = Track {
            contact: self.contact,
            from_tick,
            until_tick: reported_at_tick.wrapping_add(ticks),
            place_m: path.place_m,
            path_velocity_m_per_s: path.velocity_m_per_s,
            path_half_acceleration_m_per_s2: path.half_acceleration_m_per_s2,
            velocity_m_per_s: estimate.velocity_m_per_s,
            half_acceleration_m_per_s2: estimate.half_acceleration_m_per_s2,
            ramp,
        };
        self.track = Some(track);
        Some(track)
    }

    /// Includes the time between two reports in their mean. After a lost report, the time counts as one period.
    fn measure_interval(&mut self, reported_at_tick: u32) {
        let interval_s = reported_at_tick.wrapping_sub(self.reported_at_tick) as f32 * self.timing.tick_period_s;
        let period_s = self.timing.report_period_s;
        let interval_s = if interval_s < period_s { interval_s } else { period_s };
        self.interval_s += INTERVAL_SHARE * (interval_s - self.interval_s);
    }
}

/// Motion along a parabola.
struct Path {
    place_m: [f32; 2],
    velocity_m_per_s: [f32; 2],
    half_acceleration_m_per_s2: [f32; 2],
}

impl Path {
    /// The path from the previous track's place `before_m` to that of an estimate, and along it.
    ///
    /// The difference `d` is removed as `d (1 - t/T)^2` over the time `T`, which a parabola can represent: neither the
    /// place nor, at the end of that time, its rate jumps. A step of the place at every report would be perceived as a
    /// buzz at the report rate.
    fn from(before_m: Option<[f32; 2]>, estimate: &Estimate, blend_s: f32) -> Self {
        let Estimate { place_m, velocity_m_per_s, half_acceleration_m_per_s2 } = *estimate;
        let mut path = Self { place_m, velocity_m_per_s, half_acceleration_m_per_s2 };
        let Some([x_m, y_m]) = before_m else { return path };
        let [to_x_m, to_y_m] = place_m;
        let differences_m = [x_m - to_x_m, y_m - to_y_m];
        let per_s = 1.0 / blend_s;
        for (rate, difference_m) in path.velocity_m_per_s.iter_mut().zip(differences_m) {
            *rate -= 2.0 * per_s * difference_m;
        }
        for (half_rate, difference_m) in path.half_acceleration_m_per_s2.iter_mut().zip(differences_m) {
            *half_rate += per_s * per_s * difference_m;
        }
        Self { place_m: [x_m, y_m], ..path }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REPORT_TICKS: u32 = 400;

    fn track(tracker: &mut Tracker, x_m: f32, tick: u32, age_ticks: u32, predicts: bool) -> Track {
        tracker.report(Touch::Down { x_m, y_m: 0.03, age_ticks }, tick);
        match tracker.next_order(predicts) {
            Some(Order::Track(track)) => track,
            _ => panic!("the report has no new data"),
        }
    }

    fn place_m(track: &Track, tick: u32) -> f32 {
        track.place_m(track.elapsed_s(tick, 25e-6))[0]
    }

    /// The mean interval after reports at these distances.
    fn interval_ticks(distance_ticks: u32) -> f32 {
        let mut tracker = Tracker::new(&Board::SIMULATOR);
        for report in 0..80 {
            track(&mut tracker, 0.02 + 1e-5 * report as f32, report * distance_ticks, 0, true);
        }
        tracker.interval_s * 40_000.0
    }

    #[test]
    fn the_interval_follows_a_fast_source_and_is_at_most_the_report_period() {
        assert!((interval_ticks(80) - 80.0).abs() < 0.1, "{}", interval_ticks(80));
        assert!((interval_ticks(3 * REPORT_TICKS / 2) - REPORT_TICKS as f32).abs() < 0.1);
    }

    #[test]
    fn a_report_after_the_end_of_the_last_track_begins_another_contact() {
        let mut tracker = Tracker::new(&Board::SIMULATOR);
        let first = track(&mut tracker, 0.02, 1000, 0, true);
        let last = track(&mut tracker, 0.02, first.until_tick - 1, 0, true);
        assert_eq!(last.contact, first.contact);
        assert_eq!(track(&mut tracker, 0.02, last.until_tick, 0, true).contact, first.contact + 1);
    }

    #[test]
    fn a_track_from_an_old_sample_ends_when_the_sample_is_too_old() {
        let oldest_ticks = Board::SIMULATOR.ticks(SAMPLE_AGE_MAX_S);
        let track = track(&mut Tracker::new(&Board::SIMULATOR), 0.02, 10_000, oldest_ticks - 10, true);
        assert_eq!(track.until_tick, 10_000 + 10 + 1);
    }

    /// A finger that moves back and forth, with noise: from the third report on, each track starts where the previous
    /// one is, and has reached the estimate after one and a half report intervals.
    #[test]
    fn the_place_does_not_jump_at_a_report() {
        let mut tracker = Tracker::new(&Board::SIMULATOR);
        let mut before: Option<Track> = None;
        let mut jumps_m = 0.0_f32;
        for report in 0..100_u32 {
            let (tick, phase) = (report * REPORT_TICKS, (report as f32 * 0.1).sin());
            let noise_m = if report.is_multiple_of(2) { 2e-5 } else { -2e-5 };
            let track = track(&mut tracker, 0.05 + 0.02 * phase + noise_m, tick + 400, 400, true);
            if let Some(before) = before.filter(|_| report > 1) {
                let difference_m = place_m(&track, tick + 400) - place_m(&before, tick + 400);
                assert!(difference_m.abs() < 1e-7, "report {report}: {difference_m}");
                let [estimated_m, _] = tracker.estimator.after(25e-6 * 1_000.0).place_m;
                let [velocity, _] = track.velocity_m_per_s;
                let led_m = place_m(&track, tick + 1_000);
                assert!((led_m - estimated_m).abs() < 2e-4 + 2e-3 * velocity.abs(), "{led_m}, {estimated_m}");
                let [estimated_now_m, _] = tracker.estimator.after(25e-6 * 400.0).place_m;
                jumps_m = jumps_m.max((place_m(&before, tick + 400) - estimated_now_m).abs());
            }
            before = Some(track);
        }
        assert!(jumps_m > 5e-5, "the estimates jump, so there is something to blend: {jumps_m}");
    }

    /// A report of a steady finger is delayed by a period, and arrives with the next one, with the same stated age.
    #[test]
    fn a_bunched_report_counts_as_lost() {
        let steady_m = |tick: u32| 0.01 + 0.1 * 25e-6 * tick as f32;
        let run = |bunched: bool| {
            let mut tracker = Tracker::new(&Board::SIMULATOR);
            let mut worst_m = 0.0_f32;
            for report in 0..40_u32 {
                let tick = report * REPORT_TICKS;
                match report {
                    20 => continue,
                    21 if bunched => {
                        // One tick before the next report, with a stated age of zero.
                        track(&mut tracker, steady_m(tick - REPORT_TICKS), tick - 1, 0, true);
                    }
                    _ => {}
                }
                let track = track(&mut tracker, steady_m(tick), tick, 0, true);
                if report > 4 {
                    let now = tick + REPORT_TICKS;
                    worst_m = worst_m.max((place_m(&track, now) - steady_m(now)).abs());
                }
            }
            worst_m
        };
        let (lost_m, bunched_m) = (run(false), run(true));
        assert!(lost_m < 1e-5, "{lost_m}");
        assert!(bunched_m < 1e-4, "{bunched_m}");
    }

    /// A touch begins with two reports at once: the second is its first place.
    #[test]
    fn a_touch_may_begin_with_a_bunched_report() {
        let mut tracker = Tracker::new(&Board::SIMULATOR);
        track(&mut tracker, 0.05, 1000, 0, true);
        tracker.report(Touch::Up, 2000);
        assert!(matches!(tracker.next_order(true), Some(Order::Lift)));
        track(&mut tracker, 0.02, 3000, 0, true);
        let second = track(&mut tracker, 0.021, 3001, 0, true);
        assert_eq!((second.place_m[0], second.velocity_m_per_s), (0.021, [0.0; 2]));
    }

    /// Reports at four times the board's rate do not count as bunched, from the first on.
    #[test]
    fn a_fast_source_is_followed_from_its_third_report_on() {
        let mut tracker = Tracker::new(&Board::SIMULATOR);
        for report in 0..6_u32 {
            let tick = report * REPORT_TICKS / 4;
            let track = track(&mut tracker, 0.01 + 0.1 * 25e-6 * tick as f32, tick, 0, true);
            let [velocity, _] = track.velocity_m_per_s;
            assert!(report < 2 || (velocity - 0.1).abs() < 2e-3, "report {report}: {velocity}");
        }
    }

    #[test]
    fn without_prediction_the_track_stays_at_the_measured_place() {
        let mut tracker = Tracker::new(&Board::SIMULATOR);
        for report in 0..20_u32 {
            let (tick, x_m) = (report * REPORT_TICKS, 0.01 + 1e-3 * report as f32);
            let track = track(&mut tracker, x_m, tick + 400, 400, false);
            assert_eq!(track.from_tick, tick);
            assert!((track.place_m[0] - x_m).abs() < 2e-4, "{} {x_m}", track.place_m[0]);
        }
    }

    /// The path's rate includes the correction from one track to the next; the finger's velocity does not.
    #[test]
    fn the_velocity_is_the_fingers() {
        let mut tracker = Tracker::new(&Board::SIMULATOR);
        for report in 0..60_u32 {
            let noise_m = if report.is_multiple_of(2) { 5e-5 } else { -5e-5 };
            let track = track(&mut tracker, 0.01 + 1e-3 * report as f32 + noise_m, report * REPORT_TICKS, 0, true);
            let [velocity, _] = track.velocity_m_per_s;
            assert!(report < 20 || (velocity - 0.1).abs() < 0.01, "report {report}: {velocity}");
        }
    }
}
