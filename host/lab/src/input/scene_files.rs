//! The pictures and profiles that a scene names, in a folder.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::{fs, io};

use frixel_scene::{FileUnavailable, Files};

use super::{is_same_name, read_named};

/// The folder that the names of pictures and profiles in a scene are relative to.
#[derive(Clone, Debug)]
pub struct SceneFolder(pub PathBuf);

impl SceneFolder {
    /// The folder of a scene's file.
    pub fn of(scene: &Path) -> Self {
        Self(scene.parent().unwrap_or(Path::new("")).to_owned())
    }
}

impl Files for SceneFolder {
    fn bytes(&self, name: &str) -> Result<Vec<u8>, FileUnavailable> {
        let path = existing(self.0.join(name));
        if path.is_dir() {
            return Err(FileUnavailable::Unreadable { reason: "it is a folder".to_owned() });
        }
        if path.exists() {
            let unreadable = |error: io::Error| FileUnavailable::Unreadable { reason: error.to_string() };
            return read_named(&path).map_err(unreadable);
        }
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let place = if folder == Path::new(".") { "this folder".to_owned() } else { folder.display().to_string() };
        Err(FileUnavailable::Missing { place, files: files_in(folder) })
    }
}

/// The path of an existing file or folder: itself, or a path whose names differ only in the Unicode normal form.
fn existing(path: PathBuf) -> PathBuf {
    let (Some(name), Some(folder), false) = (path.file_name().and_then(OsStr::to_str), path.parent(), path.exists())
    else {
        return path;
    };
    let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { existing(folder.to_owned()) };
    let same = files_in(&folder).into_iter().find(|other| is_same_name(other, name));
    same.map_or(path.clone(), |same| folder.join(same))
}

/// The sorted names of the entries of a folder; empty when the folder cannot be read.
fn files_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<String> = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    names.sort();
    names
}

/// The files that a scene names, with the bytes of each one that was read. A play from these bytes needs no folder.
#[derive(Debug)]
pub struct KeptFiles {
    folder: Option<SceneFolder>,
    kept: RefCell<BTreeMap<String, Vec<u8>>>,
}

impl KeptFiles {
    /// Starts from the files in `kept`; others are read from `folder`.
    pub fn new(folder: Option<SceneFolder>, kept: BTreeMap<String, Vec<u8>>) -> Self {
        Self { folder, kept: RefCell::new(kept) }
    }

    /// All files that were kept, by their names in the scene.
    pub fn into_kept(self) -> BTreeMap<String, Vec<u8>> {
        self.kept.into_inner()
    }
}

impl Files for KeptFiles {
    fn bytes(&self, name: &str) -> Result<Vec<u8>, FileUnavailable> {
        let mut kept = self.kept.borrow_mut();
        if !kept.contains_key(name) {
            let same = kept.iter().find(|(other, _)| is_same_name(other, name)).map(|(_, bytes)| bytes.clone());
            let found = match (same, &self.folder) {
                (None, Some(folder)) => Some(folder.bytes(name)?),
                (same, _) => same,
            };
            kept.extend(found.map(|bytes| (name.to_owned(), bytes)));
        }
        kept.bytes(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_found_by_its_name_in_other_characters() {
        let folder = tempfile::tempdir().unwrap();
        // One character each in the scene, and two in the names of the files.
        let textures = folder.path().join("gru\u{308}n");
        fs::create_dir(&textures).unwrap();
        fs::write(textures.join("cafe\u{301}.png"), b"bytes").unwrap();
        let files = SceneFolder(folder.path().to_owned());
        assert_eq!(files.bytes("gr\u{fc}n/caf\u{e9}.png"), Ok(b"bytes".to_vec()));
        assert!(matches!(files.bytes("gr\u{fc}n/cafe.png"), Err(FileUnavailable::Missing { .. })));
    }

    #[test]
    fn a_missing_picture_is_looked_for_in_its_own_folder() {
        let folder = tempfile::tempdir().unwrap();
        let textures = folder.path().join("textures");
        fs::create_dir(&textures).unwrap();
        fs::write(textures.join("brick.png"), b"bytes").unwrap();
        let files = SceneFolder(folder.path().to_owned());
        assert_eq!(files.bytes("textures/brick.png"), Ok(b"bytes".to_vec()));
        let missing =
            FileUnavailable::Missing { place: textures.display().to_string(), files: vec!["brick.png".to_owned()] };
        assert_eq!(files.bytes("textures/brik.png"), Err(missing.clone()));
        let FileUnavailable::Unreadable { reason } = files.bytes("textures").unwrap_err() else { panic!() };
        assert_eq!(reason, "it is a folder");
    }
}
