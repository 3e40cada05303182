//! The plan of a play, which is checked as a whole before any file is written.

use std::io::stdin;
use std::path::Path;
use std::time::Duration;

use frixel::stream::Feed;
use frixel_hil_sim::Stroke;
use frixel_scene::recorder::Recorder;
use frixel_scene::{Program, Scene, compile};
use frixel_wire::hello::BoardLimits;

use super::super::stroke::{check_on_screen, stroke};
use super::rigs::Target;
use super::{CommandError, PlayArgs};

/// Highest rate of telemetry that a board sends, in messages a second (PROTOCOL, `Subscribe`).
const TELEMETRY_MAX_HZ: u32 = 1000;
/// Highest rate of telemetry that the emulated serial port can transfer, in messages a second.
const EMULATED_TELEMETRY_HZ: u32 = 100;

/// A compiled scene, with the options of its play.
pub(super) struct Plan {
    pub(super) target: Target,
    pub(super) program: Program,
    pub(super) feed: Option<Feed>,
    ticks_per_row: u32,
    /// Ticks between two telemetry messages; 0 for rigs whose ticks are observed directly.
    pub(super) telemetry_period_ticks: u32,
    limits: BoardLimits,
    tick_hz: u32,
    /// Duration in seconds; `None` for a play without an end.
    seconds: Option<f64>,
}

/// Rejects options that the board named by `--port` does not support.
pub(super) fn check_options(args: &PlayArgs, target: Target) -> Result<(), CommandError> {
    let port = || args.port.clone();
    match target {
        Target::Simulator | Target::Emulator if args.watch => Err(CommandError::WatchInVirtualTime { port: port() }),
        Target::Emulator if args.stream.is_some() => Err(CommandError::StreamOnEmulated),
        Target::Port if args.stroke.is_some() => Err(CommandError::StrokeOnBoard { port: port() }),
        Target::Port if args.csv_hz > TELEMETRY_MAX_HZ => {
            Err(CommandError::CsvTooFast { port: port(), found: args.csv_hz, max: TELEMETRY_MAX_HZ })
        }
        Target::Port if args.watch && args.stream.is_some() => Err(CommandError::WatchWithStream),
        _ => Ok(()),
    }
}

impl Plan {
    /// Compiles the scene for a board, and prints the notes of the compiler.
    pub(super) fn new(
        args: &PlayArgs,
        scene: &Scene,
        target: Target,
        (limits, tick_hz): (&BoardLimits, u32),
    ) -> Result<Self, CommandError> {
        let ticks_per_row = ticks_per_row(args.csv_hz, tick_hz)?;
        args.seconds.map_or(Ok(()), |seconds| check_seconds(seconds, tick_hz))?;
        let program = compile(scene, limits, tick_hz)?;
        print_notes(&program);
        let telemetry_period_ticks = match target {
            Target::Simulator => 0,
            Target::Emulator => tick_hz / EMULATED_TELEMETRY_HZ,
            Target::Port => telemetry_period_ticks(&program, ticks_per_row, tick_hz),
        };
        let feed = open_feed(args, tick_hz, target)?;
        let (limits, seconds) = (*limits, args.seconds);
        Ok(Self { target, program, feed, ticks_per_row, telemetry_period_ticks, limits, tick_hz, seconds })
    }

    /// Chooses the path of the simulated finger over the screen. Without `--seconds`, the play lasts as long as the
    /// stroke.
    pub(super) fn choose_stroke(&mut self, args: &PlayArgs) -> Result<Stroke, CommandError> {
        let header = &self.program.header;
        let (width_m, height_m) = (header.screen_width_m.into(), header.screen_height_m.into());
        let stroke = stroke(args.stroke.as_deref(), width_m, height_m, args.seconds)?;
        let seconds = args.seconds.unwrap_or(stroke.duration_s());
        check_seconds(seconds, self.tick_hz)?;
        if let Some(path) = &args.stroke {
            check_on_screen(path, &stroke, width_m, height_m, seconds)?;
        }
        self.seconds = Some(seconds);
        Ok(stroke)
    }

