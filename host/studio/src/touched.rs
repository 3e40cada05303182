//! The finger as seen by the board: the newest report of the touch source, and the place that the firmware predicts
//! from the reports.
//!
//! The page compares both with the finger's true place, to show the lag of friction with and without prediction. The
//! prediction here is the firmware's own, on the same reports, so it is also available while the board plays without.

use frixel_control::{Board, Order, Track, is_past};
use frixel_session::{Touch, Tracker};

/// Follows the touch source.
pub(crate) struct TouchFollower {
    tracker: Tracker,
    tick_period_s: f32,
    track: Option<Track>,
    reported_m: Option<[f32; 2]>,
}

/// The finger's places at a tick, from the screen's top left corner, m; `None` without a finger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct TouchedPlaces {
    /// The place in the newest report, which a board without prediction uses.
    pub(crate) reported_m: Option<[f32; 2]>,
    /// The place that the firmware predicts.
    pub(crate) predicted_m: Option<[f32; 2]>,
}

impl TouchFollower {
    pub(crate) fn new(board: &Board) -> Self {
        let tick_period_s = board.tick_period_s();
        Self { tracker: Tracker::new(board), tick_period_s, track: None, reported_m: None }
    }

    /// Takes what arrived from the touch source before `tick`, and returns the places at that tick.
    pub(crate) fn advance(&mut self, touch: Option<Touch>, tick: u32) -> TouchedPlaces {
        if let Some(touch) = touch {
            self.tracker.report(touch, tick);
            self.reported_m = match touch {
                Touch::Down { x_m, y_m, .. } => Some([x_m, y_m]),
                Touch::Up => None,
            };
        }
        match self.tracker.next_order(true) {
            Some(Order::Track(track)) => self.track = Some(track),
            Some(Order::Lift) => self.track = None,
            _ => {}
        }
        self.track = self.track.filter(|track| !is_past(track.until_tick, tick));
        self.tracker.expire(tick);
        let predicted_m = self.track.map(|track| track.place_m(track.elapsed_s(tick, self.tick_period_s)));
        TouchedPlaces { reported_m: self.reported_m, predicted_m }
    }
}
