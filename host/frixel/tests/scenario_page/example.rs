//! The first example of `docs/scenarios.md`, as a reader of the page has it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

pub(crate) fn page() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scenarios.md")).unwrap()
}

/// A folder with the scene and the scenario.
pub(crate) struct Example {
    folder: TempDir,
}

impl Example {
    pub(crate) fn new() -> Self {
        let folder = TempDir::new().unwrap();
        let page = page();
        let (_, example) = page.split_once("```toml\n").unwrap();
        let example = Self { folder }.with(example.split_once("```").unwrap().0);
        assert!(example.frixel(&["new", "waves"]).status.success());
        example
    }

    fn scenario(&self) -> PathBuf {
        self.folder.path().join("cut.toml")
    }

    fn with(self, text: &str) -> Self {
        fs::write(self.scenario(), text).unwrap();
        self
    }

    /// The example with another line in place of one of its own.
    pub(crate) fn edited(self, line: &str, other: &str) -> Self {
        let text = fs::read_to_string(self.scenario()).unwrap();
        assert_eq!(text.matches(line).count(), 1, "{line}");
        self.with(&text.replace(line, other))
    }

    /// Runs the scenario, as the page says.
    pub(crate) fn run(&self, rig: &str) -> Output {
        self.frixel(&["sim", "--scenario", "cut.toml", "--expect", "--rig", rig])
    }

    fn frixel(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_frixel"));
        command.args(arguments).current_dir(self.folder.path()).output().unwrap()
    }
}
