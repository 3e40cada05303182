//! The files that a scene names: pictures, profiles and included scenes; and what a text is.

use std::cell::RefCell;
use std::collections::BTreeSet;

use frixel_scene::{FileKind, FileUnavailable, Files, Scene};
use serde_json::{Value, json};

use crate::host_error::HostError;
use crate::program::ProgramError;
use crate::request::Request;

/// The names of the files that the compiler reads for the scene of a request, as JSON: `names`, sorted, whether the
/// request has these files or not; `isWhole`, which is false if mistakes may hide further names; and `kind`, what the
/// text is: the profile of a request that it can be (`finger`, `screen` or `touch`), or else `scene`.
pub fn used_files(request: &Request) -> Result<Value, HostError> {
    let files = Listening { files: &request.files, names: RefCell::default() };
    let text = request.scene().map_err(ProgramError::Request)?;
    let scene = Scene::parse(text, &request.entry, &files);
    let is_whole = scene.is_ok_and(|scene| scene.mistakes().is_empty());
    let kind = match FileKind::of(text) {
        Some(FileKind::Finger) => "finger",
        Some(FileKind::Screen) => "screen",
        Some(FileKind::TouchSource) => "touch",
        _ => "scene",
    };
    Ok(json!({ "names": files.names.into_inner(), "isWhole": is_whole, "kind": kind }))
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
