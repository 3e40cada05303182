//! Where the pictures come from that a scene names.

use std::collections::BTreeMap;

/// Gives the bytes of the pictures that a scene names.
///
/// [`Scene::parse`](crate::Scene::parse) reads each picture once, so that compiling needs nothing but the scene. A map
/// from names to bytes is enough where the pictures are in memory already:
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

/// Why the bytes of a picture are not there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureUnavailable {
    /// No picture has this name.
    Missing {
        /// Where it was looked for, as a message names the place: the path of a folder, for one.
        place: String,
        /// Names of the files there, without folders; the nearest one is suggested.
        files: Vec<String>,
    },
    /// The picture is there, and its bytes cannot be read.
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
