//! `frixel scene check`: prints the cost of a scene and the friction that can be felt of it.

use std::path::PathBuf;

use clap::Args;
use frixel_felt::check::SceneCheck;
use frixel_hil_sim::{RigConfig, TouchConfig};
use frixel_lab::simulation::board_costs;
use frixel_scene::{compile, printable};

use super::super::error::CommandError;
use super::super::profiles::{ProfileArgs, TouchArgs};
use super::super::terminal::{print, print_line};

#[derive(Debug, Args)]
pub(in super::super) struct CheckArgs {
    /// The scene, a TOML file (docs/scene.md).
    scene: PathBuf,
    #[command(flatten)]
    profiles: ProfileArgs,
    #[command(flatten)]
    touch: TouchArgs,
    /// Also report the smallest firmware build that plays it.
    #[arg(long)]
    board: bool,
    /// Print one JSON object in place of the summary; of a scene with mistakes, all of them.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &CheckArgs) -> Result<(), CommandError> {
    // The simulated board has the limits of the smallest board.
    let rig = RigConfig::default();
    let touch = args.touch.source(false)?.unwrap_or(TouchConfig::REALISTIC);
    let (scene, files) = args.profiles.names().load_with_files(&args.scene);
    let compiled = scene.and_then(|scene| Ok(compile(&scene, &rig.board.limits, rig.board.tick_hz)?));
    let program = match compiled {
        Err(error) if args.json => {
            print_line(error.to_json())?;
            return Err(error.into());
        }
        compiled => compiled?,
    };
    let mut check = SceneCheck::of(&program, &rig.board.limits, &board_costs(&program, &rig)?, &touch);
    check.notes.extend(files.outside().map(|path| {
        let path = printable(&path.display().to_string()).into_owned();
        format!("{path} is outside of the scene's folder: give it along with the scene")
    }));
    let check = if args.board { check.with_board(&program) } else { check };
    if args.json { print_line(check.to_json()) } else { print(check.summary()) }
}
