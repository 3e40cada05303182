//! Builds the workspace's tests once, then runs them package by package, skipping packages whose inputs are unchanged.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::command::{cargo_in, root, text_of};
use crate::outcome::Outcome;
use crate::{results, stamps};

/// The name of the test programs that need an emulator, one in each package that has such tests.
const ON_EMULATORS: &str = "emulated";

/// Which test programs are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Programs {
    /// All but those that need an emulator.
    OnThisMachine,
    /// Those that need an emulator.
    OnEmulators,
}

/// Inputs of tests besides the folders of their package and of its dependencies.
const MORE_INPUTS: [(&str, &[&str]); 6] = [
    ("frixel", &["README.md", "docs", "firmware", "scenes"]),
    ("frixel-fuzz", &["scenes"]),
    ("frixel-scene", &["docs", "scenes"]),
    ("frixel-studio", &["scenes"]),
    ("frixel-hil-sim", &["firmware"]),
    // They read the manifests, lock files and sources of every package, and the licences in the page.
    ("xtask", &["LICENSE-APACHE", "LICENSE-MIT", "firmware", "fuzz", "hil-sim", "host", "model", "research"]),
];

/// Inputs of the tests of every package.
const ALWAYS: [&str; 2] = ["Cargo.lock", "Cargo.toml"];

/// A package of the workspace.
struct Package {
    folder: String,
    /// The packages of the workspace that it depends on, including dev-dependencies.
    dependencies: Vec<String>,
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
            all = all.and(stamps::unless_unchanged(&stamp, &inputs(name, &packages), || {
                programs.iter().try_for_each(|program| program.run(&package.folder)).map(|()| Outcome::Passed)
            })?);
        }
    }
    Ok(all)
}

/// Runs the documentation tests.
pub(crate) fn run_documentation() -> Result<Outcome, String> {
    let folders = packages()?.into_values().map(|package| package.folder);
    let inputs: Vec<String> = folders.chain(ALWAYS.iter().map(|path| (*path).to_owned())).collect();
    stamps::unless_unchanged("documentation-tests", &inputs, || {
        results::run("documentation tests", cargo_in(".").args(["test", "--workspace", "--locked", "--doc"]))?;
        Ok(Outcome::Passed)
    })
}

impl TestProgram {
    fn is_of(&self, which: Programs) -> bool {
        (self.name == ON_EMULATORS) == (which == Programs::OnEmulators)
    }

    fn run(&self, folder: &str) -> Result<(), String> {
        let folder = root().join(folder);
        // Runs the program in the same way as cargo does.
        let mut command = Command::new(&self.path);
        results::run(
            &format!("{}: {}", self.package, self.name),
            command.current_dir(&folder).env("CARGO_MANIFEST_DIR", &folder),
        )
    }
}

