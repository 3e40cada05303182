//! When an autonomous scene may play: without a host, only the person at the arm switch and the touch source stop it.

use frixel_control::is_past;
use frixel_wire::message::Refusal;

use crate::commands::Commands;

/// Age of the last report of the board's own touch source up to which the source counts as working, in s. Long enough
/// to touch the screen and then the host; a source that reports nothing while no finger is there must be touched first.
const TOUCH_AGE_MAX_S: f32 = 10.0;

impl Commands<'_> {
    /// Refuses an autonomous scene unless the board may play it: a simulated one always, a real one with an arm switch
    /// that must be held and a touch source of its own. A scene that `plays_at_once` needs a report of that source, too.
    pub(crate) fn check_autonomous(&self, plays_at_once: bool) -> Result<(), Refusal> {
        let board = &self.board;
        let has_reported = self.own_touch_until_tick.is_some() || !plays_at_once;
        let may_play = board.hold_to_run && !board.touch_from_host && has_reported;
        if may_play || board.kind.is_simulated() { Ok(()) } else { Err(Refusal::Autonomous) }
    }

    /// The board's own touch source has reported at `tick`.
    pub(crate) fn own_touch_reported(&mut self, tick: u32) {
        self.own_touch_until_tick = Some(tick.wrapping_add(self.board.ticks(TOUCH_AGE_MAX_S)));
    }

    /// Forgets a report that has become too old. Called more often than tick counts wrap around.
    pub(crate) fn forget_old_touch(&mut self, now_tick: u32) {
        self.own_touch_until_tick = self.own_touch_until_tick.filter(|tick| !is_past(*tick, now_tick));
    }
}
