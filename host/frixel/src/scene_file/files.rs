//! The files that a scene is read from.

use std::iter::once;
use std::path::Path;

use super::saved_file::SavedFile;

/// The files that a scene was read from, each as it was just before it was read: the scene's own file, and those that
/// it names, whether they could be read or not.
pub(crate) struct SceneFiles {
    scene: SavedFile,
    named: Vec<SavedFile>,
}

impl SceneFiles {
    /// The scene's own file. Call this before the file is read.
    pub(super) fn new(scene: &Path) -> Self {
        Self { scene: SavedFile::new(scene), named: Vec::new() }
    }

    /// Adds a file that the scene names. Call this before the file is read.
    pub(super) fn add(&mut self, named: &Path) {
        self.named.push(SavedFile::new(named));
    }

    /// The path of the scene's own file.
    pub(crate) fn path(&self) -> &Path {
        self.scene.path()
    }

    /// Whether any of the files was saved after it was read. Returns false between two checks, a tenth of a second
    /// apart, and while a file is being written.
    pub(crate) fn is_saved(&mut self) -> bool {
        once(&mut self.scene).chain(&mut self.named).any(SavedFile::is_saved)
    }

    /// Whether the scene's own file is gone, once after it was there. Only [`Self::is_saved`] checks for it.
    pub(crate) fn has_vanished(&mut self) -> bool {
        self.scene.has_vanished()
    }

    /// The files that the scene names outside of its own folder, also by links, as it names them from there.
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
