//! The source of the files that a scene names: pictures, and profiles of screens and fingers.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use serde::{Deserialize, Serialize};

use super::picture::{Picture, PictureError, refuse_too_large};

/// Provides the bytes of the files that a scene names.
///
/// [`Scene::parse`](crate::Scene::parse) reads each file once, so that compiling needs only the scene. If the files are
/// already in memory, use a map from names to bytes:
///
/// ```
/// use std::collections::BTreeMap;
/// use frixel_scene::{FileUnavailable, Files};
///
/// let files = BTreeMap::from([("textures/brick.png".to_owned(), vec![0x89, b'P', b'N', b'G'])]);
/// assert_eq!(files.bytes("textures/brick.png").map(|bytes| bytes.len()), Ok(4));
/// assert!(matches!(files.bytes("brik.png"), Err(FileUnavailable::Missing { .. })));
/// ```
pub trait Files {
    /// The bytes of the file that the scene calls `name`.
    fn bytes(&self, name: &str) -> Result<Vec<u8>, FileUnavailable>;

    /// The same as a file that several scenes can share.
    fn shared(&self, name: &str) -> Result<Arc<SharedFile>, FileUnavailable> {
        self.bytes(name).map(|bytes| Arc::new(bytes.into()))
    }
}

/// The bytes of a file. Scenes that share it decode its picture once.
#[derive(Debug)]
pub struct SharedFile {
    pub(super) bytes: Vec<u8>,
    picture: OnceLock<Arc<Picture>>,
}

impl SharedFile {
    /// The picture in the file, of at most `pixels_max` pixels.
    pub(super) fn picture(&self, pixels_max: usize) -> Result<Arc<Picture>, PictureError> {
        if let Some(picture) = self.picture.get() {
            refuse_too_large(picture.width, picture.height, pixels_max)?;
            return Ok(Arc::clone(picture));
        }
        let picture = Picture::decode(&self.bytes, pixels_max)?;
        Ok(Arc::clone(self.picture.get_or_init(|| Arc::new(picture))))
    }
}

impl From<Vec<u8>> for SharedFile {
    fn from(bytes: Vec<u8>) -> Self {
        Self { bytes, picture: OnceLock::new() }
    }
}

impl PartialEq for SharedFile {
    fn eq(&self, other: &Self) -> bool {
        self.bytes == other.bytes
    }
}

/// Files in memory, by their names, for many scenes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "BTreeMap<String, Vec<u8>>", into = "BTreeMap<String, Vec<u8>>")]
pub struct SharedFiles(BTreeMap<String, Arc<SharedFile>>);

impl From<SharedFiles> for BTreeMap<String, Vec<u8>> {
    fn from(files: SharedFiles) -> Self {
        files.0.into_iter().map(|(name, file)| (name, file.bytes.clone())).collect()
    }
}

impl From<BTreeMap<String, Vec<u8>>> for SharedFiles {
    fn from(files: BTreeMap<String, Vec<u8>>) -> Self {
        Self(files.into_iter().map(|(name, bytes)| (name, Arc::new(bytes.into()))).collect())
    }
}

/// The reason why the bytes of a file are not available.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileUnavailable {
    /// No file has this name.
    Missing {
        /// The place that was searched, as a message names it: for example the path of a folder.
        place: String,
        /// Names of the files there, without folders; the message suggests the nearest one.
        files: Vec<String>,
    },
    /// The file exists, but its bytes cannot be read.
    Unreadable {
        /// The reason, in the operating system's words.
        reason: String,
    },
}

impl Files for BTreeMap<String, Vec<u8>> {
    fn bytes(&self, name: &str) -> Result<Vec<u8>, FileUnavailable> {
        found(self, name)
    }
}

impl Files for SharedFiles {
    fn bytes(&self, name: &str) -> Result<Vec<u8>, FileUnavailable> {
        self.shared(name).map(|file| file.bytes.clone())
    }

    fn shared(&self, name: &str) -> Result<Arc<SharedFile>, FileUnavailable> {
        found(&self.0, name)
    }
}

fn found<F: Clone>(files: &BTreeMap<String, F>, name: &str) -> Result<F, FileUnavailable> {
    files.get(name).cloned().ok_or_else(|| FileUnavailable::Missing {
        place: "the scene's set of files".to_owned(),
        files: files.keys().map(|name| file_name(name).to_owned()).collect(),
    })
}

/// The part of a file name after the last slash.
pub(super) fn file_name(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}
