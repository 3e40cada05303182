//! Bundles `<frixel-scene>` and only the modules it needs into one script.

use std::collections::BTreeSet;
use std::path::{Component, Path};

use super::{Files, all_packed, boot};

/// Module of the element.
const MODULE: &str = "element/frixel_scene.js";
/// Files of the page, beside modules and scenes, that the element reads by their names, and the licences of all of it.
const READ: [&str; 5] = ["engine.wasm", "engine/", "styles/base.css", "styles/parts.css", "licences.txt"];
const SCENES: &str = "scenes/";
/// Endings of pictures.
const PICTURES: [&str; 2] = [".png", ".jpg"];
const TITLE: &str = "// <frixel-scene> of frixel: docs/design/studio.md says how to use it.";

/// A script for documents on a disk, with the pictures of the bundled scenes.
pub(super) fn script(files: &Files) -> Result<String, String> {
    joined(files, |_| true, None)
}

/// A script whose scenes bring their pictures with them.
pub(super) fn script_without_pictures(files: &Files) -> Result<String, String> {
    joined(files, |name| !is_picture(name), None)
}

/// An ES module for documents on a web server, where the pictures of the bundled scenes are in `scenes` beside it.
pub(super) fn module(files: &Files) -> Result<String, String> {
    joined(files, |name| !is_picture(name), Some("import.meta.url"))
}

/// The pictures that the module reads from beside it.
pub(super) fn pictures(files: &Files) -> impl Iterator<Item = (&String, &Vec<u8>)> {
    files.iter().filter(|(name, _)| is_picture(name))
}

fn is_picture(name: &str) -> bool {
    name.starts_with(SCENES) && PICTURES.iter().any(|ending| name.ends_with(ending))
}

/// The script that carries what the element uses, as far as `is_carried`; an expression of JavaScript gives the
/// `folder` of the rest. A document that has it already, as one with two
/// widgets, keeps the first.
fn joined(files: &Files, is_carried: impl Fn(&str) -> bool, folder: Option<&str>) -> Result<String, String> {
    let modules = modules(files, MODULE)?;
    let is_used = |name: &str| {
        modules.contains(name) || name.starts_with(SCENES) || READ.iter().any(|start| name.starts_with(start))
    };
    let carried = files.iter().filter(|(name, _)| is_used(name) && is_carried(name));
    let packed = all_packed(carried)?.to_string();
    let entry = format!("\"{MODULE}\"");
    let arguments: Vec<&str> = [packed.as_str(), &entry].into_iter().chain(folder).collect();
    let boot = boot(files, &arguments)?;
    Ok(format!("{TITLE}\nif (!globalThis.studio) (() => {{\n{boot}}})();\n"))
}

/// The names of a module and of all that it imports, itself or through others.
fn modules(files: &Files, entry: &str) -> Result<BTreeSet<String>, String> {
    let mut found = BTreeSet::new();
    let mut open = vec![entry.to_owned()];
    while let Some(name) = open.pop() {
        let content = files.get(&name).ok_or_else(|| format!("{name} is imported, and no file of the page"))?;
        open.extend(imports(&String::from_utf8_lossy(content), &name).filter(|import| !found.contains(import)));
        found.insert(name);
    }
    Ok(found)
}

/// The names of the files that a module imports. Those that it imports for their types alone stand in comments.
fn imports<'t>(text: &'t str, module: &'t str) -> impl Iterator<Item = String> + 't {
    let lines = text.lines().filter(|line| !line.contains("@import"));
    let paths = lines.filter_map(|line| line.split_once("from \"")?.1.split_once('"').map(|(path, _)| path));
    paths.filter(|path| path.starts_with('.')).map(move |path| beside(module, path))
}

/// The name of the file that a module calls `path`.
fn beside(module: &str, path: &str) -> String {
    let mut parts: Vec<&str> = module.split('/').collect();
    parts.pop();
    for part in Path::new(path).components() {
        match part {
            Component::ParentDir => drop(parts.pop()),
            Component::Normal(name) => parts.extend(name.to_str()),
            _ => {}
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(texts: &[(&str, &str)]) -> Files {
        texts.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec())).collect()
    }

    #[test]
    fn a_module_brings_what_it_imports_and_no_types() {
        let files = files(&[
            ("element/a.js", "import { b,\n  c } from \"../page/b.js\";\n/** @import { T } from \"./types.js\" */\n"),
            ("page/b.js", "export { c } from \"./c.js\";\n"),
            ("page/c.js", "import { b } from \"./b.js\";\n"),
            ("page/editor.js", ""),
        ]);
        let found = modules(&files, "element/a.js").unwrap();
        assert_eq!(found.into_iter().collect::<Vec<_>>(), ["element/a.js", "page/b.js", "page/c.js"]);
    }

    #[test]
    fn a_module_that_is_not_there_is_named() {
        let files = files(&[("a.js", "import \"x\"; import { b } from \"./b.js\";")]);
        assert_eq!(modules(&files, "a.js"), Err("b.js is imported, and no file of the page".to_owned()));
    }
}
