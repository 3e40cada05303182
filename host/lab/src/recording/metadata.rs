//! Metadata of a recording.

use std::collections::BTreeMap;

use frixel_felt::recorder::Marker;
use frixel_wire::hello::{Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::hash::{hex, sha256};

/// Total size of the files that are embedded in a recording, bytes; of further ones, only the hash is kept.
pub(super) const EMBEDDED_MAX_BYTES: usize = 4 << 20;

/// The commit, if the build sets it.
const REVISION: Option<&str> = option_env!("FRIXEL_REVISION");

/// How a recording was made, and the events during it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Metadata {
    /// Version of frixel that made the recording.
    pub frixel: String,
    /// The commit that it was built from, if that was known.
    pub git_revision: Option<String>,
    /// Protocol that it speaks: `major.minor`.
    pub protocol: String,
    /// Rig that played the scene: `sim`, `qemu`, `pico`, or `board` for one at a port.
    pub rig: String,
    /// Whether finger or board is simulated. Otherwise a person's finger was on a board, which cannot be played again.
    pub is_simulated: bool,
    /// The board.
    pub board: BoardIdentity,
    /// Ticks of the board per second.
    pub tick_hz: u32,
    /// Ticks between two rows.
    pub ticks_per_row: u32,
    /// Code of the participant, if one was given.
    pub participant: Option<String>,
    /// Options of the play, a [`PlayOptions`](crate::simulate::PlayOptions), for replaying it.
    pub play: Value,
    /// Text of the scene's file.
    #[serde(skip)]
    pub scene: String,
    /// The other files, by role (`stroke`, `finger`, `screen`, `touch`, `stream`) or, for files of the scene, by
    /// `scene/` and their name in the scene.
    #[serde(skip)]
    pub files: BTreeMap<String, SourceFile>,
    /// Scenes that replaced the first one, or that the board refused, in order.
    #[serde(skip)]
    pub later_scenes: Vec<LaterScene>,
    /// Events, in their order.
    #[serde(skip)]
    pub markers: Vec<Marker>,
}

impl Metadata {
    /// The version that writes recordings, and that can replay them.
    pub const VERSION: &'static str = env!("CARGO_PKG_VERSION");

    /// Metadata of the program and of the board, as far as the board is known.
    pub fn new(rig: &str, board: Option<&Hello>, is_simulated: bool, participant: Option<&str>) -> Self {
        Self {
            frixel: Self::VERSION.to_owned(),
            git_revision: REVISION.map(str::to_owned),
            protocol: format!("{PROTOCOL_MAJOR}.{PROTOCOL_MINOR}"),
            rig: rig.to_owned(),
            is_simulated,
            board: board.map(Into::into).unwrap_or_default(),
            tick_hz: board.map_or(0, |hello| hello.tick_hz),
            participant: participant.map(str::to_owned),
            ..Self::default()
        }
    }

    /// Adds a scene that was sent to the board, with the files that it names.
    pub fn add_scene<'a>(
        &mut self,
        (t_s, scene, is_refused): (f64, String, bool),
        files: impl IntoIterator<Item = (String, &'a [u8])>,
    ) {
        let files = SourceFile::within(self.room_bytes(), files);
        self.later_scenes.push(LaterScene { t_s, scene, is_refused, files });
    }

    /// Adds a file that grew during the play.
    pub fn add_grown(&mut self, name: &str, file: GrowingFile) {
        let file = file.end(self.room_bytes());
        self.files.insert(name.to_owned(), file);
    }

    /// Bytes of further files that are kept as they are.
    fn room_bytes(&self) -> usize {
        let later = self.later_scenes.iter().flat_map(|later| later.files.values());
        let kept: usize = self.files.values().chain(later).map(SourceFile::kept_bytes).sum();
        EMBEDDED_MAX_BYTES.saturating_sub(kept)
    }
}

/// The board of a recording.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct BoardIdentity {
    /// Its kind.
    pub kind: String,
    /// Its unique identifier, in hexadecimal digits.
    pub id: String,
    /// Version of its firmware.
    pub firmware: String,
    /// Protocol that it speaks: `major.minor`.
    pub protocol: String,
}

impl From<&Hello> for BoardIdentity {
    fn from(hello: &Hello) -> Self {
        let (major, minor, patch) = hello.firmware;
        Self {
            kind: hello.board.to_string(),
            id: hex(&hello.id),
            firmware: format!("{major}.{minor}.{patch}"),
            protocol: format!("{}.{}", hello.protocol.0, hello.protocol.1),
        }
    }
}

/// A scene that replaced another one, or was refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LaterScene {
    /// Time at which it began to play, s.
    pub t_s: f64,
    /// Text of its file.
    pub scene: String,
    /// Whether the board refused it, and kept playing the previous scene.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_refused: bool,
    /// Its files, by their names in the scene.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub files: BTreeMap<String, SourceFile>,
}

