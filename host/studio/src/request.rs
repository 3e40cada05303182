//! The page's request in the input buffer: a scene with its files, or a line of text.
//!
//! The buffer begins with the length of a JSON text (32 bits, little-endian) and the text. The bytes of the files
//! follow, one file after another, in the order and with the lengths that the text states.

use std::collections::BTreeMap;

use serde::Deserialize;
use thiserror::Error;

/// A request of the page.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Request {
    /// Name of the scene among the files.
    pub entry: String,
    /// The files, by their names relative to the scene's folder.
    #[serde(skip)]
    pub files: BTreeMap<String, Vec<u8>>,
    /// The finger: the name of a bundled profile or the text of one; `None` for the scene's own.
    pub finger: Option<String>,
    /// The screen, likewise.
    pub screen: Option<String>,
    /// The simulated touch source: the name of a bundled one or the text of one; `None` for 100 reports a second.
    pub touch: Option<String>,
    /// Whether the simulator in the page plays the scene without prediction, regardless of the scene.
    #[serde(default)]
    pub without_prediction: bool,
    /// Numbers of the request.
    #[serde(flatten)]
    pub numbers: Numbers,
}

/// The numbers of a request. Those that it does not state are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct Numbers {
    /// Largest width of a map, in pixels.
    pub width_px: u32,
    /// Largest height of a map, in pixels.
    pub height_px: u32,
    /// Sliding speed for a map, mm/s.
    pub speed_mm_per_s: f64,
    /// Seed of every random number.
    pub seed: u64,
    /// Duration of a seeded play, ms of virtual time.
    pub duration_ms: u32,
}

/// Why a request cannot be read. Only a mistake in `engine.js` leads to one.
#[derive(Debug, Error)]
pub enum RequestError {
    /// The buffer is shorter than the request states.
    #[error("the request ends after {found} bytes, but states more")]
    Short {
        /// Length of the buffer.
        found: usize,
    },
    /// The JSON text is none.
    #[error("this engine cannot read the request: {0}")]
    Json(#[from] serde_json::Error),
    /// The scene is not among the files.
    #[error("the request has no file named {entry:?}")]
    NoEntry {
        /// Name of the scene.
        entry: String,
    },
}

#[derive(Deserialize)]
struct Head {
    files: Vec<FileHead>,
    #[serde(flatten)]
    request: Request,
}

#[derive(Deserialize)]
struct FileHead {
    name: String,
    len: usize,
}

impl Request {
    /// Reads a request.
    pub fn parse(bytes: &[u8]) -> Result<Self, RequestError> {
        let short = || RequestError::Short { found: bytes.len() };
        let (len, rest) = bytes.split_first_chunk().ok_or_else(short)?;
        let (json, mut rest) = rest.split_at_checked(u32::from_le_bytes(*len) as usize).ok_or_else(short)?;
        let Head { files: heads, request } = serde_json::from_slice(json)?;
        // Names in a scene are relative to the scene's folder.
        let folder = request.entry.rfind('/').map_or("", |slash| request.entry.get(..=slash).unwrap_or_default());
        let mut files = BTreeMap::new();
        for FileHead { name, len } in heads {
            let (content, behind) = rest.split_at_checked(len).ok_or_else(short)?;
            files.insert(name.strip_prefix(folder).unwrap_or(&name).to_owned(), content.to_owned());
            rest = behind;
        }
        let entry = request.entry.strip_prefix(folder).unwrap_or(&request.entry).to_owned();
        Ok(Self { entry, files, ..request })
    }

    /// The bytes of the scene file.
    pub fn scene(&self) -> Result<&[u8], RequestError> {
        let scene = self.files.get(&self.entry).map(Vec::as_slice);
        scene.ok_or_else(|| RequestError::NoEntry { entry: self.entry.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(json: &str, files: &[u8]) -> Vec<u8> {
        [&(json.len() as u32).to_le_bytes(), json.as_bytes(), files].concat()
    }

    #[test]
    fn files_are_named_relative_to_the_scenes_folder() {
        let json = r#"{ "entry": "scenes/a.toml", "seed": 7, "files":
            [{ "name": "scenes/a.toml", "len": 2 }, { "name": "scenes/textures/b.png", "len": 3 }] }"#;
        let request = Request::parse(&bytes(json, b"ab\x01\x02\x03")).unwrap();
        assert_eq!(request.scene().unwrap(), b"ab");
        assert_eq!(request.files["textures/b.png"], [1, 2, 3]);
        assert_eq!(request.numbers, Numbers { seed: 7, ..Numbers::default() });
    }

    #[test]
    fn a_request_that_is_cut_is_refused() {
        let json = r#"{ "entry": "a.toml", "files": [{ "name": "a.toml", "len": 2 }] }"#;
        let whole = bytes(json, b"ab");
        assert!(Request::parse(&whole).is_ok());
        for len in 0..whole.len() {
            assert!(Request::parse(&whole[..len]).is_err(), "{len} bytes");
        }
    }
}
