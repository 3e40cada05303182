//! The source of the pictures that a scene names.

use std::collections::BTreeMap;

/// Provides the bytes of the pictures that a scene names.
///
/// [`Scene::parse`](crate::Scene::parse) reads each picture once, so that compiling needs only the scene. Where the
/// pictures are already in memory, a map from names to bytes implements this trait:
///
/// ```
/// use std::collections::BTreeMap;
/// use frixel_scene::{PictureUnavailable, Pictures};
///
/// let pictures = BTreeMap::from([("textures/brick.png".to_owned(), vec![0x89, b'P', b'N', b'G'])]);
/// assert_eq!(pictures.png("textures/brick.png").map(|bytes| bytes.len()), Ok(4));
/// assert!(matches!(pictures.png("brik.png"), Err(PictureUnavailable::Missing { .. })));
/// ```
pub trait Pictures {
    /// The bytes of the PNG file that the scene file calls `name`.
    fn png(&self, name: &str) -> Result<Vec<u8>, PictureUnavailable>;
}

/// The reason why the bytes of a picture are not available.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureUnavailable {
    /// No picture has this name.
    Missing {
        /// The place that was searched, as a message names it: for example the path of a folder.
        place: String,
        /// Names of the files there, without folders; the message suggests the nearest one.
        files: Vec<String>,
    },
    /// The picture exists, but its bytes cannot be read.
    Unreadable {
        /// The reason, in the operating system's words.
        reason: String,
    },
}

impl Pictures for BTreeMap<String, Vec<u8>> {
    fn png(&self, name: &str) -> Result<Vec<u8>, PictureUnavailable> {
        self.get(name).cloned().ok_or_else(|| PictureUnavailable::Missing {
            place: "the scene's set of pictures".to_owned(),
            files: self.keys().map(|name| file_name(name).to_owned()).collect(),
        })
    }
}

/// The part of a picture's name behind the last slash.
pub(super) fn file_name(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}
