//! Repeats the live changes of a recorded play.

use std::time::Duration;
use std::vec;

use frixel_play::{Control, GoesOn, Next, PlayError, SimPlayer};
use frixel_scene::Program;

/// The changes of a play, in the order of their time.
pub(super) struct ReplayedChanges {
    /// The lines that are left, with their executor; `None` for a play without `--control`.
    control: Option<(Control, vec::IntoIter<String>)>,
    /// The scenes that were put on the board after the first.
    later: Vec<Program>,
    /// Tick of the record at which the play was interrupted; `None` for its last one.
    stopped_at_tick: Option<u64>,
    tick_hz: u32,
}

impl ReplayedChanges {
    pub(super) fn new(
        lines: Option<Vec<String>>,
        later: Vec<Program>,
        stopped_at_tick: Option<u64>,
        tick_hz: u32,
    ) -> Self {
        let control = lines.map(|lines| (Control::default(), lines.into_iter()));
        Self { control, later, stopped_at_tick, tick_hz }
    }

    /// Plays until the record is full, the tick of the interruption, a line that ends the play, or until `goes_on`
    /// breaks. It takes the steps that `frixel play` takes, because what a line changes depends on the tick.
    pub(super) fn play(&mut self, player: &mut SimPlayer<'_>, goes_on: GoesOn<'_>) -> Result<(), PlayError> {
        while player.recorder_mut().ticks_left() > 0 && goes_on().is_continue() {
            let ticks = player.recorder_mut().ticks();
            let ticks_left = self.stopped_at_tick.map_or(u64::MAX, |stopped_at| stopped_at.saturating_sub(ticks));
            if ticks_left == 0 {
                break;
            }
            let Some(step_max) = self.carry_out(player)? else { break };
            player.step(step_max.min(duration_within(ticks_left, self.tick_hz)))?;
        }
        Ok(())
    }

    /// Carries out the lines whose time has come. Returns the longest time until the next; `None` if one ends the play.
    fn carry_out(&mut self, player: &mut SimPlayer<'_>) -> Result<Option<Duration>, PlayError> {
        let Some((control, lines)) = &mut self.control else { return Ok(Some(Duration::MAX)) };
        let t_s = player.recorder_mut().t_s();
        match control.step(player, t_s, &mut || lines.next(), &mut |_| {})? {
            Next::GoOn => Ok(Some(control.time_max(t_s))),
            Next::Quit => Ok(None),
            Next::Replace(number) => {
                self.replace(player, &number)?;
                Ok(Some(Duration::ZERO))
            }
        }
    }

    /// Puts a later scene on the board by its number, from 1. The board refuses what it has refused before.
    fn replace(&self, player: &mut SimPlayer<'_>, number: &str) -> Result<(), PlayError> {
        let index = number.parse().ok().and_then(|number: usize| number.checked_sub(1));
        let Some(program) = index.and_then(|index| self.later.get(index)) else { return Ok(()) };
        match player.replace(program.clone()) {
            Err(error) if !error.is_refusal() => Err(error),
            _ => Ok(()),
        }
    }
}

/// A duration that is rounded up to so many ticks.
fn duration_within(ticks: u64, tick_hz: u32) -> Duration {
    Duration::try_from_secs_f64((ticks as f64 - 0.5) / f64::from(tick_hz)).unwrap_or(Duration::MAX)
}
