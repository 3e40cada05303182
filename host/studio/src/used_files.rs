//! The files that a scene names: pictures, profiles and included scenes.

use std::cell::RefCell;
use std::collections::BTreeSet;

use frixel_scene::{FileUnavailable, Files, Scene};
use serde_json::{Value, json};

use crate::host_error::HostError;
use crate::program::ProgramError;
use crate::request::Request;

/// The names of the files that the compiler reads for the scene of a request, as JSON: `names`, sorted, whether the
/// request has these files or not; and `isWhole`, which is false if mistakes may hide further names.
pub fn used_files(request: &Request) -> Result<Value, HostError> {
    let files = Listening { files: &request.files, names: RefCell::default() };
    let text = request.scene().map_err(ProgramError::Request)?;
    let scene = Scene::parse_bytes(text, &request.entry, &files);
    let is_whole = scene.is_ok_and(|scene| scene.mistakes().is_empty());
    Ok(json!({ "names": files.names.into_inner(), "isWhole": is_whole }))
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
