//! A scene that is replaced whenever one of its files is saved, or by another scene.

use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use crate::rigs::RecordedLink;
use crate::scene_file::{CHECK_PERIOD, ProfileNames, SceneFiles};
use anyhow::Result;
use frixel_play::{PlayError, Player, Replaced};
use frixel_scene::Program;
use frixel_wire::hello::BoardLimits;

use super::Target;
use super::outputs::PlayFiles;
use super::plan::print_notes;
use super::{PlayArgs, note, note_refusals};

/// Loads and compiles scenes while one plays.
pub(super) struct LiveScene {
    loader: Loader,
    /// The files of the last version of the scene that plays, playable or not.
    files: SceneFiles,
    /// Whether saved files are played.
    watches: bool,
    /// Time of the next check of the files, on the clock of the board's link.
    check_at: Duration,
    /// The scene that comes next. Files are not checked until it is compiled; no change is missed, since the state of
    /// its files was noted before they were read.
    next: Option<NextScene>,
}

/// A scene that is being compiled in a thread, because the host must keep sending to the board meanwhile.
struct NextScene {
    origin: Origin,
    compiling: JoinHandle<Compiled>,
}

/// Why a scene is compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Origin {
    /// A file of the scene that plays was saved.
    Saved,
    /// `replace` names another scene.
    Other,
}

/// Outcome of putting a scene on the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ReplaceOutcome {
    Plays,
    /// The board refused it, and the previous scene keeps playing.
    Refused,
}

/// A compiled scene, and the files that it was read from.
struct Compiled {
    program: Result<Program>,
    files: SceneFiles,
}

/// How scenes are loaded and compiled.
#[derive(Clone)]
struct Loader {
    profiles: ProfileNames,
    target: Target,
    /// The files that the play writes.
    outputs: PlayFiles,
}

impl Loader {
    fn compile(&self, path: &Path, limits: &BoardLimits, tick_hz: u32) -> Compiled {
        let (scene, files) = self.profiles.load_with_files(path);
        let checked = self.outputs.check(&files);
        let program =
            checked.and_then(|()| Ok(scene?)).and_then(|scene| Ok(self.target.compile(&scene, limits, tick_hz)?));
        Compiled { program, files }
    }
}

impl LiveScene {
    /// Creates it for a play of `args`. `files` are those of the first scene.
    pub(super) fn new(args: &PlayArgs, target: Target, files: SceneFiles, outputs: PlayFiles) -> Self {
        let loader = Loader { profiles: args.profiles.names(), target, outputs };
        Self { loader, files, watches: args.watch, check_at: Duration::ZERO, next: None }
    }

    /// Plays another scene next, and watches its files once it plays.
    pub(super) fn load<L: RecordedLink>(&mut self, path: &Path, player: &Player<L>) {
        self.compile(path.to_owned(), Origin::Other, player);
    }

    /// Plays the next scene once it is compiled. Without a next scene, compiles the current one again if one of its
    /// files was saved. Returns the files of a scene that was put on the board, and the outcome.
    pub(super) fn refresh<L: RecordedLink>(
        &mut self,
        player: &mut Player<L>,
    ) -> Result<Option<(SceneFiles, ReplaceOutcome)>, PlayError> {
        // In virtual time, the play waits for the compiler.
        let waits = self.loader.target == Target::Sim;
        if let Some(next) = self.next.take_if(|next| waits || next.compiling.is_finished()) {
            let compiled = next.compiling.join().unwrap_or_else(|panic| resume_unwind(panic));
            return self.play(next.origin, compiled, player);
        }
        let now = player.device().now();
        if self.watches && self.next.is_none() && now >= self.check_at {
            self.check_at = now + CHECK_PERIOD;
            self.check_files(player);
        }
        Ok(None)
    }

    /// Plays a compiled scene. Watches the files of another scene only if it plays.
    fn play<L: RecordedLink>(
        &mut self,
        origin: Origin,
        Compiled { program, files }: Compiled,
        player: &mut Player<L>,
    ) -> Result<Option<(SceneFiles, ReplaceOutcome)>, PlayError> {
        let how = if origin == Origin::Saved { " as it was saved" } else { "" };
        let outcome = replace(files.path(), how, program, player)?;
        if origin == Origin::Saved || outcome == Some(ReplaceOutcome::Plays) {
            self.files = files.clone();
        }
        Ok(outcome.map(|outcome| (files, outcome)))
    }

