//! The source of the files that a scene names: pictures, and profiles of screens and fingers.

use std::collections::BTreeMap;

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
        self.get(name).cloned().ok_or_else(|| FileUnavailable::Missing {
            place: "the scene's set of files".to_owned(),
            files: self.keys().map(|name| file_name(name).to_owned()).collect(),
        })
    }
}

/// The part of a file name after the last slash.
pub(super) fn file_name(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}
