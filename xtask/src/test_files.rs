//! Every file of tests belongs to a test program. The files of `tests` are modules of few programs, which cargo does
//! not look for by itself, so a file that no program names would never run. And every file that a document names
//! exists.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{root, text_of};

/// The folders of the workspace's packages.
fn packages() -> Vec<PathBuf> {
    let text = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let manifest: toml::Table = toml::from_str(&text).unwrap();
    let members = manifest["workspace"]["members"].as_array().unwrap().iter();
    members.map(|folder| root().join(folder.as_str().unwrap())).collect()
}

/// The files of the repository that match a pattern of git.
fn files(pattern: &str) -> Vec<PathBuf> {
    let mut git = Command::new("git");
    git.current_dir(root()).args(["ls-files", "--cached", "--others", "--exclude-standard", pattern]);
    let files = text_of(&mut git).unwrap();
    files.lines().map(|file| root().join(file)).filter(|file| file.is_file()).collect()
}

#[test]
fn every_file_of_tests_belongs_to_a_test_program() {
    let sources = files("*.rs");
    for folder in packages() {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        let manifest: toml::Table = toml::from_str(&manifest).unwrap();
        if manifest["package"].get("autotests").is_none() {
            continue;
        }
        let programs = manifest["test"].as_array().unwrap().iter();
        let programs: Vec<PathBuf> = programs.map(|test| folder.join(test["path"].as_str().unwrap())).collect();
        let modules: Vec<PathBuf> = programs.iter().flat_map(|program| modules_of(program)).collect();
        let is_test = |file: &PathBuf| file.starts_with(folder.join("tests")) && !programs.contains(file);
        for file in sources.iter().filter(|file| is_test(file)) {
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

/// The folders of the repository that documents name.
const TOPS: [&str; 8] = ["docs", "firmware", "fuzz", "hardware", "hil-sim", "host", "model", "xtask"];

/// The documents of the repository, and their texts: no texts that tests compare, nothing that others wrote.
fn pages() -> Vec<(PathBuf, String)> {
    let mut files = files("*.md");
    files.retain(|file| !file.iter().any(|part| part == "corpus"));
    files.into_iter().map(|file| (file.clone(), fs::read_to_string(file).unwrap())).collect()
}

/// Names in backticks that begin with a folder of the repository.
#[test]
fn every_file_that_a_document_names_exists() {
    let mut count = 0;
    for (document, text) in pages() {
        for name in text.split('`') {
            let name = name.split("::").next().unwrap_or_default();
            let is_path = name.split_once('/').is_some_and(|(top, _)| TOPS.contains(&top));
            if is_path && !name.contains(['*', ' ', '\n']) && !name.contains("KIND") && !name.contains("/target/") {
                assert!(root().join(name).exists(), "{} names {name}, which does not exist", document.display());
                count += 1;
            }
        }
    }
    assert!(count > 100, "{count}");
}

/// The architecture also names sources by the ends of their paths, such as `pins.mjs`.
#[test]
fn every_source_that_the_architecture_names_exists() {
    let page = fs::read_to_string(root().join("docs/inside/architecture.md")).unwrap();
    let mut count = 0;
    for ending in ["rs", "mjs", "js", "ts", "py"] {
        let files = files(&format!("*.{ending}"));
        let is_name = |name: &&str| name.ends_with(&format!(".{ending}")) && !name.contains(['*', ' ', '\n']);
        for name in page.split('`').filter(is_name).filter(|name| !name.contains("KIND")) {
            assert!(
                files.iter().any(|file| file.ends_with(name)),
                "architecture.md names {name}, which does not exist"
            );
            count += 1;
        }
    }
    assert!(count > 50, "{count}");
}

/// All documents together have at most 400 kB, and no line above 160 characters but in tables.
#[test]
fn documents_are_short() {
    let mut bytes = 0;
    for (file, text) in pages() {
        bytes += text.len();
        let long = text.lines().find(|line| !line.starts_with('|') && line.chars().count() > 160);
        assert!(long.is_none(), "{}: more than 160 characters: {}", file.display(), long.unwrap_or_default());
    }
    assert!(bytes <= 400_000, "{bytes}");
}

/// Links of pages to files of the repository, and to headings in them.
#[test]
fn every_link_of_a_document_leads_to_a_file_and_a_heading() {
    let mut count = 0;
    for (document, text) in pages() {
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if link.contains("://") {
                continue;
            }
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            let file = if path.is_empty() { document.clone() } else { document.with_file_name(path) };
            assert!(file.exists(), "{} links to {link}, which does not exist", document.display());
            let has_anchor =
                anchor.is_empty() || anchors(&fs::read_to_string(&file).unwrap()).iter().any(|name| name == anchor);
            assert!(has_anchor, "{} links to {link}, which is not a heading there", document.display());
            count += 1;
        }
    }
    assert!(count > 200, "{count}");
}

/// The anchors of a page's headings, as GitHub makes them. A line in a code fence is not a heading.
fn anchors(text: &str) -> Vec<String> {
    let mut is_code = false;
    let mut found = Vec::new();
    for line in text.lines() {
        is_code ^= line.trim_start().starts_with("```");
        if !is_code && line.starts_with('#') {
            let words = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
            found
                .push(words.chars().filter(|letter| letter.is_alphanumeric() || ['-', '_'].contains(letter)).collect());
        }
    }
    found
}

#[test]
fn a_comment_in_a_code_fence_is_no_heading() {
    assert_eq!(anchors("# A page\n```sh\n# builds it\n```\n## Next, `x_y`\n"), ["a-page", "next-x_y"]);
}