    fn check_files<L: RecordedLink>(&mut self, player: &Player<L>) {
        let is_saved = self.files.is_saved();
        if self.files.has_vanished() {
            let path = self.files.path().display();
            note(format_args!(
                "frixel: {path} is gone: the previous scene keeps playing until the file is there again"
            ));
        }
        if is_saved {
            self.compile(self.files.path().to_owned(), Origin::Saved, player);
        }
    }

    fn compile<L: RecordedLink>(&mut self, path: PathBuf, origin: Origin, player: &Player<L>) {
        let (limits, tick_hz) = self.loader.target.limits(player.device().hello());
        let loader = self.loader.clone();
        let compiling = thread::spawn(move || loader.compile(&path, &limits, tick_hz));
        self.next = Some(NextScene { origin, compiling });
    }
}

/// Plays a compiled scene, and prints its file and `how` it plays. If it has errors or the board refuses it, prints
/// why, and keeps the previous scene playing. Returns the outcome on the board; `None` if the scene was not put there.
fn replace<L: RecordedLink>(
    path: &Path,
    how: &str,
    compiled: Result<Program>,
    player: &mut Player<L>,
) -> Result<Option<ReplaceOutcome>, PlayError> {
    let program = match compiled {
        Ok(program) => program,
        Err(error) => {
            note(error);
            note(format_args!("frixel: {} is not played: the previous scene keeps playing", path.display()));
            return Ok(None);
        }
    };
    let (meanwhile, dropped_gains) = match player.replace(program) {
        Ok(Replaced { faded_out: false, dropped_gains }) => ("", dropped_gains),
        Ok(Replaced { faded_out: true, dropped_gains }) => (
            "; its pictures and the previous scene's do not fit on the board together: the output faded out meanwhile",
            dropped_gains,
        ),
        Err(refused) if refused.is_refusal() => {
            note(format_args!("frixel: {refused}: the previous scene keeps playing"));
            let was_put = !matches!(refused, PlayError::Unmeasured { .. });
            return Ok(was_put.then_some(ReplaceOutcome::Refused));
        }
        Err(error) => return Err(error),
    };
    if let Some(playing) = player.playing() {
        note_refusals(path, playing.program());
        print_notes(playing.program());
    }
    note(format_args!("frixel: {} plays{how}{meanwhile}", path.display()));
    if let Some(clamped) = dropped_gains {
        note(format_args!("frixel: its gains are reset to the file's: with the gains that were set, {clamped}"));
    }
    Ok(Some(ReplaceOutcome::Plays))
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::sync::mpsc::{Sender, channel};

    use frixel_driver::ignore_progress;
    use frixel_felt::recorder::Recorder;
    use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};
    use frixel_play::{SimPlayer, connect};
    use frixel_scene::{TargetRange, compile};
    use tempfile::TempDir;

    use super::*;

    /// A scene with a part of its own: the same friction everywhere.
    const SCENE: &str = "version = 1\ninclude = [\"part.toml\"]\n";

    fn part(friction_n: f64) -> String {
        format!("version = 1\n[[layer]]\nkind = \"constant\"\nfriction_n = {friction_n}\n")
    }

    /// A simulated board that plays `scene.toml`, watched as at a port: the play does not wait for the compiler.
    struct Watched<'a> {
        folder: TempDir,
        player: SimPlayer<'a>,
        live: LiveScene,
    }

    impl<'a> Watched<'a> {
        fn new(memory: &'a mut BoardMemory) -> Self {
            let folder = TempDir::new().unwrap();
            let path = folder.path().join("scene.toml");
            fs::write(&path, SCENE).unwrap();
            fs::write(folder.path().join("part.toml"), part(0.25)).unwrap();
            let args = PlayArgs { watch: true, ..PlayArgs::ideal(&path, "out".as_ref()).unwrap() };
            let (scene, files) = args.profiles.names().load_with_files(&path);
            let config = RigConfig::default();
            let (limits, tick_hz) = (config.board.limits, config.board.tick_hz);
            let program = compile(&scene.unwrap(), &limits, tick_hz).unwrap();
            let rig = Rig::new(memory, &config, Stroke::sweep(0.12, 0.08, 1.0).unwrap(), 1).unwrap();
            let recorder = Recorder::new(&program, &limits, tick_hz, u64::MAX, 40).unwrap();
            let device = connect(Box::new(rig)).unwrap();
            let mut player = Player::recording(device, recorder);
            player.start(program, 0, &mut ignore_progress).unwrap();
            let outputs = PlayFiles::new(&args, Target::Port, &files).unwrap();
            Self { folder, player, live: LiveScene::new(&args, Target::Port, files, outputs) }
        }

        fn write(&self, name: &str, text: &str) {
            fs::write(self.folder.path().join(name), text).unwrap();
        }

        /// Compiles the scene as it is now; the compiler ends when the returned sender sends.
        fn compile_until_sent(&mut self) -> Sender<()> {
            let (loader, path) = (self.live.loader.clone(), self.live.files.path().to_owned());
            let (limits, tick_hz) = loader.target.limits(self.player.device().hello());
            let (sender, receiver) = channel();
            let (loaded, is_loaded) = channel();
            let compiling = thread::spawn(move || {
                let compiled = loader.compile(&path, &limits, tick_hz);
                loaded.send(()).unwrap();
                receiver.recv().unwrap();
                compiled
            });
            is_loaded.recv().unwrap();
            self.live.next = Some(NextScene { origin: Origin::Saved, compiling });
            sender
        }

        fn refresh(&mut self) {
            self.live.refresh(&mut self.player).unwrap();
            self.player.step(Duration::from_millis(1)).unwrap();
        }

        /// Waits for the compiler, then refreshes.
        fn refresh_compiled(&mut self) {
            while self.live.next.as_ref().is_some_and(|next| !next.compiling.is_finished()) {
                thread::yield_now();
            }
            self.refresh();
        }

        /// Refreshes for a second at most, until a scene with this friction plays.
        fn until_plays(&mut self, friction_n: f64) {
            let plays = |player: &SimPlayer<'_>| TargetRange::of(player.playing().unwrap().program()).most_n;
            for _ in 0..1_000 {
                if (plays(&self.player) - friction_n).abs() < 1e-6 {
                    return;
                }
                self.refresh_compiled();
            }
            panic!("{friction_n} N never plays");
        }
    }

    #[test]
    fn what_is_saved_while_a_scene_compiles_plays_next() {
        let mut memory = BoardMemory::new();
        let mut watched = Watched::new(&mut memory);
        let alone = |friction_n: f64| part(friction_n) + "# no part\n";
        for (name, text, friction_n) in [("part.toml", part(0.255), 0.255), ("scene.toml", alone(0.26), 0.26)] {
            let compiler = watched.compile_until_sent();
            watched.write(name, &text);
            for _ in 0..400 {
                watched.refresh();
            }
            compiler.send(()).unwrap();
            watched.until_plays(friction_n);
        }
    }

    #[test]
    fn another_scene_that_cannot_be_played_leaves_the_first_one_watched() {
        let mut memory = BoardMemory::new();
        let mut watched = Watched::new(&mut memory);
        let nowhere = watched.folder.path().join("nowhere.toml");
        watched.live.load(&nowhere, &watched.player);
        watched.refresh_compiled();
        watched.write("part.toml", &part(0.255));
        watched.until_plays(0.255);

        // `replace` fails while the saved version compiles: the saved version still plays.
        watched.write("part.toml", &part(0.2575));
        while watched.live.next.is_none() {
            watched.refresh();
        }
        watched.live.load(&nowhere, &watched.player);
        watched.until_plays(0.2575);

        watched.write("other.toml", &part(0.26));
        let other = watched.folder.path().join("other.toml");
        watched.live.load(&other, &watched.player);
        watched.until_plays(0.26);
        watched.write("other.toml", &part(0.265));
        watched.until_plays(0.265);
    }
}
