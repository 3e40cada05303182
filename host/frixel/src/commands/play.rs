//! `frixel play`: a scene on a board, real or not.
//!
//! `Plan` is the checked input of a play, `rigs` opens the board that `--port` names, `follow` plays and records,
//! and `Outputs` writes the files. This module prints the results.

mod control;
#[cfg(unix)]
mod emulator;
mod follow;
mod live_scene;
mod outputs;
mod plan;
mod progress;
mod record_file;
mod recorded;
pub(super) mod replay;
mod rigs;
mod stream_args;
mod target;
mod watch;
mod with_log;

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use frixel_lab::recording::PlayOptions;

use crate::output::{Effects, Report};

use super::interrupt::Interrupt;
use super::profiles::{ProfileArgs, TouchArgs};
use super::stroke::StrokeArgs;
use super::terminal::{self, note, note_refusals, print_line};
use super::{argument, waiting};
use live_scene::LiveScene;
use outputs::PlayFiles;
use stream_args::StreamArgs;
use target::Target;

#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is an option of its own")]
pub(super) struct PlayArgs {
    /// The scene, a TOML file (docs/scene.md).
    scene: PathBuf,
    #[command(flatten)]
    profiles: ProfileArgs,
    /// `sim` for the simulator in this process, `qemu` for the firmware on an emulated Cortex-M4F, `pico` for the image
    /// of the Pico on an emulated RP2040, or the path of a board's serial port.
    #[arg(long, default_value = "sim")]
    port: String,
    #[command(flatten)]
    stroke: StrokeArgs,
    /// How long to play. Without it, as long as the file of --stream or the stroke lasts; on a board without --stream,
    /// until Ctrl-C.
    #[arg(long, value_name = "S", value_parser = argument::seconds, allow_negative_numbers = true)]
    seconds: Option<f64>,
    /// Output folder. What an earlier play has left there is replaced.
    #[arg(long, default_value = "frixel-out")]
    out: PathBuf,
    /// Replace also what a finger did on a board that is not a simulator.
    #[arg(long)]
    overwrite: bool,
    /// Print one JSON object in place of the summary.
    #[arg(long)]
    json: bool,
    /// Seed of the simulator's random numbers.
    #[arg(long, default_value_t = 1, value_parser = argument::seed, allow_negative_numbers = true)]
    seed: u64,
    #[command(flatten)]
    touch: TouchArgs,
    /// Simulate a world without load changes, noise, pre-sliding, leakage, offsets, and lost touch reports. Without it,
    /// all of them are simulated.
    #[arg(long)]
    ideal: bool,
    /// Simulate skin through which no charge leaks. Measurements disagree whether it does (docs/truth.md); without
    /// this, it leaks below 250 Hz.
    #[arg(long, conflicts_with = "ideal")]
    no_leakage: bool,
    /// Simulated person, whose finger the board does not know: another one for each seed. Without it, the finger is the
    /// scene's.
    #[arg(long, value_name = "N", value_parser = argument::seed, allow_negative_numbers = true)]
    finger_seed: Option<u64>,
    /// Record into this Parquet file as well: the rows of felt.csv in full precision, what made them, and what happened
    /// when (docs/outputs.md). `frixel replay` plays a simulated one again.
    #[arg(long, value_name = "FILE.parquet")]
    record: Option<PathBuf>,
    /// Code of the participant, for the file of --record: letters, digits, `-`, `_` and `.`, not a name.
    #[arg(long, value_name = "CODE", value_parser = argument::participant, requires = "record")]
    participant: Option<String>,
    /// Rows a second in felt.csv and in the file of --record; at most 1000 on a board.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u32).range(1..=40_000))]
    csv_hz: u32,
    /// Let a board that is not a simulator drive its electrode.
    #[arg(long)]
    arm: bool,
    /// Play the scene anew whenever its file is saved; for a board at a serial port, `frixel sim` among them. Not with
    /// --stream.
    #[arg(long)]
    watch: bool,
    /// Change the scene while it plays, by lines on standard input: `layer "OK" off`, `layer 3 gain 0.5`,
    /// `trigger "click"`, `replace FILE`, `wait SECONDS`, `quit`. On the simulator, time stands still until the next
    /// line comes, or the input ends.
    #[arg(long)]
    control: bool,
    /// Join what the finger of a virtual board felt: the felt.csv that its `frixel sim` writes, on this machine. With
    /// it, a play to the port of that board writes felt.svg, and `felt_n` into felt.csv.
    #[arg(long, value_name = "FILE.csv")]
    with_log: Option<PathBuf>,
    #[command(flatten)]
    stream: StreamArgs,
}

