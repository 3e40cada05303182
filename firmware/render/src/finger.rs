//! What the ticker knows of the finger.

use crate::deadline::{earlier, is_past};
use crate::estimator::{Along, Estimator};
use crate::motion::Motion;
use crate::stillness::{Stillness, StillnessTiming};
use crate::{Board, Touch};
use frixel_layers::range::LENGTH_MAX_M;

/// Touch data is too old to use after this many report periods without a report.
const STALE_AFTER_PERIODS: f32 = 3.0;
/// A sample older than this says nothing of where the finger is now, in s.
const SAMPLE_AGE_MAX_S: f32 = 0.1;
/// Part of the report period that two samples are taken to be apart at least.
const STEP_MIN_PERIODS: f32 = 0.25;

/// What belongs to the board's touch source and is computed once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FingerTiming {
    tick_period_s: f32,
    stale_after_ticks: u32,
    sample_age_max_ticks: u32,
    step_min_s: f32,
    stillness: StillnessTiming,
}

impl FingerTiming {
    pub(crate) fn new(board: &Board) -> Self {
        Self {
            tick_period_s: board.tick_period_s(),
            stale_after_ticks: board.ticks(STALE_AFTER_PERIODS * board.limits.touch_report_period_s),
            sample_age_max_ticks: board.ticks(SAMPLE_AGE_MAX_S),
            step_min_s: STEP_MIN_PERIODS * board.limits.touch_report_period_s,
            stillness: StillnessTiming::new(board.tick_hz),
        }
    }

    #[cfg(feature = "stream")]
    pub(crate) fn tick_period_s(&self) -> f32 {
        self.tick_period_s
    }
}

/// The finger on the screen, if there is one.
///
/// A report is taken in by small steps, so that no tick has much of it to do: first by [`Finger::take`], then by
/// [`Finger::go_on`] as long as there is an errand.
pub(crate) struct Finger {
    x: Motion,
    y: Motion,
    stillness: Stillness,
    presence: Presence,
    errand: Errand,
    /// The newest sample.
    sample: Sample,
    /// When the newest sample was true; outlives stale data, so that a source that is stuck does not start anew.
    sampled_at_tick: Option<u32>,
    estimator: Estimator,
    velocity_m_per_s: [f32; 2],
}

/// What comes next in taking in the newest report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Errand {
    /// Nothing.
    None,
    /// To find what the sample weighs.
    Weigh,
    UpdateX,
    UpdateY,
    LocateX,
    LocateY,
    /// To find whether it is slow.
    Judge,
    /// To say that it is there.
    Arrive,
    /// To look at what has changed.
    Look,
}

/// A place at which the finger was.
#[derive(Clone, Copy, Debug)]
struct Sample {
    place_m: [f32; 2],
    at_tick: u32,
    /// Without another report the finger is stale at this tick.
    until_tick: u32,
}

/// Whether there is a finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Presence {
    /// The source says that there is none.
    Up,
    /// The source has said nothing new for too long.
    Stale,
    /// There is one. Without another report it is stale at this tick.
    Down { until_tick: u32 },
}

impl Finger {
    pub(crate) const UP: Self = Self {
        x: Motion::resting_at(0.0),
        y: Motion::resting_at(0.0),
        stillness: Stillness::MOVING,
        presence: Presence::Up,
        errand: Errand::None,
        sample: Sample { place_m: [0.0; 2], at_tick: 0, until_tick: 0 },
        sampled_at_tick: None,
        estimator: Estimator::NEW,
        velocity_m_per_s: [0.0; 2],
    };

    pub(crate) fn presence(&self) -> Presence {
        self.presence
    }

    /// There is a finger.
    #[inline]
    pub(crate) fn is_there(&self) -> bool {
        matches!(self.presence, Presence::Down { .. })
    }

    /// The last report is taken in wholly, so that another may be taken.
    #[inline]
    pub(crate) fn is_ready(&self) -> bool {
        self.errand == Errand::None
    }

    /// Takes a report of the touch source; one that is not a lift only when [`Finger::is_ready`], which no source is kept from
    /// for more than 18 ticks. A finger that comes down is there when its report is taken in; one that is lifted is gone at
    /// once. Returns whether the report was taken.
    pub(crate) fn take(&mut self, touch: Touch, now_tick: u32, timing: &FingerTiming) -> bool {
        match touch {
            Touch::Up => {
                self.lift(Presence::Up);
                self.sampled_at_tick = None;
                true
            }
            Touch::Down { x_m, y_m, age_ticks } if self.is_ready() => {
                let newer = self.sampled_at_tick.is_none_or(|tick| age_ticks < now_tick.wrapping_sub(tick));
                // A report that says nothing new does not keep the output alive: the source may be stuck.
                let somewhere = [x_m, y_m].into_iter().all(|place_m| place_m.abs() <= LENGTH_MAX_M as f32);
                let taken = newer && age_ticks <= timing.sample_age_max_ticks && somewhere;
                if taken {
                    let at_tick = now_tick.wrapping_sub(age_ticks);
                    let left_ticks = timing.sample_age_max_ticks - age_ticks;
                    let until_tick = now_tick.wrapping_add(timing.stale_after_ticks.min(left_ticks) + 1);
                    self.sampled_at_tick = Some(at_tick);
                    self.sample = Sample { place_m: [x_m, y_m], at_tick, until_tick };
                    self.errand = Errand::Weigh;
                    if self.is_there() {
                        self.presence = Presence::Down { until_tick };
                    }
                }
                taken
            }
            Touch::Down { .. } => false,
        }
    }

