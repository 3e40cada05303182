//! The files that a scene names: pictures, profiles and included scenes; and what a text is.

use std::cell::RefCell;
use std::collections::BTreeSet;

use frixel_hil_sim::TouchConfig;
use frixel_scene::{FileUnavailable, Files, FingerProfile, Profile, Scene, Screen};
use serde_json::{Value, json};

use crate::host_error::HostError;
use crate::layer_text;
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

/// What a text is: the profile whose reader knows most of its fields, if one knows more of them than it has mistakes.
/// All else is read as a scene, to show its mistakes.
fn kind(text: &str) -> &'static str {
    let fields = layer_text::field_count(text);
    let profiles = [
        ("finger", mistakes::<FingerProfile>(text)),
        ("screen", mistakes::<Screen>(text)),
        ("touch", mistakes::<TouchConfig>(text)),
    ];
    let nearest = profiles.into_iter().min_by_key(|(_, mistakes)| *mistakes);
    nearest.filter(|(_, mistakes)| *mistakes < fields).map_or("scene", |(kind, _)| kind)
}

fn mistakes<P: Profile>(text: &str) -> usize {
    P::parse(text, P::KIND).err().map_or(0, |error| error.diagnostics.len())
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
