//! No source opens or writes files except through the crates for it.

use std::fs;
use std::path::{Path, PathBuf};

use crate::processes::repository;

/// Functions of Rust that create, change, remove or read a file. `host/lab/src/input` opens files with a size limit.
const CALLS: [&str; 16] = [
    "File::open",
    "fs::read(",
    "fs::read_to_string",
    "File::create",
    ".write(true)",
    ".append(true)",
    ".create_new(true)",
    "fs::write",
    "fs::rename",
    "fs::copy",
    "fs::remove_file",
    "fs::hard_link",
    "NamedTempFile",
    "WavWriter::create",
    "Writer::from_path",
    "SVGBackend::new",
];
/// Functions of Python that create, change or remove a file.
const CALLS_IN_PYTHON: [&str; 9] = [
    ".write_text(",
    ".write_bytes(",
    ".open(\"w",
    ".open(\"x",
    "os.replace",
    "os.rename",
    ".unlink(",
    "shutil",
    "tempfile",
];

/// The log of an experiment's trials is exempt: lines are appended to it, and a line that was cut off is removed.
#[test]
fn only_one_crate_writes_files_and_one_module_reads_them() {
    let host = repository().join("host");
    let (mut files, mut found) = (Vec::new(), Vec::new());
    for of in fs::read_dir(&host).unwrap().map(|entry| entry.unwrap().path()).filter(|of| !of.ends_with("files")) {
        source_files(&of.join("src"), "rs", &mut files);
    }
    source_files(&host.join("python/python"), "py", &mut files);
    for file in &files {
        let is_python = file.extension().is_some_and(|extension| extension == "py");
        let words = if is_python { &CALLS_IN_PYTHON[..] } else { &CALLS };
        let text = fs::read_to_string(file).unwrap();
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        found.extend(
            words.iter().filter(|word| code.contains(**word)).map(|word| format!("{}: {word}", file.display())),
        );
    }
    assert!(files.len() > 150, "{} files", files.len());
    assert!(found.is_empty(), "go through `host/files` or `host/lab/src/input`: {found:?}");
}

/// The files below a folder whose names have this end, without tests.
fn source_files(folder: &Path, extension: &str, files: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
        if path.ends_with("tests") || path.ends_with("tests.rs") {
            continue;
        }
        if path.is_dir() {
            source_files(&path, extension, files);
        } else if path.extension().is_some_and(|found| found == extension) {
            files.push(path);
        }
    }
}
