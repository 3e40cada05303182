//! The finger's state in the tick: its track, if a finger is on the screen.

use crate::Track;
use crate::board::Board;
use crate::tick_count::is_past;

/// Touch data is stale after this many report periods without a report, at most [`STALE_MAX_S`].
const STALE_AFTER_PERIODS: f32 = 4.0;
/// Longest time without a report for which a board drives a finger, in s, for any report period. A lifted finger must
/// not meet a driven screen when it returns, and the position of the finger is unknown after this time.
const STALE_MAX_S: f32 = 40e-3;
/// The friction falls in the last of this many equal parts of the time until touch data is stale: after three report
/// periods.
const FALL_PART: f32 = 4.0;

/// Ticks without a report until touch data is stale.
pub fn stale_after_ticks(board: &Board) -> u32 {
    board.ticks((STALE_AFTER_PERIODS * board.limits.touch_report_period_s).min(STALE_MAX_S))
}

/// Fall of the friction's gain per tick before touch data is stale, given the ticks until it is stale.
pub(crate) fn fall_per_tick(stale_after_ticks: u32) -> f32 {
    FALL_PART / stale_after_ticks.max(1) as f32
}

/// Whether there is a finger, and its track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Finger {
    /// The touch source has reported that no finger is on the screen.
    Up,
    /// The touch source has not reported anything new for too long.
    Stale,
    /// The finger follows a track.
    Down(Track),
}

impl Finger {
    /// The track of the finger, if there is one.
    #[inline]
    pub(crate) fn track(&self) -> Option<&Track> {
        match self {
            Self::Down(track) => Some(track),
            Self::Up | Self::Stale => None,
        }
    }

    /// Replaces the track, and limits it to `ticks_max` ticks from now. Returns whether the finger was lifted in
    /// between.
    pub(crate) fn follow(&mut self, track: &Track, now_tick: u32, ticks_max: u32) -> bool {
        let was_lifted = self.track().is_some_and(|before| before.contact != track.contact);
        *self = if is_past(track.until_tick, now_tick) {
            Self::Stale
        } else {
            let ticks = track.until_tick.wrapping_sub(now_tick).min(ticks_max);
            Self::Down(Track { until_tick: now_tick.wrapping_add(ticks), ..*track })
        };
        was_lifted
    }

    /// Replaces an ended track by [`Self::Stale`]. It would otherwise become valid again after the tick counter wraps.
    /// Called in every tick.
    #[inline]
    pub(crate) fn expire(&mut self, now_tick: u32) {
        if self.track().is_some_and(|track| is_past(track.until_tick, now_tick)) {
            *self = Self::Stale;
        }
    }
}
