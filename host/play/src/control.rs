//! Lines that change a scene while it plays.

use std::time::Duration;

use frixel_driver::{ControlLine, Link};

use crate::error::PlayError;
use crate::player::Player;
use crate::recorded::Recorded;

/// Shortest step, less than a tick: without it, a time that is rounded down would never be reached.
const STEP_MIN: Duration = Duration::from_micros(10);

/// Carries out [`ControlLine`]s in order, each at its time.
#[derive(Clone, Debug, Default)]
pub struct Control {
    lines_read: u32,
    /// Time of the play before which no line is carried out, s.
    resume_at_s: f64,
    kept: Option<Vec<String>>,
}

/// Next step of the play.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    /// Continue.
    GoOn,
    /// Replace the scene with the one in this file.
    Replace(String),
    /// End the play.
    Quit,
}

impl Control {
    /// Creates a control that keeps its lines, for [`Self::kept`]. On a board in real time, they do not reproduce the
    /// play.
    pub fn keeping_lines() -> Self {
        Self { kept: Some(Vec::new()), ..Self::default() }
    }

    /// The lines so far; `None` if they are not kept. Lines that `replace` a scene, and those that cannot be read, are
    /// left out.
    pub fn kept(&self) -> Option<&[String]> {
        self.kept.as_deref()
    }

    /// Number of the line that still waits at time `t_s` of the play, if one does.
    pub fn waiting_line(&self, t_s: f64) -> Option<u32> {
        (self.resume_at_s > t_s).then_some(self.lines_read)
    }

    /// Keeps a line that replaces the scene with the one of this number.
    pub fn keep_replace(&mut self, number: usize) {
        if let Some(kept) = &mut self.kept {
            kept.push(format!("replace {number}"));
        }
    }

    /// Longest time that the play may go on at time `t_s` without [`Self::step`], unless a line comes meanwhile.
    pub fn time_max(&self, t_s: f64) -> Duration {
        let until_next_s = if self.resume_at_s > t_s { self.resume_at_s - t_s } else { f64::INFINITY };
        Duration::try_from_secs_f64(until_next_s).unwrap_or(Duration::MAX).max(STEP_MIN)
    }

    /// Ends triggers, and carries out the lines of `next_line` that are due at time `t_s` of the play.
    ///
    /// Stops when there is no line, or one has to wait. Calls `say` with a sentence for each refusal or clamped layer.
    ///
    /// # Errors
    ///
    /// Fails if the connection is lost, or if the board stopped. A refusal is passed to `say`, and the play continues.
    pub fn step<L: Link + Recorded>(
        &mut self,
        player: &mut Player<L>,
        t_s: f64,
        next_line: &mut dyn FnMut() -> Option<String>,
        say: &mut dyn FnMut(String),
    ) -> Result<Next, PlayError> {
        end_triggers(player, say)?;
        while t_s >= self.resume_at_s {
            let Some(line) = next_line() else { break };
            self.lines_read += 1;
            let origin = format!("line {} of standard input", self.lines_read);
            let parsed = ControlLine::parse(&line);
            self.keep(line, parsed.as_ref().ok().and_then(Option::as_ref));
            let changed = match parsed {
                Ok(None) => continue,
                Ok(Some(ControlLine::Quit)) => return Ok(Next::Quit),
                Ok(Some(ControlLine::Replace { file })) => return Ok(Next::Replace(file)),
                Ok(Some(ControlLine::Wait { duration_s })) => {
                    self.resume_at_s = t_s + duration_s;
                    continue;
                }
                Ok(Some(ControlLine::Layer { layer, on, gain })) => player.change_layer(&layer, on, gain),
                Ok(Some(ControlLine::Trigger { layer, duration_s })) => player.trigger(&layer, duration_s),
                Err(error) => {
                    say(format!("{origin}: {error}"));
                    continue;
                }
            };
            match changed {
                Ok(change) => change.notice().into_iter().for_each(|notice| say(format!("{origin}: {notice}"))),
                Err(error) if error.is_refusal() => say(format!("{origin}: {error}")),
                Err(error) => return Err(error),
            }
        }
        Ok(Next::GoOn)
    }

    fn keep(&mut self, line: String, parsed: Option<&ControlLine>) {
        let is_kept = parsed.is_some_and(|parsed| !matches!(parsed, ControlLine::Replace { .. }));
        if let Some(kept) = self.kept.as_mut().filter(|_| is_kept) {
            kept.push(line);
        }
    }
}

/// Ends triggers, and reports what the board refuses.
fn end_triggers<L: Link + Recorded>(player: &mut Player<L>, say: &mut dyn FnMut(String)) -> Result<(), PlayError> {
    loop {
        match player.end_triggers() {
            Err(refused @ PlayError::TriggerEnd { .. }) => say(refused.to_string()),
            ended => return ended,
        }
    }
}
