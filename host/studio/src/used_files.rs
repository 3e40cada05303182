//! The files that a scene names: pictures, profiles and included scenes; and what a text is.

use std::cell::RefCell;
use std::collections::BTreeSet;

use frixel_scene::{FileUnavailable, Files, Scene};
use serde_json::{Value, json};

use crate::host_error::HostError;
use crate::program::ProgramError;
use crate::request::Request;

/// The names of the files that the compiler reads for the scene of a request, as JSON: `names`, sorted, whether the
/// request has these files or not; `isWhole`, which is false if mistakes may hide further names; and `kind`, what the
/// text is: `scene`, or the profile of a request that it can be (`finger`, `screen` or `touch`).
pub fn used_files(request: &Request) -> Result<Value, HostError> {
    let files = Listening { files: &request.files, names: RefCell::default() };
    let text = request.scene().map_err(ProgramError::Request)?;
    let scene = Scene::parse_bytes(text, &request.entry, &files);
    let is_whole = scene.is_ok_and(|scene| scene.mistakes().is_empty());
    let kind = kind(&String::from_utf8_lossy(text));
    Ok(json!({ "names": files.names.into_inner(), "isWhole": is_whole, "kind": kind }))
}

/// Beginnings of lines that only scenes have.
const OF_SCENES: [&str; 5] = ["version", "[[layer", "[defaults", "[finger", "[screen"];
/// A field that each kind of profile has.
const OF_PROFILES: [(&str, &str); 3] =
    [("friction_coefficient", "finger"), ("reports_per_s", "touch"), ("width_mm", "screen")];

/// The kind of a text, by its fields, so that a profile with mistakes is recognised. Other texts are read as scenes.
fn kind(text: &str) -> &'static str {
    let begins = |word: &str| text.lines().any(|line| line.trim_start().starts_with(word));
    if OF_SCENES.into_iter().any(begins) {
        return "scene";
    }
    OF_PROFILES.into_iter().find(|(field, _)| begins(field)).map_or("scene", |(_, kind)| kind)
}

/// Files, and the names that were read.
struct Listening<'f, F> {
    files: &'f F,
    names: RefCell<BTreeSet<String>>,
}

impl<F: Files> Files for Listening<'_, F> {
    fn bytes(&self, name: &str) -> Result<Vec<u8>, FileUnavailable> {
        self.names.borrow_mut().insert(name.to_owned());
        self.files.bytes(name)
    }
}
