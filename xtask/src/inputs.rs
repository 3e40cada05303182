//! What a check reads: the files and folders whose change makes it run again (`stamps.rs`).
//!
//! The list of a package follows from its dependencies, as cargo reports them, and from [`READS`]. A test below holds
//! that table against the paths that stand in the sources.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::Value;

use crate::command::{cargo_in, text_of};

/// A package of the workspace.
pub(crate) struct Package {
    pub(crate) folder: String,
    /// The packages of the workspace that are compiled into it.
    dependencies: Vec<String>,
    /// Those that only its tests and examples use.
    dev_dependencies: Vec<String>,
}

/// What a package reads outside of its folder.
struct Reads {
    package: &'static str,
    /// What its `src` reads, so that it matters to everything that depends on the package.
    source: &'static [&'static str],
    /// What only its tests read.
    tests: &'static [&'static str],
}

const READS: [Reads; 7] = [
    Reads { package: "frixel", source: &["scenes"], tests: &["README.md", "docs", "firmware", "hil-sim"] },
    Reads { package: "frixel-fuzz", source: &["scenes"], tests: &[] },
    Reads { package: "frixel-hil-sim", source: &[], tests: &["firmware"] },
    Reads { package: "frixel-lab", source: &[], tests: &["docs", "hil-sim", "scenes"] },
    Reads { package: "frixel-scene", source: &["scenes"], tests: &["docs"] },
    Reads { package: "frixel-studio", source: &["scenes"], tests: &[] },
    // It looks at the manifests, lock files and sources of every package, and at the licences in the page.
    Reads {
        package: "xtask",
        source: &["LICENSE-APACHE", "LICENSE-MIT", "firmware", "fuzz", "hil-sim", "host", "model", "research"],
        tests: &["docs", "hardware"],
    },
];

/// Inputs of whatever is compiled.
pub(crate) const ALWAYS: [&str; 3] = ["Cargo.lock", "Cargo.toml", "clippy.toml"];

/// The inputs of what is compiled of these packages and of all that they depend on.
pub(crate) fn of_libraries(names: &[&str], packages: &BTreeMap<String, Package>) -> Vec<String> {
    let mut found = BTreeSet::new();
    let mut waiting: Vec<&str> = names.to_vec();
    while let Some(name) = waiting.pop() {
        if let Some(package) = packages.get(name)
            && found.insert(name)
        {
            waiting.extend(package.dependencies.iter().map(String::as_str));
        }
    }
    let folders = found.iter().filter_map(|name| packages.get(*name)).map(|package| package.folder.clone());
    let read = READS.iter().filter(|reads| found.contains(reads.package)).flat_map(|reads| reads.source);
    folders.chain(read.chain(&ALWAYS).map(|path| (*path).to_owned())).collect()
}

/// The inputs of the tests of a package.
pub(crate) fn of_tests(name: &str, packages: &BTreeMap<String, Package>) -> Vec<String> {
    let used = packages.get(name).into_iter().flat_map(|package| &package.dev_dependencies).map(String::as_str);
    let names: Vec<&str> = used.chain([name]).collect();
    let read = READS.iter().filter(|reads| reads.package == name).flat_map(|reads| reads.tests);
    of_libraries(&names, packages).into_iter().chain(read.map(|path| (*path).to_owned())).collect()
}

/// The packages of the workspace by name, as reported by cargo.
pub(crate) fn packages() -> Result<BTreeMap<String, Package>, String> {
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
    let all = package.get("dependencies")?.as_array()?;
    let of_workspace = all.iter().filter(|dependency| dependency.get("path").is_some());
    let named = of_workspace.filter_map(|dependency| {
        Some((dependency.get("name")?.as_str()?.to_owned(), dependency.get("kind")?.as_str() == Some("dev")))
    });
    let (dev, compiled): (Vec<_>, Vec<_>) = named.partition(|(_, is_dev)| *is_dev);
    let [dependencies, dev_dependencies] =
        [compiled, dev].map(|found| found.into_iter().map(|(name, _)| name).collect());
    Some((package.get("name")?.as_str()?.to_owned(), Package { folder, dependencies, dev_dependencies }))
}

#[cfg(test)]
pub(crate) mod tests {
    use std::fs;
    use std::path::PathBuf;

    use super::*;
    use crate::command::root;
    use crate::{check, licences, studio_tests};

