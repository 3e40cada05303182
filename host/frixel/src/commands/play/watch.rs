//! `--watch` on the simulator: plays from the beginning after each change of the scene.

use anyhow::Result;
use std::thread::sleep;

use crate::scene_file::{CHECK_PERIOD, SceneFiles};

use super::Target;
use super::outputs::PlayFiles;
use super::rigs;
use super::{Interrupt, PlayArgs, finish, note};

/// Plays the scene, and plays it again whenever its file, or a file that it names, was saved, until Ctrl-C.
///
/// A scene that cannot be played the first time is an error. Later, its mistakes are printed, and the output folder
/// keeps the files of the previous play.
pub(super) fn play_on_simulator(args: &PlayArgs, interrupt: &Interrupt) -> Result<()> {
    let (played, mut files) = play(args, interrupt);
    played?;
    let name = args.scene.display();
    note(format_args!("frixel: {name} plays again when it is saved; Ctrl-C ends"));
    while !interrupt.is_requested() {
        sleep(CHECK_PERIOD);
        let is_saved = files.is_saved();
        if files.has_vanished() {
            note(format_args!("frixel: {name} is gone: it plays again when it is back"));
        }
        if is_saved {
            let played;
            (played, files) = play(args, interrupt);
            if let Err(error) = played {
                note(error);
                note(format_args!("frixel: {name} is not played: the files in {} stay", args.out.display()));
            }
        }
    }
    Ok(())
}

/// Loads the scene and plays it. Also returns the files that it was read from.
fn play(args: &PlayArgs, interrupt: &Interrupt) -> (Result<()>, SceneFiles) {
    let (scene, files) = args.profiles.names().load_with_files(&args.scene);
    let played = PlayFiles::new(args, Target::Sim, &files).and_then(|outputs| {
        let played = rigs::play_on_rig(args, &scene?, Target::Sim, (outputs, None), interrupt)?;
        finish(args, played)
    });
    (played, files)
}
