//! The first example of `docs/inside/scenarios.md`, as a reader of the page has it.

use std::fs;
use std::process::Output;

use tempfile::TempDir;

use crate::processes::{self, repository, succeed};

pub(crate) fn page() -> String {
    fs::read_to_string(repository().join("docs/inside/scenarios.md")).unwrap()
}

/// The scenario of the page.
pub(crate) fn text() -> String {
    let page = page();
    let (_, example) = page.split_once("```toml\n").unwrap();
    example.split_once("```").unwrap().0.to_owned()
}

/// Runs a scenario beside the page's scene, with the page's command.
pub(crate) fn run(scenario: &str, rig: &str) -> Output {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("cut.toml"), scenario).unwrap();
    succeed(folder.path(), &["new", "waves"]);
    processes::run(folder.path(), &["sim", "--scenario", "cut.toml", "--expect", "--rig", rig])
}
