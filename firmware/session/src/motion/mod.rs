//! The finger's motion.
//!
//! Takes touch reports, of the board's own source and of the host; returns the finger's tracks and lifts as orders. It
//! is independent of scenes, states and hosts: the rule for selecting one of several fingers, and whether the scene
//! predicts the place, are passed to it.
//!
//! `fingers` selects the host's finger to follow; `tracker` turns reports into tracks, with `estimator` and
//! `standstill`.

mod estimator;
mod fingers;
mod standstill;
mod tracker;

use frixel_control::{Board, Order, Status};
use frixel_layers::range::LENGTH_MAX_M;
use frixel_layers::{Leader, within};
use frixel_wire::fault::Flags;
use frixel_wire::message::{Accepted, ConfigField, ConfigRefusal, Refusal};
use frixel_wire::touch::Touch;

use fingers::Fingers;
pub use tracker::Tracker;

/// Number of the finger if the host reports only one.
pub(crate) const ONLY_FINGER: u8 = 0;

/// Fingers and tracker.
pub(crate) struct Motion {
    /// Fingers that the host reported.
    fingers: Fingers,
    tracker: Tracker,
}

impl Motion {
    pub(crate) fn new(board: &Board) -> Self {
        Self { fingers: Fingers::new(), tracker: Tracker::new(board) }
    }

    /// Processes a host's report of a finger's place, which takes effect at the next tick.
    pub(crate) fn touch(
        &mut self,
        finger: u8,
        (x_m, y_m): (f32, f32),
        age_ticks: u16,
        rule: Leader,
        status: &Status,
    ) -> Result<Accepted, Refusal> {
        for place_m in [x_m, y_m] {
            let field = ConfigField::TouchPlace;
            within(field, place_m, -LENGTH_MAX_M as f32, LENGTH_MAX_M as f32, ConfigRefusal::WHOLE_SCENE)
                .map_err(Refusal::Config)?;
        }
        let place = Touch::Down { x_m, y_m, age_ticks: u32::from(age_ticks) };
        // While the friction falls, touch data is stale, but there is still a finger.
        if status.telemetry.flags.contains(Flags::TOUCH_STALE.with(Flags::NO_FINGER)) {
            // Without reports for a while, drop fingers whose lift was lost.
            self.fingers.forget();
        }
        self.fingers.touch(finger, place, rule);
        self.report_fingers(status);
        Ok(Accepted::Done)
    }

    /// Processes a finger's lift reported by the host.
    pub(crate) fn lift(&mut self, finger: u8, rule: Leader, status: &Status) -> Accepted {
        self.fingers.lift(finger, rule);
        self.report_fingers(status);
        Accepted::Done
    }

    /// Forgets all fingers of the host, because a new client has connected.
    pub(crate) fn forget_fingers(&mut self, status: &Status) {
        self.fingers.forget();
        self.report_fingers(status);
    }

    /// Passes the pending reports of the followed finger to the tracker, as of the next tick.
    fn report_fingers(&mut self, status: &Status) {
        while let Some(touch) = self.fingers.next() {
            self.tracker.report(touch, status.telemetry.tick.wrapping_add(1));
        }
    }

    /// Processes a report of the board's own touch source that arrived at `tick`.
    pub(crate) fn report(&mut self, touch: Touch, tick: u32) {
        self.tracker.report(touch, tick);
    }

    /// Drops an ended track, and an outdated report. Called more often than tick counts wrap around.
    pub(crate) fn expire(&mut self, now_tick: u32) {
        self.tracker.expire(now_tick);
    }

    /// The next lift or track. See [`Tracker::next_order`].
    pub(crate) fn next_order<'a>(&mut self, predicts: bool) -> Option<Order<'a>> {
        self.tracker.next_order(predicts)
    }
}
