//! A scene that is replaced whenever its file is saved.

use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};

use frixel::player::{PlayError, Player};
use frixel::rigs::RecordedLink;
use frixel::scene_file::{self, SceneFileError};
use frixel_driver::DeviceError;
use frixel_scene::{Program, compile};
use frixel_wire::hello::Hello;
use frixel_wire::message::Refusal;

use super::note;
use super::plan::print_notes;
use super::saved_file::SavedFile;

/// Watches the scene's file while an earlier version of it plays.
pub(super) struct LiveScene {
    path: PathBuf,
    file: SavedFile,
    /// The thread that compiles a saved scene, because the host must keep sending to the board meanwhile.
    compiling: Option<JoinHandle<Result<Program, SceneFileError>>>,
}

impl LiveScene {
    /// Watches a file for changes from now on. Call this before the file is read.
    pub(super) fn new(path: &Path) -> Self {
        Self { path: path.to_owned(), file: SavedFile::new(path), compiling: None }
    }

    /// Plays the file if it was saved. Returns the new program if it replaced the one that was playing.
    pub(super) fn refresh<L: RecordedLink>(&mut self, player: &mut Player<L>) -> Result<Option<Program>, PlayError> {
        if let Some(compiling) = self.compiling.take_if(|compiling| compiling.is_finished()) {
            let compiled = compiling.join().unwrap_or_else(|panic| resume_unwind(panic));
            return replace(&self.path, compiled, player);
        }
        if self.compiling.is_none() && self.file.is_saved() {
            let (path, Hello { limits, tick_hz, .. }) = (self.path.clone(), *player.device().hello());
            let compile = move || scene_file::load(&path).and_then(|scene| Ok(compile(&scene, &limits, tick_hz)?));
            self.compiling = Some(thread::spawn(compile));
        }
        Ok(None)
    }
}

/// Plays a compiled scene. If it has errors or the board rejects it, prints why, and keeps the earlier scene playing.
fn replace<L: RecordedLink>(
    path: &Path,
    compiled: Result<Program, SceneFileError>,
    player: &mut Player<L>,
) -> Result<Option<Program>, PlayError> {
    let program = match compiled {
        Ok(program) => program,
        Err(error) => {
            note(error);
            note(format_args!("frixel: {} has mistakes: the scene before plays on", path.display()));
            return Ok(None);
        }
    };
    match player.replace(&program) {
        Ok(()) => {
            print_notes(&program);
            note(format_args!("frixel: {} plays as it was saved", path.display()));
            Ok(Some(program))
        }
        Err(PlayError::Device(DeviceError::Refused { refusal: Refusal::BitmapPoolFull { len, free }, .. })) => {
            note(format_args!(
                "frixel: the pictures of {} and of the scene that plays do not fit on the board together ({len} bytes, \
                 {free} free): the scene before plays on; play the file anew without --watch, or give its pictures a \
                 larger `pitch_mm`",
                path.display()
            ));
            Ok(None)
        }
        Err(PlayError::Device(refused @ DeviceError::Refused { .. })) => {
            note(format_args!("frixel: {refused}: the scene before plays on"));
            Ok(None)
        }
        Err(error) => Err(error),
    }
}
