//! `frixel play`: plays a scene on a board, real or simulated.
//!
//! `Plan` is the checked input of a play, `rigs` opens the board that `--port` names, `follow` plays and records,
//! and `Outputs` writes the files. This module prints the results.

mod control;
mod follow;
mod live_scene;
mod outputs;
mod plan;
mod progress;
mod record_file;
pub(super) mod replay;
mod rigs;
mod stream_args;
mod watch;
mod with_log;

use frixel_hil_sim::Board;
use frixel_lab::simulate::{PlayOptions, PlayOptionsError};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};
use clap::{Args, Command, FromArgMatches, ValueEnum};

use crate::output::{Effects, Report};

use super::argument::RARE;
use super::demo::FOLDER;
use super::interrupt::Interrupt;
use super::profiles::{ProfileArgs, TouchArgs};
use super::stroke::{StrokeArgs, of_stroke_options};
use super::target::Target;
use super::terminal::{self, note, note_refusals, print_line};
use super::{argument, waiting};
use live_scene::LiveScene;
use outputs::PlayFiles;
use stream_args::StreamArgs;

#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools, reason = "each is an option of its own")]
pub(super) struct PlayArgs {
    /// The scene, a TOML file (docs/design/scenes.md).
    scene: PathBuf,
    #[command(flatten)]
    profiles: ProfileArgs,
    /// `sim`, an emulated `qemu` or `pico`, or the path of a board's serial port.
    #[arg(long, default_value = "sim")]
    port: String,
    #[command(flatten)]
    stroke: StrokeArgs,
    /// Duration. Default: that of --stream or the stroke; on a board, until Ctrl-C.
    #[arg(long, value_name = "S", value_parser = argument::seconds, allow_negative_numbers = true)]
    seconds: Option<f64>,
    /// Output folder. Replaces an earlier play there.
    #[arg(long, default_value = FOLDER)]
    out: PathBuf,
    /// Also replace a play on a real board.
    #[arg(long)]
    overwrite: bool,
    /// Also print the world, every error, and the ticks and bytes.
    #[arg(long)]
    verbose: bool,
    /// Print one JSON object in place of the summary.
    #[arg(long)]
    json: bool,
    /// Seed of the simulator's random numbers.
    #[arg(long, default_value_t = 1, value_parser = argument::seed, allow_negative_numbers = true)]
    seed: u64,
    #[command(flatten)]
    touch: TouchArgs,
    /// Leave out load changes, noise, pre-sliding, leakage, offsets and lost touch reports.
    #[arg(long)]
    ideal: bool,
    /// Simulated skin: `no-leakage`; `mean-square`, whose friction follows the rms voltage.
    #[arg(long, value_name = "KIND", value_enum, value_delimiter = ',', hide_possible_values = true, help_heading = RARE)]
    skin: Vec<Skin>,
    /// Seed of a simulated person, other than the finger of the scene.
    #[arg(long, value_name = "N", value_parser = argument::seed, allow_negative_numbers = true, help_heading = RARE)]
    finger_seed: Option<u64>,
    /// Also record the play and its inputs, for `frixel replay` (docs/design/outputs.md).
    #[arg(long, value_name = "FILE.parquet")]
    record: Option<PathBuf>,
    /// Participant's code in the file of --record, not a name: letters, digits, `-_.`.
    #[arg(long, value_name = "CODE", value_parser = argument::participant, requires = "record", help_heading = RARE)]
    participant: Option<String>,
    /// Rows a second of felt.csv and --record; at most 1000 on a board.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1000,
        value_parser = argument::whole(1..=Board::SIMULATOR.tick_hz),
        help_heading = RARE
    )]
    csv_hz: u32,
    /// Let a real board drive its electrode.
    #[arg(long, requires = "port")]
    arm: bool,
    /// Play the scene again whenever its file is saved.
    #[arg(long)]
    watch: bool,
    /// Change the scene by lines on standard input, such as `layer 3 off` (docs/design/scenes.md).
    #[arg(long)]
    control: bool,
    /// Add what the finger felt, from the felt.csv that the `frixel sim` at --port writes.
    #[arg(long, value_name = "FILE.csv", help_heading = RARE)]
    with_log: Option<PathBuf>,
    #[command(flatten)]
    stream: StreamArgs,
}

/// Properties of the simulated skin on which sources disagree, or that are unmeasured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Skin {
    /// Charge does not leak through the skin. By default it leaks below 250 Hz.
    NoLeakage,
    /// Friction follows the mean squared voltage of the carrier. By default it follows that of each tick.
    MeanSquare,
}

impl PlayArgs {
    /// The options of a play on the simulator in an ideal world, into a folder.
    pub(super) fn ideal(scene: &Path, out: &Path) -> Result<Self> {
        let mut into = OsString::from("--out=");
        into.push(out);
        let typed = [into.as_os_str(), "--ideal".as_ref(), "--".as_ref(), scene.as_os_str()];
        let command = Self::augment_args(Command::new("play").no_binary_name(true));
        Ok(Self::from_arg_matches(&command.try_get_matches_from(typed)?)?)
    }

    /// The options as a recording stores them, without the names of profiles.
    fn options(&self, stream_s: Option<f64>) -> PlayOptions {
        PlayOptions {
            seconds: self.seconds,
            seed: self.seed,
            ideal: self.ideal,
            no_leakage: self.skin.contains(&Skin::NoLeakage),
            mean_square: self.skin.contains(&Skin::MeanSquare),
            finger_seed: self.finger_seed,
            rows_hz: self.csv_hz,
            finger: None,
            screen: None,
            touch: None,
            stroke: self.stroke.options(),
            control: self.control,
            stream: self.stream.is_given(),
            lines: None,
            stream_s,
            interrupted: false,
        }
    }

    /// Converts an error of the options into a sentence that names the command's arguments.
    fn error(&self, error: PlayOptionsError) -> anyhow::Error {
        match error {
            PlayOptionsError::Stroke(error) => of_stroke_options(error),
            PlayOptionsError::RowRate { .. } => anyhow!("--csv-hz: {error}"),
            PlayOptionsError::OffScreen { .. } => match self.stroke.file() {
                Some(file) => anyhow!("{}: {error}", file.display()),
                None => error.into(),
            },
            error => error.into(),
        }
    }

    /// Whether an option changes the simulated world.
    fn changes_world(&self) -> bool {
        self.ideal || !self.skin.is_empty() || self.finger_seed.is_some() || self.touch.is_given()
    }

    /// Effects of the simulated world beyond the contact model.
    fn effects(&self) -> Effects {
        Effects {
            is_ideal: self.ideal,
            has_leakage: !self.skin.contains(&Skin::NoLeakage),
            follows_mean_square: self.skin.contains(&Skin::MeanSquare),
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
    if args.watch && target == Target::Sim {
        return watch::play_on_simulator(args, &interrupt);
    }
    let (scene, files) = args.profiles.names().load_with_files(&args.scene);
    let outputs = PlayFiles::new(args, target, &files)?;
    let scene = scene?;
    let live_scene = (args.watch || args.control).then(|| LiveScene::new(args, target, files, outputs.clone()));
    let played = match target {
        Target::Port => rigs::play_on_port(args, &scene, (outputs, live_scene), &interrupt),
        rig => rigs::play_on_rig(args, &scene, rig, (outputs, live_scene), &interrupt),
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
        note(report.summary(args.verbose));
        return Ok(());
    }
    if args.json {
        return print_line(report.to_json());
    }
    files.iter().try_for_each(|file| print_line(format_args!("  {:<16} {}", "wrote", file.display())))?;
    terminal::print(report.summary(args.verbose))
}
