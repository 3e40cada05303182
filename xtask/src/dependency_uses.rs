//! Where programs use the crates that other embedded projects share with this one, by manifests and sources. A use
//! that disappears, or a manifest that names a crate without using it, fails here.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::command::root;

/// The packages whose sources use each crate, tests apart.
const USES: [(&str, &[&str]); 6] = [
    ("defmt", &["board-nucleo-g474re", "frixel-board", "frixel-drivers"]),
    ("embedded-hal", &["board-mps2-an386", "board-nucleo-g474re", "frixel-board", "frixel-drivers", "frixel-hil-sim"]),
    ("fixed", &["frixel-control", "frixel-model", "frixel-wire"]),
    (
        "heapless",
        &[
            "board-mps2-an386",
            "board-nucleo-g474re",
            "frixel-board",
            "frixel-exchange",
            "frixel-layers",
            "frixel-session",
            "frixel-testkit",
        ],
    ),
    (
        "libm",
        &[
            "bench",
            "frixel",
            "frixel-felt",
            "frixel-hil-sim",
            "frixel-lab",
            "frixel-layers",
            "frixel-model",
            "frixel-scene",
            "frixel-testkit",
        ],
    ),
    ("serialport", &["frixel-driver"]),
];

struct Package {
    dependencies: BTreeSet<String>,
    has_program: bool,
    /// Its sources without comments and tests.
    code: String,
}

/// Every package of the repository, by its name.
fn packages() -> BTreeMap<String, Package> {
    let mut packages = BTreeMap::new();
    add_packages(&root(), &mut packages);
    packages
}

fn add_packages(folder: &Path, packages: &mut BTreeMap<String, Package>) {
    if let Ok(text) = fs::read_to_string(folder.join("Cargo.toml")) {
        let manifest: toml::Table = toml::from_str(&text).unwrap();
        if let Some(name) = manifest.get("package").and_then(|package| package["name"].as_str()) {
            packages.insert(name.to_owned(), package(folder, &manifest));
        }
    }
    for inner in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let name = inner.file_name().unwrap().to_string_lossy();
        if inner.is_dir() && !name.starts_with('.') && !["target", "node_modules", "src"].contains(&&*name) {
            add_packages(&inner, packages);
        }
    }
}

fn package(folder: &Path, manifest: &toml::Table) -> Package {
    let every_target = manifest.get("target").and_then(toml::Value::as_table).into_iter().flat_map(toml::Table::values);
    let tables = [manifest.get("dependencies")].into_iter().chain(every_target.map(|one| one.get("dependencies")));
    let names = tables.flatten().filter_map(toml::Value::as_table).flat_map(toml::Table::keys);
    let mut code = String::new();
    add_code(&folder.join("src"), &mut code);
    Package {
        dependencies: names.cloned().collect(),
        has_program: manifest.contains_key("bin") || folder.join("src/main.rs").exists(),
        code,
    }
}

/// Adds the sources below a folder, without comments, files of tests, and a file's own tests at its end.
fn add_code(folder: &Path, code: &mut String) {
    for path in fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
        if path.file_stem().is_some_and(|stem| stem == "tests") {
            continue;
        }
        if path.is_dir() {
            add_code(&path, code);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            let lines = text.lines().take_while(|line| *line != "mod tests {");
            lines.filter(|line| !line.trim_start().starts_with("//")).for_each(|line| {
                code.push_str(line);
                code.push('\n');
            });
        }
    }
}

/// Whether the code has a path that begins with the crate's name.
fn names_crate(code: &str, dependency: &str) -> bool {
    let path = format!("{}::", dependency.replace('-', "_"));
    let is_part_of_name = |character: char| character.is_alphanumeric() || character == '_' || character == ':';
    code.match_indices(&path).any(|(at, _)| !code[..at].ends_with(is_part_of_name))
}

/// The packages that the programs are made of.
fn in_programs(packages: &BTreeMap<String, Package>) -> BTreeSet<&str> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&str> = packages.iter().filter(|(_, one)| one.has_program).map(|(name, _)| &**name).collect();
    while let Some(name) = open.pop() {
        if let Some(package) = packages.get(name)
            && found.insert(name)
        {
            open.extend(package.dependencies.iter().map(String::as_str));
        }
    }
    found
}

#[test]
fn each_shared_crate_is_used_where_the_list_says_by_something_that_runs() {
    let packages = packages();
    let in_programs = in_programs(&packages);
    for (dependency, expected) in USES {
        let uses = |name: &&str| names_crate(&packages[*name].code, dependency);
        let depending: Vec<&str> =
            packages.iter().filter(|(_, one)| one.dependencies.contains(dependency)).map(|(name, _)| &**name).collect();
        let unused: Vec<&&str> = depending.iter().filter(|name| !uses(name)).collect();
        assert!(unused.is_empty(), "the manifests of {unused:?} name {dependency}, and their sources do not use it");
        let running: Vec<&str> = depending.into_iter().filter(|name| in_programs.contains(name)).collect();
        assert_eq!(running, expected, "packages of programs that use {dependency}: `USES` says where");
    }
}
