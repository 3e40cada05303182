//! Turns touch reports into tracks.
//!
//! Reports are late, rare and noisy, but the tick needs a position at any time. The tracker makes an immutable
//! [`Track`] from each report with new data. Tracks and lifts become orders, one after the other. The tracker reads no
//! clock: it gets tick counts.

use frixel_layers::range::LENGTH_MAX_M;

use crate::estimator::{Estimate, Estimator};
use crate::standstill::{Standstill, StandstillTiming};
use frixel_control::STALE_AFTER_PERIODS;
use frixel_control::is_past;
use frixel_control::{Board, Order, StandstillRamp, Track};

/// One report of the touch source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touch {
    /// A finger is on the screen.
    Down {
        /// From the left edge of the screen, in m.
        x_m: f32,
        /// From the top edge of the screen, in m.
        y_m: f32,
        /// Ticks since the position was measured, as far as the source knows.
        age_ticks: u32,
    },
    /// No finger is on the screen.
    Up,
}

/// Samples older than this are ignored, in s.
const SAMPLE_AGE_MAX_S: f32 = 0.1;
/// Least time between two samples that the estimator assumes, as a fraction of the report period.
const STEP_MIN_PERIODS: f32 = 0.25;

/// Constants of the board's touch source, computed once.
#[derive(Clone, Copy, Debug)]
struct Timing {
    tick_period_s: f32,
    stale_after_ticks: u32,
    sample_age_max_ticks: u32,
    step_min_s: f32,
    standstill: StandstillTiming,
}

/// A measured position of the finger.
#[derive(Clone, Copy, Debug)]
struct Sample {
    place_m: [f32; 2],
    /// Tick at which the finger was there.
    at_tick: u32,
    /// Tick at which its report arrived.
    reported_at_tick: u32,
}

/// Turns touch reports into tracks.
///
/// Reports wait until [`Self::next_order`] takes them. A newer position replaces a waiting one, but never a waiting
/// lift: the lift and the touch-down after it are two orders.
pub(crate) struct Tracker {
    timing: Timing,
    /// A lift waits for [`Self::next_order`].
    lift: bool,
    /// A position that waits for [`Self::next_order`], after the lift.
    sample: Option<Sample>,
    /// Time of the newest reported position. It is kept when the finger is lost, so that a source that repeats an old
    /// position does not bring the finger back.
    newest_at_tick: Option<u32>,
    estimator: Estimator,
    standstill: Standstill,
    /// Number of the contact that the last track belongs to.
    contact: u32,
    /// When the last track ends; `None` without a finger.
    until_tick: Option<u32>,
}

impl Tracker {
    /// A tracker without a finger.
    pub(crate) fn new(board: &Board) -> Self {
        Self {
            timing: Timing {
                tick_period_s: board.tick_period_s(),
                stale_after_ticks: board.ticks(STALE_AFTER_PERIODS * board.limits.touch_report_period_s),
                sample_age_max_ticks: board.ticks(SAMPLE_AGE_MAX_S),
                step_min_s: STEP_MIN_PERIODS * board.limits.touch_report_period_s,
                standstill: StandstillTiming::new(board.tick_hz),
            },
            lift: false,
            sample: None,
            newest_at_tick: None,
            estimator: Estimator::NEW,
            standstill: Standstill::MOVING,
            contact: 0,
            until_tick: None,
        }
    }

    /// Takes a report that arrived at `now_tick`. A position that is too old, not newer than the last one, or outside
    /// any screen is ignored: the source may be stuck, and repeated reports must not keep the output enabled.
    pub(crate) fn report(&mut self, touch: Touch, now_tick: u32) {
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

    /// Drops a finger whose last track has ended: the next report begins another contact. Must be called at least once
    /// before the tick counter wraps.
    pub(crate) fn expire(&mut self, now_tick: u32) {
        if self.until_tick.is_some_and(|tick| is_past(tick, now_tick)) {
            self.until_tick = None;
        }
    }

    /// The next order that results from the reports so far: a lift or a track.
    pub(crate) fn next_order<'a>(&mut self) -> Option<Order<'a>> {
        if core::mem::take(&mut self.lift) {
            self.until_tick = None;
            return Some(Order::Lift);
        }
        let sample = self.sample.take()?;
        self.track(&sample).map(Order::Track)
    }

    fn track(&mut self, sample: &Sample) -> Option<Track> {
        let Sample { place_m, at_tick, reported_at_tick } = *sample;
        let timing = self.timing;
        self.expire(reported_at_tick);
        if self.until_tick.is_none() {
            self.contact = self.contact.wrapping_add(1);
            self.estimator = Estimator::NEW;
            self.standstill = Standstill::MOVING;
        }
        let estimate = self.estimator.take(place_m, at_tick, timing.tick_period_s, timing.step_min_s)?;
        let Estimate { place_m, velocity_m_per_s, half_acceleration_m_per_s2 } = estimate;
        let age_ticks = reported_at_tick.wrapping_sub(at_tick);
        let ticks = timing.stale_after_ticks.min(timing.sample_age_max_ticks - age_ticks) + 1;
        let until_tick = reported_at_tick.wrapping_add(ticks);
        self.until_tick = Some(until_tick);
        let track = Track {
            contact: self.contact,
            from_tick: at_tick,
            until_tick,
            place_m,
            velocity_m_per_s,
            half_acceleration_m_per_s2,
            ramp: StandstillRamp::MOVING,
        };
        // Use the current speed, not the speed at the time of the sample, which is late.
        let velocity_now_m_per_s = track.velocity_m_per_s(track.elapsed_s(reported_at_tick, timing.tick_period_s));
        let ramp = self.standstill.take(velocity_now_m_per_s, reported_at_tick, &timing.standstill);
        Some(Track { ramp, ..track })
    }
}
