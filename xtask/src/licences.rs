//! The licences of everything that is handed on: frixel's own, those of the page's vendored scripts, and those of the
//! crates inside of programs.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::command::{self, WASM, cargo_in, entries, root, text_of};

/// A program that crates are compiled into.
#[derive(Clone, Copy)]
pub(crate) struct Program {
    /// The folder of its workspace.
    pub(crate) folder: &'static str,
    /// Its package, if it is not that of the folder.
    pub(crate) package: Option<&'static str>,
    /// Compiler target; `None` for this machine.
    pub(crate) target: Option<&'static str>,
    /// Features, as arguments of cargo; none for the default ones.
    pub(crate) features: &'static [&'static str],
}

/// The WebAssembly module of the page.
pub(crate) const PAGE: Program =
    Program { folder: ".", package: Some("frixel-studio"), target: Some(WASM), features: &[] };
/// The licence of the C library in static programs, from its file COPYRIGHT.
const MUSL_LICENCE: &str = "musl, the C library in the command (MIT)\n\nCopyright © 2005-2020 Rich Felker, et al.\n\n\
                            The text is that of frixel's MIT licence, with this line in place of its copyright.";
/// The licence of crates by Raspberry Pi, whose packages have no file of it, and whose copyright their sources state.
const BSD: &str = "BSD-3-Clause";
const BSD_COPYRIGHT: &str = "Copyright (c) Raspberry Pi (Trading) Ltd.";
const BSD_TEXT: &str = include_str!("bsd-3-clause.txt");
/// frixel's own licences, and those of the vendored scripts.
const FILES: [&str; 3] = ["LICENSE-MIT", "LICENSE-APACHE", "host/studio/vendor/LICENCES.txt"];
/// A line between two licences.
const RULE: &str = "------------------------------------------------------------------------------";
/// How the names of licence files begin, in lower case.
const FILE_STARTS: [&str; 5] = ["license", "licence", "copying", "unlicense", "notice"];

/// All licences of the page as one text.
pub(crate) fn text() -> Result<String, String> {
    Ok(joined(&[own()?, scripts()?, crates("CRATES IN THE MODULE", &[PAGE])?]))
}

/// All licences of these programs, of the page's scripts, of the C library, and of the emulator, which has this one.
pub(crate) fn of_dist(programs: &[Program], emulator: String) -> Result<String, String> {
    Ok(joined(&[own()?, scripts()?, emulator, MUSL_LICENCE.to_owned(), crates("CRATES IN THE PROGRAMS", programs)?]))
}

/// All licences of the Python module, which is made of these programs and of the page's scripts.
pub(crate) fn of_wheel(programs: &[Program]) -> Result<String, String> {
    Ok(joined(&[own()?, scripts()?, crates("CRATES IN THE MODULE", programs)?]))
}

fn joined(parts: &[String]) -> String {
    parts.join(&format!("\n{RULE}\n\n"))
}

fn own() -> Result<String, String> {
    let [mit, apache, _] = FILES.map(|name| read(&root().join(name)));
    Ok(format!("frixel (MIT OR Apache-2.0)\n\n{}\n{RULE}\n{}", mit?, apache?))
}

fn scripts() -> Result<String, String> {
    let [.., vendored] = FILES.map(|name| read(&root().join(name)));
    Ok(format!("SCRIPTS IN THE PAGE\n\n{}", vendored?))
}

/// The licences of the programs' crates below a title: each text once, below the names of the crates that have it.
fn crates(title: &str, programs: &[Program]) -> Result<String, String> {
    let mut names = BTreeMap::new();
    for program in programs {
        add_crates(program, &mut names)?;
    }
    let sections = names.iter().map(|(text, names): (&String, &BTreeSet<String>)| {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        format!("{}\n\n{text}\n", names.join("\n"))
    });
    let sections = sections.collect::<Vec<_>>().join(&format!("{RULE}\n\n"));
    Ok(format!("{title}\n\nRust's standard library (MIT OR Apache-2.0)\n\n{sections}"))
}

