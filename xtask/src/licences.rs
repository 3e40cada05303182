//! The licences of everything that the studio's page carries: frixel's own, those of the vendored scripts, and those of
//! the crates inside the WebAssembly module.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::command::{WASM, cargo_in, root, text_of};

/// The crate that the module is made of.
const MODULE: &str = "frixel-studio";
/// frixel's own licences, and those of the vendored scripts.
pub(crate) const FILES: [&str; 3] = ["LICENSE-MIT", "LICENSE-APACHE", "host/studio/vendor/LICENCES.txt"];
/// A line between two licences.
const RULE: &str = "------------------------------------------------------------------------------";
/// How the names of licence files begin, in lower case.
const FILE_STARTS: [&str; 5] = ["license", "licence", "copying", "unlicense", "notice"];

/// All licences as one text.
pub(crate) fn text() -> Result<String, String> {
    let [mit, apache, vendored] = FILES.map(|name| read(&root().join(name)));
    let parts = [
        format!("frixel (MIT OR Apache-2.0)\n\n{}\n{RULE}\n{}", mit?, apache?),
        format!("SCRIPTS IN THE PAGE\n\n{}", vendored?),
        format!("CRATES IN THE MODULE\n\nRust's standard library (MIT OR Apache-2.0)\n\n{}", crates()?),
    ];
    Ok(parts.join(&format!("\n{RULE}\n\n")))
}

/// The licences of the module's crates: each text once, below the names of the crates that have it.
fn crates() -> Result<String, String> {
    let metadata = text_of(cargo_in(".").args(["metadata", "--locked", "--format-version", "1"]))?;
    let metadata: serde_json::Value =
        serde_json::from_str(&metadata).map_err(|error| format!("cargo metadata: {error}"))?;
    let packages = metadata["packages"].as_array().ok_or("cargo metadata names no packages")?;
    let in_module = in_module()?;
    let mut names: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in packages {
        let field = |name: &str| package[name].as_str().unwrap_or_default();
        let name = format!("{} {}", field("name"), field("version"));
        if !in_module.contains(&name) || package["source"].is_null() {
            continue;
        }
        let folder = Path::new(field("manifest_path")).parent().unwrap_or(Path::new("."));
        let title = format!("{name} ({})", field("license"));
        for text in texts(folder).map_err(|error| format!("{title}: {error}"))? {
            names.entry(text).or_default().push(title.clone());
        }
    }
    let sections = names.iter().map(|(text, names)| format!("{}\n\n{text}\n", names.join("\n")));
    Ok(sections.collect::<Vec<_>>().join(&format!("{RULE}\n\n")))
}

/// Name and version of each crate that is compiled into the module.
fn in_module() -> Result<BTreeSet<String>, String> {
    let kinds = ["--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"];
    let tree = text_of(cargo_in(".").args(["tree", "--locked", "--package", MODULE, "--target", WASM]).args(kinds))?;
    let words = tree.lines().map(|line| line.split_whitespace());
    Ok(words.filter_map(|mut words| Some(format!("{} {}", words.next()?, words.next()?.strip_prefix('v')?))).collect())
}

/// The licence texts in the folder of a crate, and in its folder of licences; an error if there is none.
fn texts(folder: &Path) -> Result<Vec<String>, String> {
    let named = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        FILE_STARTS.iter().any(|start| name.starts_with(start))
    };
    let found: Vec<PathBuf> = paths(folder)?.into_iter().filter(named).collect();
    let mut files: Vec<PathBuf> = found.iter().filter(|path| path.is_file()).cloned().collect();
    for below in found.iter().filter(|path| path.is_dir()) {
        files.extend(paths(below)?);
    }
    if files.is_empty() {
        return Err(format!("no licence file in {}", folder.display()));
    }
    files.iter().map(|path| read(path)).collect()
}

/// What a folder contains, sorted.
fn paths(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    Ok(paths)
}

fn read(path: &Path) -> Result<String, String> {
    let text = fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(text.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_crate_of_the_module_has_a_licence_text() {
        let text = text().unwrap();
        for name in in_module().unwrap() {
            let is_own = name.starts_with("frixel");
            assert!(is_own || text.contains(&format!("{name} (")), "{name}");
        }
        for expected in ["frixel (MIT OR Apache-2.0)", "uplot ", "@codemirror/view ", "Apache License", "heapless 0"] {
            assert!(text.contains(expected), "{expected}");
        }
    }
}
