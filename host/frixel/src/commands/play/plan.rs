//! The plan of a play, checked as a whole before any file is written.

use frixel_lab::simulate::{check_duration, screen_m, ticks_per_row};
use std::time::Duration;

use crate::commands::error::of_finger;
use crate::output::WorldReport;
use anyhow::{Result, bail};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::RigConfig;
use frixel_play::{Feed, Simulation};
use frixel_scene::{Program, Scene};
use frixel_wire::hello::BoardLimits;
use frixel_wire::message::TELEMETRY_MAX_HZ;

use super::super::stroke::{from_file, note_off_screen};
use super::Target;
use super::{PlayArgs, note, note_refusals};

/// Highest rate of telemetry that the emulated serial port can transfer, in messages a second.
const EMULATED_TELEMETRY_HZ: u32 = 100;

/// A compiled scene, with the options of its play.
pub(super) struct Plan {
    pub(super) target: Target,
    pub(super) program: Program,
    pub(super) feed: Option<Feed>,
    /// Duration of the streamed file, s; `None` without one.
    pub(super) stream_s: Option<f64>,
    /// The world that is simulated beside the board; `None` for a board at a port.
    pub(super) world: Option<WorldReport>,
    /// The play in virtual time; `None` for a board at a port.
    simulation: Option<Simulation>,
    ticks_per_row: u32,
    /// Ticks between two telemetry messages; 0 for rigs whose ticks are observed directly.
    pub(super) telemetry_period_ticks: u32,
    limits: BoardLimits,
    tick_hz: u32,
    /// Duration in seconds; `None` for a play without an end.
    seconds: Option<f64>,
}