/// The files and folders that the tests of a package depend on.
fn inputs(name: &str, packages: &BTreeMap<String, Package>) -> Vec<String> {
    let mut found = BTreeSet::new();
    let mut waiting = vec![name];
    while let Some(name) = waiting.pop() {
        if let Some(package) = packages.get(name)
            && found.insert(name)
        {
            waiting.extend(package.dependencies.iter().map(String::as_str));
        }
    }
    let folders = found.iter().filter_map(|name| packages.get(*name)).map(|package| package.folder.clone());
    let more = MORE_INPUTS.iter().filter(|(package, _)| *package == name).flat_map(|(_, more)| *more);
    folders.chain(more.chain(&ALWAYS).map(|path| (*path).to_owned())).collect()
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

/// The packages of the workspace by name, as reported by cargo.
fn packages() -> Result<BTreeMap<String, Package>, String> {
    let mut command = cargo_in(".");
    command.args(["metadata", "--locked", "--no-deps", "--format-version", "1"]);
    let metadata: Value = serde_json::from_str(&text_of(&mut command)?).map_err(|error| error.to_string())?;
    let root = metadata.get("workspace_root").and_then(Value::as_str).ok_or("cargo names no workspace")?;
    let packages = metadata.get("packages").and_then(Value::as_array).ok_or("cargo names no packages")?;
    packages
        .iter()
        .map(|package| package_of(package, Path::new(root)).ok_or_else(|| format!("cargo describes {package}")))
        .collect()
}

/// Extracts the name and the properties of a package from cargo's metadata.
fn package_of(package: &Value, root: &Path) -> Option<(String, Package)> {
    let manifest = Path::new(package.get("manifest_path")?.as_str()?);
    let folder = manifest.parent()?.strip_prefix(root).ok()?.to_str()?.to_owned();
    let dependencies = package.get("dependencies")?.as_array()?;
    let dependencies = dependencies.iter().filter(|dependency| dependency.get("path").is_some());
    let dependencies = dependencies.filter_map(|dependency| Some(dependency.get("name")?.as_str()?.to_owned()));
    Some((package.get("name")?.as_str()?.to_owned(), Package { folder, dependencies: dependencies.collect() }))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::{check, licences};

    #[test]
    fn the_inputs_of_a_package_are_those_of_all_that_it_depends_on() {
        let package = |folder: &str, dependencies: &[&str]| Package {
            folder: folder.to_owned(),
            dependencies: dependencies.iter().map(|name| (*name).to_owned()).collect(),
        };
        let packages = BTreeMap::from([
            ("model".to_owned(), package("model", &[])),
            ("wire".to_owned(), package("firmware/wire", &["model"])),
            ("frixel".to_owned(), package("host", &["wire"])),
        ]);
        let found = inputs("frixel", &packages);
        for expected in ["model", "firmware/wire", "host", "scenes", "Cargo.lock"] {
            assert!(found.iter().any(|path| path == expected), "{expected} is missing in {found:?}");
        }
        assert_eq!(inputs("model", &packages), ["model", "Cargo.lock", "Cargo.toml"]);
    }

    /// The files below a folder that have this ending.
    fn files_below(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let is_built = path.file_name().is_some_and(|name| name == "target" || name == "node_modules");
            if path.is_dir() && !is_built {
                files_below(&path, ending, found);
            } else if path.extension().is_some_and(|found| found == ending) {
                found.push(path);
            }
        }
    }

    /// The string literals of a source file that lead out of a folder.
    fn paths_outwards(text: &str) -> impl Iterator<Item = &str> {
        let literals = text.split('"').skip(1).step_by(2);
        literals.filter(|literal| literal.contains("../") && !literal.contains(char::is_whitespace))
    }

    /// What a relative path names in the repository, if it is there.
    fn in_repository(folder: &Path, path: &str) -> Option<String> {
        let path = folder.join(path.trim_start_matches('/')).canonicalize().ok()?;
        let path = path.strip_prefix(root().canonicalize().unwrap()).ok()?.to_str()?.to_owned();
        // Artefacts are not files of the repository.
        (!path.split('/').any(|name| name == "target")).then_some(path)
    }

    /// Tests read files by paths relative to their source file (`include_str!`) or to their package's folder. A path to a
    /// folder that the package lies in, such as the repository's root, says nothing and is not looked at.
    #[test]
    fn every_file_that_a_package_reads_by_a_relative_path_is_among_the_inputs_of_its_tests() {
        let packages = packages().unwrap();
        let mut outwards = 0;
        for (name, package) in &packages {
            let folder = root().join(&package.folder);
            let inputs = inputs(name, &packages);
            let mut sources = Vec::new();
            files_below(&folder, "rs", &mut sources);
            for source in sources {
                let text = fs::read_to_string(&source).unwrap();
                let beside = source.parent().unwrap();
                for path in paths_outwards(&text) {
                    let meant = [beside, &folder].map(|folder| in_repository(folder, path));
                    for meant in
                        meant.into_iter().flatten().filter(|meant| !Path::new(&package.folder).starts_with(meant))
                    {
                        let is_input = inputs.iter().any(|input| Path::new(&meant).starts_with(input));
                        assert!(is_input, "{}: {meant} is no input of the tests of {name}", source.display());
                        outwards += 1;
                    }
                }
            }
        }
        assert!(outwards > 20, "only {outwards} paths were found");
    }

    #[test]
    fn the_scenes_are_inputs_of_the_studios_tests() {
        assert!(inputs("frixel-studio", &packages().unwrap()).contains(&"scenes".to_owned()));
    }

    /// This program's own tests look into every package, and at the licences in the page.
    #[test]
    fn what_the_tests_of_xtask_read_is_among_their_inputs() {
        let packages = packages().unwrap();
        let inputs = inputs("xtask", &packages);
        let folders = packages.values().map(|package| package.folder.as_str());
        for path in folders.chain(licences::FILES).chain(check::IMAGES.iter().map(|image| image.folder)) {
            let is_input = inputs.iter().any(|input| Path::new(path).starts_with(input));
            assert!(is_input, "{path} is no input of the tests of xtask");
        }
    }

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
