//! Builds the workspace's tests once, then runs them package by package, skipping packages whose inputs are unchanged.

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;

use serde_json::Value;

use crate::command::{cargo_in, root, text_of};
use crate::inputs::{self, packages};
use crate::outcome::Outcome;
use crate::{results, stamps};

/// The name of the test programs that need an emulator, one in each package that has such tests.
const ON_EMULATORS: &str = "emulated";

/// The package most of whose tests wait for virtual boards, which run in real time, and for other processes. With more
/// threads than processors, the processors work meanwhile.
const COMMAND: &str = "frixel";
const THREADS_PER_PROCESSOR: usize = 2;

/// Which test programs are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Programs {
    /// All but those that need an emulator.
    OnThisMachine,
    /// Those that need an emulator.
    OnEmulators,
}

/// A built test program.
struct TestProgram {
    package: String,
    name: String,
    path: PathBuf,
}

/// Builds all test programs, and runs these.
pub(crate) fn run_all(which: Programs) -> Result<Outcome, String> {
    let packages = packages()?;
    let programs = build()?;
    let mut all = Outcome::Passed;
    for (name, package) in &packages {
        let programs = programs.iter().filter(|program| program.package == *name && program.is_of(which));
        let programs: Vec<&TestProgram> = programs.collect();
        if !programs.is_empty() {
            let stamp = match which {
                Programs::OnThisMachine => format!("tests-{name}"),
                Programs::OnEmulators => format!("tests-{name}-{ON_EMULATORS}"),
            };
            all = all.and(stamps::unless_unchanged(&stamp, &inputs::of_tests(name, &packages), || {
                programs.iter().try_for_each(|program| program.run(&package.folder)).map(|()| Outcome::Passed)
            })?);
        }
    }
    Ok(all)
}

/// Runs the documentation tests.
pub(crate) fn run_documentation() -> Result<Outcome, String> {
    let folders = packages()?.into_values().map(|package| package.folder);
    let inputs: Vec<String> = folders.chain(inputs::ALWAYS.iter().map(|path| (*path).to_owned())).collect();
    stamps::unless_unchanged("documentation-tests", &inputs, || {
        results::run("documentation tests", cargo_in(".").args(["test", "--workspace", "--locked", "--doc"]))?;
        Ok(Outcome::Passed)
    })
}

fn processors() -> usize {
    thread::available_parallelism().map_or(1, NonZero::get)
}

impl TestProgram {
    fn is_of(&self, which: Programs) -> bool {
        (self.name == ON_EMULATORS) == (which == Programs::OnEmulators)
    }

    fn run(&self, folder: &str) -> Result<(), String> {
        let folder = root().join(folder);
        // Runs the program in the same way as cargo does.
        let mut command = Command::new(&self.path);
        if self.package == COMMAND {
            command.env("RUST_TEST_THREADS", (THREADS_PER_PROCESSOR * processors()).to_string());
        }
        results::run(
            &format!("{}: {}", self.package, self.name),
            command.current_dir(&folder).env("CARGO_MANIFEST_DIR", &folder),
        )
    }
}

/// Builds every test program of the workspace, with the same set of features for all.
fn build() -> Result<Vec<TestProgram>, String> {
    let mut command = cargo_in(".");
    command.args(["test", "--workspace", "--locked", "--no-run", "--message-format", "json-render-diagnostics"]);
    let messages = text_of(&mut command)?;
    messages.lines().filter_map(|line| test_program(line).transpose()).collect()
}

/// The test program that a message of cargo announces, if any.
fn test_program(line: &str) -> Result<Option<TestProgram>, String> {
    let message: Value = serde_json::from_str(line).map_err(|error| format!("cargo wrote `{line}`: {error}"))?;
    let is_test = message.pointer("/profile/test").and_then(Value::as_bool) == Some(true);
    let path = message.get("executable").and_then(Value::as_str);
    let manifest = message.get("manifest_path").and_then(Value::as_str);
    let (true, Some(path), Some(manifest)) = (is_test, path, manifest) else { return Ok(None) };
    let name = message.pointer("/target/name").and_then(Value::as_str).unwrap_or_default().to_owned();
    Ok(Some(TestProgram { package: name_in(Path::new(manifest))?, name, path: path.into() }))
}

/// Reads the name of the package from its manifest.
fn name_in(manifest: &Path) -> Result<String, String> {
    let explain = |error: &dyn std::fmt::Display| format!("{}: {error}", manifest.display());
    let text = std::fs::read_to_string(manifest).map_err(|error| explain(&error))?;
    let table: toml::Table = toml::from_str(&text).map_err(|error| explain(&error))?;
    let name = table.get("package").and_then(|package| package.get("name")).and_then(toml::Value::as_str);
    name.map(str::to_owned).ok_or_else(|| explain(&"it has no package name"))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::inputs::tests::files_below;

    /// The files of `tests` are modules of few programs, which cargo does not look for by itself.
    #[test]
    fn every_file_of_tests_belongs_to_a_test_program() {
        for package in packages().unwrap().into_values() {
            let folder = root().join(&package.folder);
            let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
            let manifest: toml::Table = toml::from_str(&manifest).unwrap();
            if manifest["package"].get("autotests").is_none() {
                continue;
            }
            let programs = manifest["test"].as_array().unwrap().iter();
            let programs: Vec<PathBuf> = programs.map(|test| folder.join(test["path"].as_str().unwrap())).collect();
            let modules: Vec<PathBuf> = programs.iter().flat_map(|program| modules_of(program)).collect();
            let mut files = Vec::new();
            files_below(&folder.join("tests"), "rs", &mut files);
            for file in files.iter().filter(|file| !programs.contains(file)) {
                assert!(modules.contains(file), "{} is in no test program: name it in main.rs", file.display());
            }
        }
    }

    /// The files of the modules that a source file declares, of theirs, and so on.
    fn modules_of(file: &Path) -> Vec<PathBuf> {
        let text = fs::read_to_string(file).unwrap();
        let is_root = ["main", "mod", "emulated", "safety"].iter().any(|name| file.file_stem().unwrap() == *name);
        let beside = file.parent().unwrap();
        let folder = if is_root { beside.to_owned() } else { file.with_extension("") };
        let mut attribute = None;
        let mut found = Vec::new();
        for line in text.lines().map(str::trim) {
            if let Some(path) = line.strip_prefix("#[path = \"") {
                attribute = path.split('"').next();
            } else if let Some(name) = line.strip_suffix(';').and_then(|line| line.rsplit_once("mod ")) {
                let candidates = match attribute.take() {
                    Some(path) => vec![beside.join(path)],
                    None => vec![folder.join(format!("{}.rs", name.1)), folder.join(name.1).join("mod.rs")],
                };
                for module in candidates.into_iter().filter(|module| module.is_file()) {
                    found.extend(modules_of(&module));
                    found.push(module);
                }
            }
        }
        found
    }

    #[test]
    fn only_test_programs_are_run() {
        let library = r#"{"reason":"compiler-artifact","profile":{"test":false},"executable":null}"#;
        assert!(test_program(library).unwrap().is_none());
        assert!(test_program("not JSON").is_err());
    }
}
