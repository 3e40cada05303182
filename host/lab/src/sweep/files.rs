//! The files that a plan names.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use frixel_scene::{CompileError, FileKind, Scene};
use thiserror::Error;

use super::{Plan, Source, Sweep};
use crate::input::{KeptFiles, SceneFolder, check_path, read_toml};

/// Why a file that a plan names is refused.
#[derive(Debug, Error)]
pub enum PlanFileError {
    /// It cannot be read.
    #[error("{file} cannot be read ({source}): {advice}")]
    Unreadable {
        /// Its path.
        file: String,
        /// Error of the operating system.
        source: io::Error,
        /// Advice.
        advice: &'static str,
    },
    /// It has mistakes.
    #[error(transparent)]
    Mistakes(#[from] CompileError),
}

impl Sweep {
    /// Reads the files of a plan, which it names relative to `folder`. `given` has the texts and the files of scenes
    /// that are not read.
    pub fn in_folder(
        plan: Plan,
        folder: &Path,
        given: &BTreeMap<String, (String, BTreeMap<String, Vec<u8>>)>,
    ) -> Result<Self, PlanFileError> {
        let read = |path: &Path, advice| {
            let unreadable = |source| {
                let (file, advice) = (path.display().to_string(), check_path(path, advice));
                PlanFileError::Unreadable { file, source, advice }
            };
            read_toml(path).map_err(unreadable)
        };
        let scene = |name: &str| {
            if let Some((text, files)) = given.get(name) {
                return Ok(Source::new(name, text.clone(), files.clone()));
            }
            let path = folder.join(name);
            let bytes = read(&path, "check the path")?;
            let files = KeptFiles::new(Some(SceneFolder::of(&path)), BTreeMap::new());
            Scene::parse(&bytes, &path.display().to_string(), &files)?;
            Ok(Source::new(name, String::from_utf8_lossy(&bytes).into_owned(), files.into_kept()))
        };
        let text = |kind: FileKind, name: &str| {
            let advice = "give its file, from the plan's folder, or a bundled one";
            Ok(kind.text(&read(&folder.join(name), advice)?, name)?.to_owned())
        };
        Self::new(plan, scene, text)
    }
}
