//! What the ticker knows of the finger.

use crate::estimator::Estimator;
use crate::motion::Motion;
use crate::stillness::{Stillness, StillnessTiming};
use crate::{Board, Touch};

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
/// A report is taken in over four ticks, a step each: [`Finger::take`], then [`Finger::digest`] three times. Only a
/// source that reports more often than that makes a tick do all of it.
pub(crate) struct Finger {
    motion: Motion,
    stillness: Stillness,
    presence: Presence,
    report: Report,
    /// The newest sample.
    sample: Sample,
    /// When the newest sample was true; outlives stale data, so that a source that is stuck does not start anew.
    sampled_at_tick: Option<u32>,
    estimator: Estimator,
    velocity_m_per_s: [f32; 2],
}

/// How far the newest report has been taken in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Report {
    Digested,
    /// The estimator does not know the sample yet.
    Taken,
    /// The estimator knows it; the motion is still that of the report before.
    Estimated,
    /// The motion is this report's; whether the finger is still is not known yet.
    Located,
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
        motion: Motion::resting_at([0.0; 2]),
        stillness: Stillness::MOVING,
        presence: Presence::Up,
        report: Report::Digested,
        sample: Sample { place_m: [0.0; 2], at_tick: 0, until_tick: 0 },
        sampled_at_tick: None,
        estimator: Estimator::NEW,
        velocity_m_per_s: [0.0; 2],
    };

    pub(crate) fn presence(&self) -> Presence {
        self.presence
    }

    /// Takes a report of the touch source. A finger that comes down is there when the report is digested; one that is
    /// lifted is gone at once.
    pub(crate) fn take(&mut self, touch: Touch, now_tick: u32, prediction: bool, timing: &FingerTiming) {
        if self.is_digesting() {
            self.digest_whole(now_tick, prediction, timing);
        }
        match touch {
            Touch::Up => {
                self.lift(Presence::Up);
                self.sampled_at_tick = None;
            }
            Touch::Down { x_m, y_m, age_ticks } => {
                let newer = self.sampled_at_tick.is_none_or(|tick| age_ticks < now_tick.wrapping_sub(tick));
                // A report that says nothing new does not keep the output alive: the source may be stuck.
                if newer && age_ticks <= timing.sample_age_max_ticks && x_m.is_finite() && y_m.is_finite() {
                    let at_tick = now_tick.wrapping_sub(age_ticks);
                    let left_ticks = timing.sample_age_max_ticks - age_ticks;
                    let until_tick = now_tick.wrapping_add(timing.stale_after_ticks.min(left_ticks) + 1);
                    self.sampled_at_tick = Some(at_tick);
                    self.sample = Sample { place_m: [x_m, y_m], at_tick, until_tick };
                    self.report = Report::Taken;
                    if matches!(self.presence, Presence::Down { .. }) {
                        self.presence = Presence::Down { until_tick };
                    }
                }
            }
        }
    }

    /// The newest report has not been taken in wholly.
    #[inline]
    pub(crate) fn is_digesting(&self) -> bool {
        self.report != Report::Digested
    }

    /// Takes in the newest report by another step.
    pub(crate) fn digest(&mut self, now_tick: u32, prediction: bool, timing: &FingerTiming) {
        match self.report {
            Report::Digested => {}
            Report::Taken => {
                let Sample { at_tick, place_m, .. } = self.sample;
                self.estimator.update(at_tick, place_m, timing.tick_period_s, timing.step_min_s);
                self.report = Report::Estimated;
            }
            Report::Estimated => {
                self.presence = Presence::Down { until_tick: self.sample.until_tick };
                self.report = Report::Located;
                self.locate(now_tick, prediction, timing);
            }
            Report::Located => {
                self.report = Report::Digested;
                self.stillness.take(self.velocity_m_per_s);
            }
        }
    }

    /// Takes in what is left of the newest report at once: a source that is faster is not to starve the finger.
    #[cold]
    #[inline(never)]
    fn digest_whole(&mut self, now_tick: u32, prediction: bool, timing: &FingerTiming) {
        while self.is_digesting() {
            self.digest(now_tick, prediction, timing);
        }
    }

    /// Estimates anew where the finger is at a tick and how it goes on; without prediction it is taken to stay where
    /// it was last seen.
    pub(crate) fn locate(&mut self, now_tick: u32, prediction: bool, timing: &FingerTiming) {
        if !matches!(self.presence, Presence::Down { .. }) {
            return;
        }
        let estimate = self.estimator.at(now_tick, timing.tick_period_s);
        self.velocity_m_per_s = estimate.velocity_m_per_s;
        self.motion = if prediction {
            let half_acceleration_m_per_s2 = estimate.half_acceleration_m_per_s2;
            let period_s = timing.tick_period_s;
            Motion::new(estimate.place_m, estimate.velocity_m_per_s, half_acceleration_m_per_s2, period_s)
        } else {
            Motion::resting_at(self.sample.place_m)
        };
    }

    /// Lets go of a finger that is stale at a tick, or will be before it.
    pub(crate) fn expire(&mut self, now_tick: u32) {
        if let Presence::Down { until_tick } = self.presence
            && until_tick.wrapping_sub(now_tick) as i32 <= 0
        {
            self.lift(Presence::Stale);
        }
    }

    /// Forgets the finger. What is left of its estimator means nothing without samples.
    fn lift(&mut self, presence: Presence) {
        *self = Self { presence, sampled_at_tick: self.sampled_at_tick, ..Self::UP };
    }

    /// Goes on by a tick.
    #[inline]
    pub(crate) fn advance(&mut self) {
        self.motion.advance();
    }

    /// The finger is slow, still, or has been so: it has to be settled at every second tick.
    #[inline]
    pub(crate) fn is_settling(&self) -> bool {
        !self.stillness.is_steady()
    }

    /// Ramps the gain of a finger that is still, or has been so, by two ticks.
    pub(crate) fn settle(&mut self, timing: &FingerTiming) {
        self.stillness.settle(&timing.stillness);
    }

    /// On the friction under the finger: below 1 while it is still or has been so.
    #[inline]
    pub(crate) fn gain(&self) -> f32 {
        self.stillness.gain()
    }

    /// Where the finger is taken to be, in m.
    #[inline]
    pub(crate) fn place_m(&self) -> [f32; 2] {
        self.motion.place_m()
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
        crate::root::square_root(x * x + y * y)
    }
}
