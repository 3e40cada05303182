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
mod rigs;
mod simulated_world;
mod target;
mod watch;
mod with_log;

use std::path::PathBuf;

use crate::output::Report;

use super::PlayArgs;
use super::error::CommandError;
use super::interrupt::Interrupt;
use super::terminal::{self, note, note_refusals, print_line};
use super::waiting;
use live_scene::LiveScene;
use outputs::PlayFiles;
use target::Target;

/// Results of a play.
struct Played {
    report: Report,
    files: Vec<PathBuf>,
    /// The failure that ended the play early, if any. The report and the files have what was played until then.
    failure: Option<CommandError>,
}

pub(super) fn run(args: &PlayArgs) -> Result<(), CommandError> {
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
        Target::Port => rigs::play_on_port(args, &scene, (outputs, live_scene), &interrupt),
    }?;
    finish(args, played)
}

/// Prints the results of a play, and returns its failure.
fn finish(args: &PlayArgs, played: Played) -> Result<(), CommandError> {
    print(args, &played)?;
    played.failure.map_or(Ok(()), Err)
}

fn print(args: &PlayArgs, Played { report, files, .. }: &Played) -> Result<(), CommandError> {
    if args.json {
        return print_line(report.to_json());
    }
    terminal::print(report.summary())?;
    files.iter().try_for_each(|file| print_line(format_args!("  {:<16} {}", "wrote", file.display())))
}
