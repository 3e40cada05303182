//! Loading of scene files and of the files that they name.

mod files;
mod saved_file;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use frixel_lab::input::{SceneFolder, check_path};
use frixel_scene::{
    CompileError, FileUnavailable, Files, FingerProfile, NamedProfile, Nearest, Profile, Program, Scene, Screen,
    TILDE_ADVICE, compile,
};
use frixel_wire::hello::BoardLimits;
use thiserror::Error;

use crate::input;

pub(crate) use files::SceneFiles;
pub(crate) use saved_file::CHECK_PERIOD;

/// A scene without friction of its own.
const NO_SCENE: &str = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.0\n";

/// Why a scene file could not be loaded.
#[derive(Debug, Error)]
pub enum SceneFileError {
    /// The scene file itself could not be read.
    #[error("{file} cannot be read ({source}): {}", scene_advice(file))]
    Unreadable {
        /// Path of the scene file, as the caller gave it.
        file: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file of a finger, a screen or a touch source could not be read.
    #[error("{file} cannot be read ({source}): {}", profile_advice(what, .nearest, .file))]
    UnreadableProfile {
        /// `finger`, `screen` or `touch source`.
        what: &'static str,
        /// The name, as the caller gave it.
        file: String,
        /// The names of the bundled ones, and the nearest one.
        nearest: Nearest,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file was read, but its content is invalid.
    #[error(transparent)]
    Compile(#[from] CompileError),
}

impl SceneFileError {
    /// The error as JSON, in the form of [`CompileError::to_json`]. The field `unreadable` has the reason for which the
    /// file could not be read.
    pub fn to_json(&self) -> String {
        let (file, reason) = match self {
            Self::Unreadable { file, source } | Self::UnreadableProfile { file, source, .. } => {
                (file, source.to_string())
            }
            Self::Compile(error) => return error.to_json(),
        };
        serde_json::json!({ "file": file, "unreadable": reason, "mistakes": [], "has_more": false }).to_string()
    }
}

/// Advice for a scene file that cannot be read: the file of that name in the gallery, if it is there.
fn scene_advice(file: &str) -> String {
    let names = [format!("{file}.toml"), format!("scenes/{file}"), format!("scenes/{file}.toml")];
    match names.into_iter().find(|name| Path::new(name).is_file()) {
        Some(name) => format!("did you mean {name}?"),
        None => check_path(Path::new(file), "check the path").to_owned(),
    }
}

/// Advice for a profile that cannot be read: the nearest name, or how to give one.
fn profile_advice(what: &str, nearest: &Nearest, file: &str) -> String {
    match &nearest.suggestion {
        Some(bundled) => format!("did you mean `{bundled}`?"),
        None if file.starts_with('~') => TILDE_ADVICE.to_owned(),
        None => format!("give the file of a {what}, or a bundled one: {}", nearest.known.join(", ")),
    }
}

/// Reads a scene file. The names of files in it are paths relative to its folder.
pub fn load(path: &Path) -> Result<Scene, SceneFileError> {
    load_with_files(path).0
}

/// Reads a scene file. Also returns the files that it was read from.
pub(crate) fn load_with_files(path: &Path) -> (Result<Scene, SceneFileError>, SceneFiles) {
    let file = path.display().to_string();
    let mut files = SceneFiles::new(path);
    match input::read_toml(path) {
        Ok(bytes) => {
            files.keep_scene(&bytes);
            let named = NamedFiles { folder: SceneFolder::of(path), files: RefCell::new(files) };
            let scene = Scene::parse(&bytes, &file, &named).map_err(SceneFileError::from);
            (scene, named.files.into_inner())
        }
        Err(source) => (Err(SceneFileError::Unreadable { file, source }), files),
    }
}

/// Notes each file that a scene names before it is read.
struct NamedFiles {
    folder: SceneFolder,
    files: RefCell<SceneFiles>,
}

impl Files for NamedFiles {
    fn bytes(&self, name: &str) -> Result<Vec<u8>, FileUnavailable> {
        self.files.borrow_mut().add(&self.folder.0.join(name));
        let bytes = self.folder.bytes(name)?;
        self.files.borrow_mut().keep_named(name, &bytes);
        Ok(bytes)
    }
}

/// A finger and a screen in place of a scene's own, each by the name of a file or of a bundled profile.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct ProfileNames {
    /// The finger.
    pub finger: Option<String>,
    /// The screen.
    pub screen: Option<String>,
}

impl ProfileNames {
    /// Reads a scene file like [`load_with_files`], with this finger and screen. Also returns their files.
    pub(crate) fn load_with_files(&self, path: &Path) -> (Result<Scene, SceneFileError>, SceneFiles) {
        let (scene, mut files) = load_with_files(path);
        let (finger, screen) =
            (file_of::<FingerProfile>(self.finger.as_ref()), file_of::<Screen>(self.screen.as_ref()));
        finger.into_iter().chain(screen).for_each(|file| files.add(file));
        (scene.and_then(|scene| self.applied_to(scene)), files)
    }

    /// A scene with this finger and screen.
    pub(crate) fn applied_to(&self, mut scene: Scene) -> Result<Scene, SceneFileError> {
        if let Some(name) = &self.screen {
            scene = scene.with_screen(profile(name)?, name);
        }
        if let Some(name) = &self.finger {
            scene = scene.with_finger(profile(name)?, name);
        }
        Ok(scene)
    }

    /// An empty scene for this finger and screen, compiled with the default limits of the drive. It states the largest
    /// friction and the contact on a board.
    pub(crate) fn without_scene(&self, limits: &BoardLimits, tick_hz: u32) -> Result<Program, SceneFileError> {
        let scene = Scene::parse(NO_SCENE, "an empty scene", &BTreeMap::new())?;
        Ok(compile(&self.applied_to(scene)?, limits, tick_hz)?)
    }
}

/// The file of a profile, if it is read from one.
pub(crate) fn file_of<P: Profile>(name: Option<&String>) -> Option<&Path> {
    name.filter(|name| P::bundled(name).is_none()).map(Path::new)
}

/// The bundled profile of a name, or the profile in the file of that name.
pub(crate) fn profile<P: Profile>(name: &str) -> Result<P, SceneFileError> {
    P::bundled(name).map_or_else(|| Ok(P::parse(text_of::<P>(name)?, name)?), Ok)
}

/// The name of a bundled profile, or the text of the file of that name.
pub(crate) fn named<P: Profile>(name: &str) -> Result<NamedProfile, SceneFileError> {
    let text = P::bundled(name).map_or_else(|| text_of::<P>(name).map(Some), |_| Ok(None))?;
    Ok(NamedProfile { name: name.to_owned(), text })
}

/// The text of the file of a profile.
fn text_of<P: Profile>(name: &str) -> Result<String, SceneFileError> {
    let unreadable = |source| SceneFileError::UnreadableProfile {
        what: P::KIND.word(),
        file: name.to_owned(),
        nearest: Nearest::new(name, P::bundled_names()),
        source,
    };
    let bytes = input::read_toml(Path::new(name)).map_err(unreadable)?;
    Ok(P::KIND.text(&bytes, name)?.to_owned())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use frixel_model::{Contact, Finger};
    use frixel_scene::Elasticity;

    use super::*;

    /// Before a scene plays, the simulator has the bundled finger on the bundled screen.
    #[test]
    fn the_simulator_has_the_example_finger() {
        let (finger, screen) = (FingerProfile::example(), Screen::example());
        let Elasticity::WinklerFuss { stiffness_pa_per_m } = finger.elasticity else { panic!("{finger:?}") };
        let on_springs = Finger {
            radius_m: 1e-3 * finger.radius_mm,
            stiffness_pa_per_m,
            friction_coefficient: finger.friction_coefficient,
        };
        let gap_m = 1e-6 * (screen.coating_gap_um() + finger.skin_gap_um);
        let contact = Contact::new(&on_springs, gap_m).unwrap().under_load(finger.normal_load_n).unwrap();
        assert_eq!(frixel_hil_sim::example_finger(), Ok(contact));
    }

    #[test]
    fn a_file_that_is_saved_right_after_it_is_read_counts_as_saved() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in ["scene.toml", "one.png", "other.png"] {
            fs::write(path(name), b"bytes").unwrap();
        }
        for saved in ["scene.toml", "one.png", "other.png"] {
            let files = RefCell::new(SceneFiles::new(&path("scene.toml")));
            let named = NamedFiles { folder: SceneFolder::of(&path("scene.toml")), files };
            named.bytes("one.png").unwrap();
            named.bytes("other.png").unwrap();
            // As while the rest of the scene is read, or compiled.
            fs::write(path(saved), saved.repeat(2)).unwrap();
            let mut files = named.files.into_inner();
            assert!(files.is_saved() || files.is_saved(), "{saved}");
        }
        let mut files = load_with_files(&path("scene.toml")).1;
        assert!(!files.is_saved() && !files.is_saved());
    }
}