impl PlayArgs {
    /// The options of a play on the simulator in an ideal world, into a folder, without any other option.
    pub(super) fn ideal(scene: &Path, out: &Path) -> Self {
        Self {
            scene: scene.to_owned(),
            profiles: ProfileArgs::default(),
            port: "sim".into(),
            stroke: StrokeArgs::default(),
            seconds: None,
            out: out.to_owned(),
            overwrite: false,
            json: false,
            seed: 1,
            touch: TouchArgs::default(),
            ideal: true,
            no_leakage: false,
            finger_seed: None,
            record: None,
            participant: None,
            csv_hz: 1000,
            arm: false,
            watch: false,
            with_log: None,
            control: false,
            stream: StreamArgs::default(),
        }
    }

    /// The options as a recording has them, but for the names of finger and screen.
    fn options(&self, stream_s: Option<f64>) -> PlayOptions {
        let touch = self.touch.bundled_name().or(self.touch.file().map(|_| PlayOptions::FILE));
        PlayOptions {
            seconds: self.seconds,
            seed: self.seed,
            ideal: self.ideal,
            no_leakage: self.no_leakage,
            finger_seed: self.finger_seed,
            rows_hz: self.csv_hz,
            finger: None,
            screen: None,
            touch: touch.map(str::to_owned),
            stroke: self.stroke.options(),
            control: self.control,
            stream: self.stream.is_given(),
            lines: None,
            stream_s,
            interrupted: false,
        }
    }

    /// The effects that the simulated world has beside the contact model.
    fn effects(&self) -> Effects {
        match (self.ideal, self.no_leakage) {
            (true, _) => Effects::None,
            (false, true) => Effects::AllButLeakage,
            (false, false) => Effects::All,
        }
    }
}

/// Results of a play.
struct Played {
    report: Report,
    files: Vec<PathBuf>,
    /// The failure that ended the play early, if any. The report and the files have what was played until then.
    failure: Option<anyhow::Error>,
}

pub(super) fn run(args: &PlayArgs) -> Result<()> {
    let target = Target::of(&args.port);
    plan::check_options(args, target)?;
    let interrupt = Interrupt::watch()?;
    if args.watch && target == Target::Simulator {
        return watch::play_on_simulator(args, &interrupt);
    }
    let (scene, files) = args.profiles.names().load_with_files(&args.scene);
    let outputs = PlayFiles::new(args, target, &files)?;
    let scene = scene?;
    let live_scene = (args.watch || args.control).then(|| LiveScene::new(args, target, files, outputs.clone()));
    let played = match target {
        Target::Simulator => rigs::play_on_simulator(args, &scene, (outputs, live_scene), &interrupt),
        Target::Emulator => rigs::play_on_emulator(args, &scene, (outputs, live_scene), &interrupt),
        Target::Pico => rigs::play_on_pico(args, &scene, (outputs, live_scene), &interrupt),
        Target::Port => rigs::play_on_port(args, &scene, (outputs, live_scene), &interrupt),
    }?;
    finish(args, played)
}

/// Prints the results of a play, and returns its failure.
fn finish(args: &PlayArgs, played: Played) -> Result<()> {
    print(args, &played)?;
    played.failure.map_or(Ok(()), Err)
}

fn print(args: &PlayArgs, Played { report, files, .. }: &Played) -> Result<()> {
    if args.record.as_deref() == Some(Path::new("-")) {
        note(report.summary());
        return Ok(());
    }
    if args.json {
        return print_line(report.to_json());
    }
    terminal::print(report.summary())?;
    files.iter().try_for_each(|file| print_line(format_args!("  {:<16} {}", "wrote", file.display())))
}