/// Rejects options that the board named by `--port` does not support.
pub(super) fn check_options(args: &PlayArgs, target: Target) -> Result<()> {
    let (port, csv_hz) = (&args.port, args.csv_hz);
    if args.control && args.stream.is_standard_input() {
        bail!(
            "standard input cannot carry both the lines of --control and the samples of --stream -: give --stream a \
             file"
        );
    }
    match target {
        Target::Qemu | Target::Pico if args.watch => bail!(
            "--watch follows the file while a board plays in real time, which --port {port} does not: start `frixel \
             sim` and give its port"
        ),
        Target::Sim if args.watch && (args.control || args.stream.is_standard_input()) => bail!(
            "--watch on the simulator plays again after each change, and standard input can be read only once: leave \
             out --control or --stream -, or start `frixel sim` and give its port"
        ),
        Target::Sim | Target::Qemu | Target::Pico if args.with_log.is_some() => bail!(
            "--with-log joins the log of a virtual board at a port, and --port {port} records what is felt itself: \
             leave --with-log out"
        ),
        Target::Qemu | Target::Pico if args.stream.is_given() => {
            bail!(
                "the emulated board's serial port is too slow for a stream: leave --stream out, or play on --port sim"
            )
        }
        Target::Port if args.stroke.is_given() => bail!(
            "a stroke moves the finger of --port sim, --port qemu and --port pico only; a board at {port} has its own: \
             leave out --stroke and --from"
        ),
        Target::Port if args.changes_world() => bail!(
            "--ideal, --skin, --finger-seed and --touch change the world of --port sim, --port qemu and --port \
             pico only; a board at {port} has its own: leave them out"
        ),
        Target::Port if csv_hz > TELEMETRY_MAX_HZ => bail!(
            "{port} sends telemetry at most {TELEMETRY_MAX_HZ} times a second, and --csv-hz {csv_hz} is more: give \
             {TELEMETRY_MAX_HZ} or less"
        ),
        Target::Port if args.watch && args.stream.is_given() => bail!(
            "--watch sends a saved scene while it plays, and a stream runs dry meanwhile: leave out --watch or --stream"
        ),
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
    ) -> Result<Self> {
        let ticks_per_row = ticks_per_row(args.csv_hz, tick_hz).map_err(|error| args.error(error))?;
        args.seconds.map_or(Ok(()), |seconds| check_duration(seconds, tick_hz))?;
        let program = target.compile(scene, limits, tick_hz)?;
        note_refusals(&args.scene, &program);
        print_notes(&program);
        let telemetry_period_ticks = match target {
            Target::Sim => 0,
            Target::Qemu | Target::Pico => tick_hz / EMULATED_TELEMETRY_HZ,
            Target::Port => telemetry_period_ticks(&program, ticks_per_row, tick_hz),
        };
        let feed = args.stream.open(tick_hz, target)?;
        if feed.is_some() && !program.records.iter().any(|record| record.layer.is_streamed()) {
            let scene = args.scene.display();
            bail!("{scene} has no layer that plays a stream: add one with `kind = \"stream\"`, or leave --stream out");
        }
        note_streams(&program, feed.is_some());
        let (limits, seconds) = (*limits, args.seconds);
        Ok(Self {
            target,
            program,
            stream_s: feed.as_ref().and_then(Feed::duration_s),
            feed,
            world: None,
            simulation: None,
            ticks_per_row,
            telemetry_period_ticks,
            limits,
            tick_hz,
            seconds,
        })
    }

    /// The simulation that the options describe around the board of `rig`. Without `--seconds`, the play lasts as long
    /// as the file of `--stream`, while the finger repeats its stroke, or else as long as the stroke.
    pub(super) fn simulation(&mut self, args: &PlayArgs, scene: &Scene, rig: &RigConfig) -> Result<&Simulation> {
        let inputs = (args.stroke.file().map(from_file).transpose()?, args.touch.source()?);
        let simulation = args.options(self.stream_s).simulation(scene, &self.program, inputs, rig);
        let simulation = simulation.map_err(|error| args.error(error))?;
        if args.stroke.is_given() {
            note_off_screen(&args.stroke.name(), &simulation.stroke, screen_m(&self.program), simulation.seconds)?;
        }
        self.seconds = Some(simulation.seconds);
        let touch_source = (&simulation.rig.world.touch).into();
        self.world = Some(WorldReport { effects: args.effects(), touch_source, finger_seed: args.finger_seed });
        Ok(self.simulation.insert(simulation))
    }

    /// Ticks between two rows.
    pub(super) fn ticks_per_row(&self) -> u32 {
        self.ticks_per_row
    }

    /// Whether the play ends when the stream of a board at a port has ended.
    pub(super) fn ends_with_stream(&self) -> bool {
        self.target == Target::Port && self.seconds.is_none()
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

    /// Rows of the play; `None` for a play without an end.
    pub(super) fn rows(&self) -> Option<u64> {
        let rows = self.seconds? * f64::from(self.tick_hz) / f64::from(self.ticks_per_row);
        Some(rows.ceil() as u64)
    }

    /// Creates the recorder of the play. In virtual time, it ends after exactly the ticks of the play.
    pub(super) fn recorder(&self) -> Result<Recorder> {
        if let Some(simulation) = &self.simulation {
            return Ok(simulation.recorder(&self.program)?.judged());
        }
        let recorder = Recorder::new(&self.program, &self.limits, self.tick_hz, u64::MAX, self.ticks_per_row);
        recorder.map_err(of_finger)
    }
}

/// Prints the warnings of the compiler, and the values that it converted, rounded or clamped.
pub(super) fn print_notes(program: &Program) {
    for warning in program.warnings() {
        note(format_args!("warning: {warning}"));
    }
    for sentence in program.notes() {
        note(sentence);
    }
}

/// Prints a note on layers that get no samples.
fn note_streams(program: &Program, has_feed: bool) {
    let streamed = program.records.iter().zip(&program.titles).filter(|(record, _)| record.layer.is_streamed());
    let titles: Vec<&str> = streamed.map(|(_, title)| title.as_str()).collect();
    if !(titles.is_empty() || has_feed) {
        let titles = titles.join(" and ");
        note(format_args!("{titles} plays a stream, and there is no --stream: nothing will be felt there"));
    }
}

/// Ticks between two telemetry messages: normally one message per row. If the reference depends on the past, the
/// board sends as many messages as it can, and each row is their mean.
fn telemetry_period_ticks(program: &Program, ticks_per_row: u32, tick_hz: u32) -> u32 {
    let least = frixel_wire::message::telemetry_period_ticks(tick_hz, TELEMETRY_MAX_HZ);
    let divides = |period: &u32| ticks_per_row.is_multiple_of(*period);
    if program.has_history() { (least..=ticks_per_row).find(divides).unwrap_or(ticks_per_row) } else { ticks_per_row }
}