    #[test]
    fn the_inputs_of_a_package_are_those_of_all_that_it_depends_on() {
        let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let package = |folder: &str, dependencies, dev_dependencies| Package {
            folder: folder.to_owned(),
            dependencies: names(dependencies),
            dev_dependencies: names(dev_dependencies),
        };
        let packages = BTreeMap::from([
            ("model".to_owned(), package("model", &[], &["kit"])),
            ("frixel-scene".to_owned(), package("host/scene", &["model"], &[])),
            ("felt".to_owned(), package("host/felt", &["frixel-scene"], &["kit"])),
            ("kit".to_owned(), package("kit", &["samples"], &["unused"])),
            ("samples".to_owned(), package("samples", &[], &[])),
            ("unused".to_owned(), package("unused", &[], &[])),
        ]);
        let felt = ["host/felt", "host/scene", "model", "scenes", "Cargo.lock", "Cargo.toml", "clippy.toml"];
        let sorted = |mut paths: Vec<String>| {
            paths.sort();
            paths
        };
        assert_eq!(sorted(of_libraries(&["felt"], &packages)), sorted(names(&felt)));
        let tests = [&felt[..], &["kit", "samples"]].concat();
        assert_eq!(sorted(of_tests("felt", &packages)), sorted(names(&tests)));
    }

    #[test]
    fn a_change_runs_what_depends_on_it_and_nothing_else() {
        let packages = packages().unwrap();
        let runs = |inputs: &[String], changed: &str| inputs.iter().any(|input| Path::new(changed).starts_with(input));
        let [page, command] = [studio_tests::page_inputs(&packages), studio_tests::command_inputs(&packages)];
        for (changed, [on_page, beside_command]) in [
            ("model/src/lib.rs", [true, true]),
            ("host/scene/src/lib.rs", [true, true]),
            ("host/studio/test/harness.mjs", [true, true]),
            ("scenes/brick.toml", [true, true]),
            ("host/lab/src/lib.rs", [false, true]),
            ("host/frixel/src/lib.rs", [false, true]),
            ("host/frixel/tests/main.rs", [false, true]),
            ("research/report/src/main.rs", [false, false]),
        ] {
            assert_eq!([runs(&page, changed), runs(&command, changed)], [on_page, beside_command], "{changed}");
        }
    }

    /// The files below a folder that have this ending.
    pub(crate) fn files_below(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
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

    /// Sources read files by paths relative to themselves (`include_str!`) or to their package's folder. A path to a
    /// folder that the package lies in, such as the repository's root, says nothing and is not looked at.
    #[test]
    fn every_file_that_a_package_reads_by_a_relative_path_is_among_its_inputs() {
        let packages = packages().unwrap();
        let mut outwards = 0;
        for (name, package) in &packages {
            let folder = root().join(&package.folder);
            let [of_tests, of_source] = [of_tests(name, &packages), of_libraries(&[name], &packages)];
            let mut sources = Vec::new();
            files_below(&folder, "rs", &mut sources);
            for source in sources {
                let text = fs::read_to_string(&source).unwrap();
                let within = source.strip_prefix(&folder).unwrap();
                let of_tests_only = ["tests", "tests.rs", "examples"];
                let is_source = within.iter().all(|part| of_tests_only.iter().all(|name| part != *name));
                let inputs = if is_source { &of_source } else { &of_tests };
                let beside = source.parent().unwrap();
                for path in paths_outwards(&text) {
                    let meant = [beside, &folder].map(|folder| in_repository(folder, path));
                    for meant in
                        meant.into_iter().flatten().filter(|meant| !Path::new(&package.folder).starts_with(meant))
                    {
                        let is_input = inputs.iter().any(|input| Path::new(&meant).starts_with(input));
                        assert!(is_input, "{}: {meant} is no input of {name}", source.display());
                        outwards += 1;
                    }
                }
            }
        }
        assert!(outwards > 20, "only {outwards} paths were found");
    }

    /// This program's own tests look into every package, and at the licences in the page.
    #[test]
    fn what_the_tests_of_xtask_read_is_among_their_inputs() {
        let packages = packages().unwrap();
        let inputs = of_libraries(&["xtask"], &packages);
        let folders = packages.values().map(|package| package.folder.as_str());
        for path in folders.chain(licences::FILES).chain(check::IMAGES.iter().map(|image| image.folder)) {
            let is_input = inputs.iter().any(|input| Path::new(path).starts_with(input));
            assert!(is_input, "{path} is no input of the tests of xtask");
        }
    }
}