/// An input file of a play.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SourceFile {
    /// Its text.
    Text(String),
    /// Its bytes in hexadecimal digits, if it is not text.
    Hex(String),
    /// A file that is too large to be kept.
    Hash {
        /// The SHA-256 of its bytes.
        sha256: String,
        /// Number of its bytes.
        bytes: usize,
    },
}

impl SourceFile {
    /// Files by their names, embedded as long as their total size is within the limit; further ones by their hash.
    pub fn all<'a>(files: impl IntoIterator<Item = (String, &'a [u8])>) -> BTreeMap<String, Self> {
        Self::within(EMBEDDED_MAX_BYTES, files)
    }

    /// Files by their names, embedded as long as they fit into `left` bytes together; further ones by their hash.
    fn within<'a>(mut left: usize, files: impl IntoIterator<Item = (String, &'a [u8])>) -> BTreeMap<String, Self> {
        let mut file = |bytes: &[u8]| match left.checked_sub(bytes.len()) {
            Some(rest) => {
                left = rest;
                std::str::from_utf8(bytes).map_or_else(|_| Self::Hex(hex(bytes)), |text| Self::Text(text.to_owned()))
            }
            None => Self::Hash { sha256: sha256(bytes), bytes: bytes.len() },
        };
        files.into_iter().map(|(name, bytes)| (name, file(bytes))).collect()
    }

    /// The bytes of the file; `None` if only their hash is known.
    pub fn bytes(&self) -> Option<Vec<u8>> {
        match self {
            Self::Text(text) => Some(text.clone().into_bytes()),
            Self::Hex(digits) => from_hex(digits),
            Self::Hash { .. } => None,
        }
    }

    /// How many of its bytes are kept.
    fn kept_bytes(&self) -> usize {
        match self {
            Self::Text(text) => text.len(),
            Self::Hex(digits) => digits.len() / 2,
            Self::Hash { .. } => 0,
        }
    }
}

/// A file that grows during a play.
#[derive(Clone, Debug, Default)]
pub struct GrowingFile {
    /// The first of its bytes, as many as a recording may keep.
    kept: Vec<u8>,
    bytes: usize,
    hash: Sha256,
}

impl GrowingFile {
    /// Adds bytes at the end.
    pub fn extend(&mut self, bytes: &[u8]) {
        self.hash.update(bytes);
        self.bytes += bytes.len();
        let room = EMBEDDED_MAX_BYTES - self.kept.len();
        self.kept.extend_from_slice(bytes.get(..room).unwrap_or(bytes));
    }

    /// The file as it is kept where there is room for so many bytes.
    fn end(self, room_bytes: usize) -> SourceFile {
        if self.bytes <= room_bytes {
            SourceFile::Hex(hex(&self.kept))
        } else {
            SourceFile::Hash { sha256: hex(&self.hash.finalize()), bytes: self.bytes }
        }
    }
}

fn from_hex(digits: &str) -> Option<Vec<u8>> {
    let pair = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok();
    digits.as_bytes().chunks(2).map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_text_or_bytes_or_a_hash() {
        let large = vec![7; EMBEDDED_MAX_BYTES];
        let files: [(&str, &[u8]); 3] = [("a", b"version = 1\n"), ("b", &[0xff, 0x00]), ("c", &large)];
        let files = SourceFile::all(files.map(|(name, bytes)| (name.to_owned(), bytes)));
        assert_eq!(files["a"], SourceFile::Text("version = 1\n".to_owned()));
        assert_eq!((&files["b"], files["b"].bytes()), (&SourceFile::Hex("ff00".to_owned()), Some(vec![0xff, 0x00])));
        assert_eq!(files["c"].bytes(), None);
        // The example of FIPS 180-4.
        assert!(hex(&Sha256::digest(b"abc")).starts_with("ba7816bf8f01cfea414140de5dae2223"));
    }

    #[test]
    fn a_file_that_grows_and_later_scenes_share_the_room_with_the_others() {
        let half = vec![7; EMBEDDED_MAX_BYTES / 2];
        let mut grown = GrowingFile::default();
        half.chunks(1000).for_each(|piece| grown.extend(piece));
        let mut metadata = Metadata::default();
        metadata.add_scene((0.5, "version = 1\n".to_owned(), false), [("a.png".to_owned(), half.as_slice())]);
        metadata.add_grown("stream", grown.clone());
        assert_eq!(metadata.later_scenes[0].files["a.png"].bytes().as_ref(), Some(&half));
        assert_eq!(metadata.files["stream"].bytes().as_ref(), Some(&half));
        grown.extend(&half);
        grown.extend(b"abc");
        let all = [half.as_slice(), &half, b"abc"].concat();
        let mut metadata = Metadata::default();
        metadata.add_grown("stream", grown);
        let expected = SourceFile::Hash { sha256: hex(&Sha256::digest(&all)), bytes: all.len() };
        assert_eq!(metadata.files["stream"], expected);
    }
}
