//! When an autonomous scene may play: without a host, only the person at the arm switch and the touch source stop it.

use frixel_control::Board;

/// Whether a board may play an autonomous scene: a simulated one always, a real one with an arm switch that must be
/// held and a touch source of its own. `touch_works` says that this source has reported, where that is needed.
pub(crate) fn may_play_alone(board: &Board, touch_works: bool) -> bool {
    board.kind.is_simulated() || (board.hold_to_run && !board.touch_from_host && touch_works)
}
