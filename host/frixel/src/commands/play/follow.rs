//! Plays a plan on an open board, from the upload to the output files.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use crate::commands::error::{at, of_play};
use crate::output::Report;
use crate::rigs::RecordedLink;
use anyhow::{Result, bail};
use frixel_driver::Device;
use frixel_felt::judge::{in_play, starts_off};
use frixel_felt::recorder::JUDGED_MAX_S;
use frixel_lab::recording::{Metadata, check_length, play_fields};
use frixel_play::{LiveLayers, Next, PlayError, Player};
use frixel_scene::Program;

use super::Target;
use super::control::Control;
use super::live_scene::{LiveScene, ReplaceOutcome};
use super::outputs::{Outputs, PlayFiles};
use super::plan::Plan;
use super::progress::Bars;
use super::{Interrupt, PlayArgs, Played, note, waiting};

/// Plays until the plan is complete, the user interrupts it, or the board stops. Everything up to then is recorded.
pub(super) fn follow<L: RecordedLink>(
    args: &PlayArgs,
    plan: Plan,
    device: Device<L>,
    (files, live_scene): (PlayFiles, Option<LiveScene>),
    interrupt: &Interrupt,
) -> Result<Played> {
    let is_simulated = plan.target.is_virtual_time() || device.hello().board.is_simulated();
    check_log(args, is_simulated)?;
    if let (Some(path), Some(rows)) = (&args.record, plan.rows()) {
        check_length(rows, play_fields().len()).map_err(at(path.display()))?;
    }
    let metadata = files.source().map(|source| {
        let of_board =
            Metadata::new(plan.target.name(), Some(device.hello()), is_simulated, args.participant.as_deref());
        let metadata = Metadata { ticks_per_row: plan.ticks_per_row(), ..of_board };
        source.recorded(args.options(plan.stream_s), metadata)
    });
    let outputs = Outputs::create(args, files, is_simulated, &plan.program, metadata)?;
    let recorder = plan.recorder()?;
    let recorder = if args.record.is_some() { recorder.keeping_samples() } else { recorder };
    let player = Player::recording(waiting::watch(device, interrupt), recorder);
    let waits = plan.target == Target::Sim;
    let control = args.control.then(|| Control::start(waits, interrupt)).transpose()?;
    let (bars, writing, refusals) = (Bars::default(), Duration::ZERO, sentences(&plan.program));
    let mut play =
        Play { args, plan, player, outputs, live_scene, control, interrupt, bars, writing, refusals, scenes_put: 0 };
    play.start()?;
    let begin = Instant::now();
    let ended = play.until_over();
    let playing = begin.elapsed().saturating_sub(play.writing);
    Ok(play.finish(ended, playing))
}

/// Refuses to join a log to a play on a real board: the joined rows replace a recording while they are written, and a
/// recording of a person cannot be made again.
fn check_log(args: &PlayArgs, is_simulated: bool) -> Result<()> {
    if args.with_log.is_some() && !is_simulated {
        bail!(
            "--with-log joins the log of a virtual board, and the board at this port is not one: leave it out, so \
             that what a finger does on it is recorded"
        );
    }
    Ok(())
}

/// Why a board refuses a program, a sentence each.
fn sentences(program: &Program) -> Vec<String> {
    program.refusals().map(ToString::to_string).collect()
}

/// A play in progress.
struct Play<'a, L: RecordedLink> {
    args: &'a PlayArgs,
    plan: Plan,
    player: Player<L>,
    outputs: Outputs,
    live_scene: Option<LiveScene>,
    control: Option<Control>,
    interrupt: &'a Interrupt,
    bars: Bars,
    /// Wall time spent on writing files.
    writing: Duration,
    /// Why a board refuses the scenes that were played.
    refusals: Vec<String>,
    /// Number of scenes that were put on the board after the first.
    scenes_put: usize,
}