    /// Duration of the play, s; infinity for a play without an end.
    pub(super) fn seconds(&self) -> f64 {
        self.seconds.unwrap_or(f64::INFINITY)
    }

    /// Longest duration on the clock of the link. In virtual time, the play ends with the record instead.
    pub(super) fn time_max(&self) -> Duration {
        if self.target.is_virtual_time() {
            return Duration::MAX;
        }
        Duration::try_from_secs_f64(self.seconds()).unwrap_or(Duration::MAX)
    }

    /// Creates the recorder of the play. In virtual time, it ends after exactly the ticks of the play.
    pub(super) fn recorder(&self) -> Result<Recorder, CommandError> {
        let ticks = (self.seconds() * f64::from(self.tick_hz)).round() as u64;
        let ticks_max = if self.target.is_virtual_time() { ticks } else { u64::MAX };
        let recorder = Recorder::new(&self.program, &self.limits, self.tick_hz, ticks_max, self.ticks_per_row);
        recorder.map_err(CommandError::Finger)
    }
}

/// Prints the values that the compiler converted, rounded or clamped.
pub(super) fn print_notes(program: &Program) {
    for note in &program.notes {
        super::note(note);
    }
}

/// Ticks between two rows of `felt.csv`.
fn ticks_per_row(csv_hz: u32, tick_hz: u32) -> Result<u32, CommandError> {
    let divides = |rate: &u32| tick_hz.is_multiple_of(*rate);
    if csv_hz > 0 && divides(&csv_hz) {
        return Ok(tick_hz / csv_hz);
    }
    let below = (1..csv_hz.min(tick_hz)).rev().find(divides);
    let above = (csv_hz..=tick_hz).find(divides);
    let nearest: Vec<String> = [below, above].iter().flatten().map(u32::to_string).collect();
    Err(CommandError::CsvUneven { found: csv_hz, tick_hz, nearest: nearest.join(" or ") })
}

/// Ticks between two telemetry messages: normally one message per row. If the reference depends on the past, the
/// board sends as many messages as it can, and each row is their mean.
fn telemetry_period_ticks(program: &Program, ticks_per_row: u32, tick_hz: u32) -> u32 {
    let least = tick_hz.div_ceil(TELEMETRY_MAX_HZ);
    let divides = |period: &u32| ticks_per_row.is_multiple_of(*period);
    if program.has_history() { (least..=ticks_per_row).find(divides).unwrap_or(ticks_per_row) } else { ticks_per_row }
}

/// Rejects a duration that is shorter than a tick.
fn check_seconds(seconds: f64, tick_hz: u32) -> Result<(), CommandError> {
    let tick_s = 1.0 / f64::from(tick_hz);
    if seconds < tick_s { Err(CommandError::TooShort { seconds, tick_s }) } else { Ok(()) }
}

/// Opens the source that `--stream` names. The simulator waits when a pipe is empty; other boards run out of samples.
fn open_feed(args: &PlayArgs, tick_hz: u32, target: Target) -> Result<Option<Feed>, CommandError> {
    let waits = target == Target::Simulator;
    match (args.stream.as_deref(), args.stream_hz) {
        (None, None) => Ok(None),
        (None, Some(_)) => Err(CommandError::StreamRateAlone),
        (Some(path), Some(sample_hz)) if path == Path::new("-") => {
            Ok(Some(Feed::raw(stdin(), sample_hz, tick_hz, waits)?))
        }
        (Some(path), None) if path == Path::new("-") => Err(CommandError::StreamRateMissing),
        (Some(path), Some(_)) => Err(CommandError::StreamRateOfFile { path: path.to_owned() }),
        (Some(path), None) => Ok(Some(Feed::wav(path, tick_hz)?)),
    }
}
