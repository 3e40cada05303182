//! The files that a scene is read from.

use std::collections::BTreeMap;
use std::iter::once;
use std::path::Path;

use super::saved_file::SavedFile;

/// The files of a scene, each with its state just before it was read: the scene's own file, and the files that it
/// names, whether they could be read or not.
#[derive(Clone)]
pub(crate) struct SceneFiles {
    scene: SavedFile,
    named: Vec<SavedFile>,
    /// The bytes of the scene's own file.
    scene_bytes: Vec<u8>,
    /// The bytes of the others, by the names that the scene gives them.
    named_bytes: BTreeMap<String, Vec<u8>>,
}

impl SceneFiles {
    /// Starts with the scene's own file. Call this before the file is read.
    pub(super) fn new(scene: &Path) -> Self {
        Self { scene: SavedFile::new(scene), named: Vec::new(), scene_bytes: Vec::new(), named_bytes: BTreeMap::new() }
    }

    /// Adds a file that the scene names. Call this before the file is read.
    pub(super) fn add(&mut self, named: &Path) {
        self.named.push(SavedFile::new(named));
    }

    /// Keeps the bytes of the scene's own file.
    pub(super) fn keep_scene(&mut self, bytes: &[u8]) {
        self.scene_bytes = bytes.to_vec();
    }

    /// Keeps the bytes of a file that the scene calls `name`.
    pub(super) fn keep_named(&mut self, name: &str, bytes: &[u8]) {
        self.named_bytes.insert(name.to_owned(), bytes.to_vec());
    }

    /// The text of the scene's own file, as it was read; empty if it was not read.
    pub(crate) fn scene_text(&self) -> String {
        String::from_utf8_lossy(&self.scene_bytes).into_owned()
    }

    /// The files that the scene names, as they were read, by the names that it gives them.
    pub(crate) fn named_bytes(&self) -> &BTreeMap<String, Vec<u8>> {
        &self.named_bytes
    }

    /// The path of the scene's own file.
    pub(crate) fn path(&self) -> &Path {
        self.scene.path()
    }

    /// Checks the files now. Call this once every [`CHECK_PERIOD`](super::CHECK_PERIOD).
    ///
    /// Returns whether a file was saved after it was read; false while a file is being written.
    pub(crate) fn is_saved(&mut self) -> bool {
        once(&mut self.scene).chain(&mut self.named).any(SavedFile::is_saved)
    }

    /// Whether the scene's own file has vanished, reported once. Only [`Self::is_saved`] checks for it.
    pub(crate) fn has_vanished(&mut self) -> bool {
        self.scene.has_vanished()
    }

    /// The paths of named files that are outside of the scene's folder, directly or by links.
    pub(crate) fn outside(&self) -> impl Iterator<Item = &Path> {
        let folder = match self.path().parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let folder = folder.canonicalize().ok();
        let is_inside = move |path: &Path| {
            folder.as_ref().zip(path.canonicalize().ok()).is_none_or(|(folder, path)| path.starts_with(folder))
        };
        self.named.iter().map(SavedFile::path).filter(move |path| !is_inside(path))
    }

    /// The paths of the files.
    pub(crate) fn paths(&self) -> impl Iterator<Item = &Path> {
        once(&self.scene).chain(&self.named).map(SavedFile::path)
    }
}