/// Adds the licence texts of a program's crates, each with the names of the crates that have it.
fn add_crates(program: &Program, names: &mut BTreeMap<String, BTreeSet<String>>) -> Result<(), String> {
    let metadata = text_of(cargo_in(program.folder).args(["metadata", "--locked", "--format-version", "1"]))?;
    let metadata: serde_json::Value =
        serde_json::from_str(&metadata).map_err(|error| format!("cargo metadata: {error}"))?;
    let packages = metadata["packages"].as_array().ok_or("cargo metadata lists no packages")?;
    let in_module = compiled(program)?;
    for package in packages {
        let field = |name: &str| package[name].as_str().unwrap_or_default();
        let name = format!("{} {}", field("name"), field("version"));
        if !in_module.contains(&name) || package["source"].is_null() {
            continue;
        }
        let folder = Path::new(field("manifest_path")).parent().unwrap_or(Path::new("."));
        let title = format!("{name} ({})", field("license"));
        let mut found = texts(folder).map_err(|error| format!("{title}: {error}"))?;
        if found.is_empty() {
            found.push(
                without_file(package).ok_or_else(|| format!("{title}: no licence file in {}", folder.display()))?,
            );
        }
        for text in found {
            names.entry(text).or_default().insert(title.clone());
        }
    }
    Ok(())
}

/// What is said of a crate without a licence file, if its licence is one of frixel's, whose texts stand above, or that
/// of the crates by Raspberry Pi.
fn without_file(package: &serde_json::Value) -> Option<String> {
    let is_by_raspberry_pi = package["name"].as_str().is_some_and(|name| name.starts_with("rp"));
    if is_by_raspberry_pi && package["license"] == BSD {
        return Some(format!("{BSD_COPYRIGHT}\n\n{BSD_TEXT}"));
    }
    let licence =
        package["license"].as_str().filter(|licence| ["MIT", "Apache-2.0"].iter().any(|own| licence.contains(own)))?;
    let authors: Vec<&str> = package["authors"].as_array()?.iter().filter_map(serde_json::Value::as_str).collect();
    let by = if authors.is_empty() { "its authors".to_owned() } else { authors.join(", ") };
    Some(format!("Its package has no licence file. Its manifest says {licence}, by {by}; the texts stand above."))
}

/// Name and version of each crate that is compiled into a program.
fn compiled(program: &Program) -> Result<BTreeSet<String>, String> {
    let kinds = ["--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"];
    let mut tree = cargo_in(program.folder);
    tree.args(["tree", "--locked"]).args(kinds);
    tree.args(program.package.iter().flat_map(|package| ["--package", package]));
    tree.args(program.target.iter().flat_map(|target| ["--target", target]));
    tree.args(program.features);
    let tree = text_of(&mut tree)?;
    let words = tree.lines().map(|line| line.split_whitespace());
    Ok(words.filter_map(|mut words| Some(format!("{} {}", words.next()?, words.next()?.strip_prefix('v')?))).collect())
}

/// The licence texts in the folder of a crate, and in its folder of licences.
fn texts(folder: &Path) -> Result<Vec<String>, String> {
    let named = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        FILE_STARTS.iter().any(|start| name.starts_with(start))
    };
    let found: Vec<PathBuf> = entries(folder)?.into_iter().filter(named).collect();
    let mut files: Vec<PathBuf> = found.iter().filter(|path| path.is_file()).cloned().collect();
    for below in found.iter().filter(|path| path.is_dir()) {
        files.extend(entries(below)?);
    }
    files.iter().map(|path| read(path)).collect()
}

fn read(path: &Path) -> Result<String, String> {
    Ok(command::text(path)?.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Their manifests say BSD-3-Clause, which is not one of frixel's licences.
    #[test]
    fn crates_by_raspberry_pi_have_the_text_of_their_licence() {
        let of = |name: &str, license: &str| without_file(&serde_json::json!({ "name": name, "license": license }));
        let text = of("rp-pac", "BSD-3-Clause").unwrap();
        assert!(text.starts_with("Copyright (c) Raspberry Pi") && text.contains("Redistributions in binary form"));
        assert_eq!((of("other", "BSD-3-Clause"), of("rp-pac", "GPL-2.0")), (None, None));
    }

    #[test]
    fn each_crate_of_the_module_has_a_licence_text() {
        let text = text().unwrap();
        for name in compiled(&PAGE).unwrap() {
            let is_own = name.starts_with("frixel");
            assert!(is_own || text.contains(&format!("{name} (")), "{name}");
        }
        for expected in ["frixel (MIT OR Apache-2.0)", "uplot ", "@codemirror/view ", "Apache License", "heapless 0"] {
            assert!(text.contains(expected), "{expected}");
        }
    }
}