impl<L: RecordedLink> Play<'_, L> {
    fn start(&mut self) -> Result<()> {
        let Self { args, plan, player, bars, interrupt, .. } = self;
        let started = player.start(plan.program.clone(), plan.telemetry_period_ticks, &mut |progress| {
            bars.upload(progress);
            interrupt.goes_on()
        });
        if started.is_ok() && (args.watch || plan.seconds().is_infinite()) {
            let replaced = if args.watch { "; what is saved replaces it" } else { "" };
            note(format_args!("frixel: {} plays{replaced}; Ctrl-C ends", args.scene.display()));
        }
        started.map_err(|error| self.error(error))
    }

    fn until_over(&mut self) -> Result<()> {
        if let Some(feed) = self.plan.feed.take() {
            self.player.stream(feed).map_err(|error| self.error(error))?;
        }
        let mut left = self.plan.time_max();
        while !left.is_zero() && self.player.recorder_mut().ticks_left() > 0 && !self.interrupt.is_requested() {
            if self.plan.ends_with_stream() && self.player.is_stream_over() {
                break;
            }
            let Some(step_max) = self.control()? else { break };
            let stepped = self.player.step(left.min(step_max));
            self.write_rows()?;
            left = left.saturating_sub(stepped.map_err(|error| self.error(error))?);
            self.refresh_scene()?;
            self.bars.play(self.player.recorder_mut().t_s(), self.plan.seconds());
        }
        self.player.stop().map_err(|error| self.error(error.into()))
    }

    fn write_rows(&mut self) -> Result<()> {
        let begin = Instant::now();
        let recorder = self.player.recorder_mut();
        let rows = recorder.take_rows();
        self.outputs.keep_samples(&recorder.take_samples());
        let written = self.outputs.write(&rows, recorder.markers(), recorder.start_s().unwrap_or(0.0));
        self.writing += begin.elapsed();
        written
    }

    /// Carries out the lines of `--control`. Returns the longest time until they are looked at again; `None` if they
    /// end the play.
    fn control(&mut self) -> Result<Option<Duration>> {
        let t_s = self.player.recorder_mut().t_s();
        let Some(control) = &mut self.control else {
            self.outputs.switch(t_s, self.player.playing().map_or(Vec::new(), LiveLayers::off));
            return Ok(Some(Duration::MAX));
        };
        let say = &mut |sentence| note(format_args!("frixel: {sentence}"));
        let next = control.step(&mut self.player, t_s, say);
        let step_max = control.time_max(t_s);
        self.outputs.switch(t_s, self.player.playing().map_or(Vec::new(), LiveLayers::off));
        match next.map_err(|error| self.error(error))? {
            Next::GoOn => {}
            Next::Quit => return Ok(None),
            Next::Replace(file) => {
                if let Some(live_scene) = &mut self.live_scene {
                    live_scene.load(file.as_ref(), &self.player);
                    self.refresh_scene()?;
                    return Ok(Some(Duration::ZERO));
                }
            }
        }
        Ok(Some(step_max))
    }

    /// Replaces the scene if its file was saved.
    fn refresh_scene(&mut self) -> Result<()> {
        let Some(live_scene) = &mut self.live_scene else { return Ok(()) };
        let refreshed = live_scene.refresh(&mut self.player);
        let Some((files, fate)) = refreshed.map_err(|error| self.error(error))? else { return Ok(()) };
        let t_s = self.player.recorder_mut().t_s();
        self.outputs.keep_scene(t_s, &files, fate == ReplaceOutcome::Refused);
        self.scenes_put += 1;
        if let Some(control) = &mut self.control {
            control.keep_replace(self.scenes_put);
        }
        if let Some(playing) = self.player.playing().filter(|_| fate == ReplaceOutcome::Plays) {
            self.outputs.replace(t_s, playing.program());
            self.refusals.extend(sentences(playing.program()));
            self.plan.program = playing.program().clone();
        }
        Ok(())
    }

    /// Sets the output to zero, then writes the remaining rows.
    fn finish(mut self, ended: Result<()>, playing: Duration) -> Played {
        self.bars.finish();
        let (counters, stream) = (self.player.device().counters(), self.player.device().stream_status());
        let mut recorder = self.player.into_recorder();
        let played_s = recorder.t_s();
        let Plan { program, target, .. } = &self.plan;
        let is_requested = self.interrupt.is_requested() || (ended.is_err() && self.interrupt.was_requested());
        let interrupted = is_requested && target.is_virtual_time();
        if interrupted {
            let seconds = self.plan.seconds();
            note(format_args!("interrupted after {played_s:.3} of {seconds:.3} s: the results below cover that part"));
        }
        if let Some(line) = self.control.as_ref().and_then(|control| control.waiting_line(played_s)) {
            note(format_args!(
                "frixel: line {line} of standard input waits until after the end of the play at {played_s:.3} s: the \
                 lines after it did not run"
            ));
        }
        let rows = recorder.take_rows();
        self.outputs.keep_samples(&recorder.take_samples());
        if let Some(lines) = self.control.as_ref().and_then(Control::kept) {
            self.outputs.keep_lines(lines);
        }
        let written = self.outputs.write(&rows, recorder.markers(), recorder.start_s().unwrap_or(0.0));
        let goes_on = || if is_requested { ControlFlow::Continue(()) } else { self.interrupt.goes_on() };
        let judged = recorder.take_judged();
        let no_verdict = match (&judged, stream) {
            (Some(_), _) => None,
            _ if !target.is_virtual_time() => None,
            (None, Some(_)) => Some("no study covers what a person feels of a stream"),
            (None, None) => Some("something changed the scene while it played"),
        };
        let realtime_factor = target.is_virtual_time().then(|| played_s / playing.as_secs_f64());
        let report = Report::new(target.name(), &recorder.summary(), &program.reach, &counters, realtime_factor);
        let report = Report {
            finger_origin: program.finger.origin.word(),
            simulated: self.outputs.is_simulated(),
            draft: !self.refusals.is_empty(),
            board_refuses: self.refusals,
            untouched_layers: self.outputs.untouched_layers(),
            replaced_at_s: self.outputs.replaced_at_s(),
            in_this_play: judged.and_then(|samples| in_play(program, &samples, &goes_on)),
            is_judged_in_part: played_s > JUDGED_MAX_S,
            no_verdict,
            // A line may have switched them on.
            starts_off: starts_off(program).filter(|_| self.control.is_none()),
            ..report
        };
        let report = report.with_world(self.plan.world).with_stream(stream);
        let marked = (recorder.markers(), is_requested || ended.is_err());
        let finished = written.and_then(|()| self.outputs.finish(program, &report, marked));
        // Ctrl-C in a terminal also ends the emulator, which is not a failure.
        let failure = ended.err().filter(|_| !interrupted);
        let (files, failure) = match finished {
            Ok(files) => (files, failure),
            Err(error) => (Vec::new(), failure.or(Some(error))),
        };
        Played { report, files, failure }
    }

    fn error(&self, error: PlayError) -> anyhow::Error {
        of_play(&self.args.port, error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_is_not_joined_to_what_a_finger_did_on_a_real_board() {
        let mut args = PlayArgs::ideal("a.toml".as_ref(), "out".as_ref()).unwrap();
        assert!(check_log(&args, false).is_ok());
        args.with_log = Some("felt.csv".into());
        assert!(check_log(&args, true).is_ok());
        let refused = check_log(&args, false).unwrap_err().to_string();
        assert!(refused.starts_with("--with-log joins the log of a virtual board"), "{refused}");
    }
}