    /// There is something to do before the next report: the last one is not taken in wholly, or the gain is on its way.
    #[inline]
    pub(crate) fn has_errand(&self) -> bool {
        !self.is_ready() || self.stillness.is_ramping()
    }

    /// Does the next of what there is to do. Returns whether that is to look at what the last report has changed.
    pub(crate) fn go_on(&mut self, now_tick: u32, prediction: bool, timing: &FingerTiming) -> bool {
        let [x_m, y_m] = self.sample.place_m;
        match self.errand {
            Errand::None => self.stillness.settle(now_tick),
            Errand::Weigh => {
                let says_anything = self.estimator.weigh(self.sample.at_tick, timing.tick_period_s, timing.step_min_s);
                self.errand = if says_anything { Errand::UpdateX } else { Errand::None };
            }
            Errand::UpdateX => {
                self.estimator.update(Along::X, x_m);
                self.errand = Errand::UpdateY;
            }
            Errand::UpdateY => {
                self.estimator.update(Along::Y, y_m);
                self.errand = Errand::LocateX;
            }
            Errand::LocateX => {
                self.locate_along(Along::X, now_tick, prediction, timing);
                self.errand = Errand::LocateY;
            }
            Errand::LocateY => {
                self.locate_along(Along::Y, now_tick, prediction, timing);
                self.errand = Errand::Judge;
            }
            Errand::Judge => {
                self.stillness.take(self.velocity_m_per_s, now_tick, &timing.stillness);
                self.errand = Errand::Arrive;
            }
            Errand::Arrive => {
                self.presence = Presence::Down { until_tick: self.sample.until_tick };
                self.errand = Errand::Look;
            }
            Errand::Look => {
                self.errand = Errand::None;
                // A source whose next report is here already leaves no other time for it.
                if self.stillness.is_ramping() {
                    self.stillness.settle(now_tick);
                }
                return true;
            }
        }
        false
    }

    /// Finds anew where the finger is at a tick and how it goes on, now that another scene may say so in another way.
    pub(crate) fn locate(&mut self, now_tick: u32, prediction: bool, timing: &FingerTiming) {
        // With a sample that is weighed and not taken by both axes, they are of different times; they are located soon.
        let between = matches!(self.errand, Errand::UpdateX | Errand::UpdateY);
        if self.is_there() && !between {
            self.locate_along(Along::X, now_tick, prediction, timing);
            self.locate_along(Along::Y, now_tick, prediction, timing);
        }
    }

    #[inline(never)]
    fn locate_along(&mut self, along: Along, now_tick: u32, prediction: bool, timing: &FingerTiming) {
        let estimate = self.estimator.at(along, now_tick, timing.tick_period_s);
        let ([x_m_per_s, y_m_per_s], [seen_x_m, seen_y_m]) = (&mut self.velocity_m_per_s, self.sample.place_m);
        let (motion, velocity_m_per_s, seen_m) = match along {
            Along::X => (&mut self.x, x_m_per_s, seen_x_m),
            Along::Y => (&mut self.y, y_m_per_s, seen_y_m),
        };
        *velocity_m_per_s = estimate.velocity_m_per_s;
        // Without prediction the finger is taken to stay where it was last seen.
        *motion = if prediction { Motion::of(&estimate, timing.tick_period_s) } else { Motion::resting_at(seen_m) };
    }

    /// When [`Self::expire`] has to be asked, if there is a finger.
    pub(crate) fn expires_at_tick(&self) -> Option<u32> {
        match (self.presence, self.stillness.still_at_tick()) {
            (Presence::Down { until_tick }, Some(still_at_tick)) => Some(earlier(until_tick, still_at_tick)),
            (Presence::Down { until_tick }, None) => Some(until_tick),
            _ => None,
        }
    }

    /// Lets go of a finger that is stale at a tick, or will be before it, and ramps one away that is still.
    pub(crate) fn expire(&mut self, now_tick: u32, timing: &FingerTiming) {
        self.stillness.expire(now_tick, &timing.stillness);
        if let Presence::Down { until_tick } = self.presence
            && is_past(until_tick, now_tick)
        {
            self.lift(Presence::Stale);
        }
    }

    /// Forgets the finger. What is left of its estimator means nothing without samples.
    #[cold]
    #[inline(never)]
    fn lift(&mut self, presence: Presence) {
        *self = Self { presence, sampled_at_tick: self.sampled_at_tick, ..Self::UP };
    }

    /// Goes on by a tick.
    #[inline]
    pub(crate) fn advance(&mut self) {
        self.x.advance();
        self.y.advance();
    }

    /// On the friction under the finger: below 1 while it is still or has been so.
    #[inline]
    pub(crate) fn gain(&self) -> f32 {
        self.stillness.gain()
    }

    /// Where the finger is taken to be, in m.
    #[inline]
    pub(crate) fn place_m(&self) -> [f32; 2] {
        [self.x.place_m(), self.y.place_m()]
    }

    /// Its velocity as of the last report, in m/s.
    #[cfg(feature = "speed")]
    #[inline]
    pub(crate) fn velocity_m_per_s(&self) -> [f32; 2] {
        self.velocity_m_per_s
    }

    /// Its speed as of the last report, in m/s.
    pub(crate) fn speed_m_per_s(&self) -> f32 {
        let [x, y] = self.velocity_m_per_s;
        frixel_layers::square_root(x * x + y * y)
    }
}
