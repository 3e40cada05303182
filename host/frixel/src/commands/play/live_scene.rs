//! A scene that is replaced whenever its file, or a file that it names, is saved.

use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};

use frixel::player::{PlayError, Player};
use frixel::rigs::RecordedLink;
use frixel::scene_file::{ProfileNames, SceneFileError};
use frixel_driver::DeviceError;
use frixel_scene::Program;
use frixel_wire::message::Refusal;

use super::plan::{check_measured, print_notes};
use super::rigs::Target;
use super::saved_file::SavedFile;
use super::{note, note_refusals};

/// Watches the scene's file, and the files that it names, while an earlier version of it plays.
pub(super) struct LiveScene {
    profiles: ProfileNames,
    file: SavedFile,
    named_files: Vec<SavedFile>,
    /// The thread that compiles a saved scene, because the host must keep sending to the board meanwhile.
    compiling: Option<JoinHandle<Compiled>>,
    /// Whether the scene that is being compiled is another one, by `replace`, and not a saved one.
    is_other: bool,
    /// Whether changes of the files are played.
    watches: bool,
    target: Target,
}

/// A compiled scene, and the files that it names, as they were before they were read.
struct Compiled {
    program: Result<Program, SceneFileError>,
    named_files: Vec<SavedFile>,
}

impl LiveScene {
    /// Watches a file, and the files that it names, for changes from now on if `watches` is true. Call this before the
    /// file is read.
    pub(super) fn new(path: &Path, profiles: ProfileNames, watches: bool, target: Target) -> Self {
        let file = SavedFile::new(path);
        let named_files = if watches { profiles.load_with_files(path).1 } else { Vec::new() };
        Self { profiles, file, named_files: watched(&named_files), compiling: None, is_other: false, watches, target }
    }

    /// Plays, and watches, another file from now on.
    pub(super) fn load<L: RecordedLink>(&mut self, path: &Path, player: &Player<L>) {
        self.file = SavedFile::new(path);
        self.is_other = true;
        self.compile(player);
    }

    /// Plays the file if it was saved, or if a file that it names was. Returns the new program if it replaced
    /// `playing`.
    pub(super) fn refresh<L: RecordedLink>(
        &mut self,
        player: &mut Player<L>,
        playing: &Program,
    ) -> Result<Option<Program>, PlayError> {
        // In virtual time, the play waits for the compiler.
        let waits = self.target == Target::Simulator;
        if let Some(compiling) = self.compiling.take_if(|compiling| waits || compiling.is_finished()) {
            let Compiled { program, named_files } = compiling.join().unwrap_or_else(|panic| resume_unwind(panic));
            self.named_files = named_files;
            let how = if std::mem::take(&mut self.is_other) { "" } else { " as it was saved" };
            return replace(self.file.path(), how, program, player, playing);
        }
        if !self.watches {
            return Ok(None);
        }
        if self.file.has_vanished() {
            let path = self.file.path().display();
            note(format_args!(
                "frixel: {path} is gone: the previous scene keeps playing, until the file is there again"
            ));
        }
        // Every file is checked, so that several that are saved together are one change.
        let is_saved = self.named_files.iter_mut().fold(self.file.is_saved(), |saved, file| file.is_saved() || saved);
        if self.compiling.is_none() && is_saved {
            self.compile(player);
        }
        Ok(None)
    }

    fn compile<L: RecordedLink>(&mut self, player: &Player<L>) {
        let (limits, tick_hz) = self.target.limits(player.device().hello());
        let (path, profiles, target) = (self.file.path().to_owned(), self.profiles.clone(), self.target);
        self.compiling = Some(thread::spawn(move || {
            let (scene, named_files) = profiles.load_with_files(&path);
            let program = scene.and_then(|scene| Ok(target.compile(&scene, &limits, tick_hz)?));
            Compiled { program, named_files: watched(&named_files) }
        }));
    }
}

fn watched(paths: &[PathBuf]) -> Vec<SavedFile> {
    paths.iter().map(|path| SavedFile::new(path)).collect()
}

/// Plays a compiled scene, and prints its file and `how` it plays. If it has errors or the board rejects it, prints why,
/// and keeps the earlier scene playing.
fn replace<L: RecordedLink>(
    path: &Path,
    how: &str,
    compiled: Result<Program, SceneFileError>,
    player: &mut Player<L>,
    playing: &Program,
) -> Result<Option<Program>, PlayError> {
    let (file, path) = (path, path.display());
    let program = match compiled {
        Ok(program) => program,
        Err(error) => {
            note(error);
            note(format_args!("frixel: {path} is not played: the previous scene keeps playing"));
            return Ok(None);
        }
    };
    if let Err(error) = check_measured(&program, player.device().hello().board) {
        note(error);
        note(format_args!("frixel: {path} is not played: the previous scene keeps playing"));
        return Ok(None);
    }
    let mut meanwhile = "";
    let replaced = match player.replace(&program) {
        Err(PlayError::Device(DeviceError::Refused { refusal: Refusal::BitmapPoolFull { .. }, .. })) => {
            meanwhile =
                "; its pictures and those before it do not fit on the board together: the output faded out meanwhile";
            replace_alone(&program, player, playing)
        }
        replaced => replaced,
    };
    match replaced {
        Ok(()) => {
            note_refusals(file, &program);
            print_notes(&program);
            note(format_args!("frixel: {path} plays{how}{meanwhile}"));
            Ok(Some(program))
        }
        Err(PlayError::Device(refused @ DeviceError::Refused { .. })) => {
            note(format_args!("frixel: {refused}: the previous scene keeps playing"));
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

/// Replaces `playing` after its pictures were removed from the board. Puts it back if the board refuses the program.
fn replace_alone<L: RecordedLink>(
    program: &Program,
    player: &mut Player<L>,
    playing: &Program,
) -> Result<(), PlayError> {
    let replaced = player.replace_alone(program);
    if let Err(PlayError::Device(DeviceError::Refused { .. })) = replaced {
        player.replace(playing)?;
    }
    replaced
}
