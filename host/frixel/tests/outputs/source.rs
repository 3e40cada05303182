//! No other way to a file.

use std::fs;
use std::path::Path;

use crate::processes::repository;

/// Functions that create, change or remove a file.
const WRITES: [&str; 13] = [
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

#[test]
fn only_one_module_writes_files() {
    let source = repository().join("host/frixel/src");
    let mut folders = vec![source.clone()];
    let (mut read, mut found) = (0, Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(&source).unwrap();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs")
                && !name.starts_with("output_file")
                && !name.components().any(|part| part.as_os_str() == "tests")
                && !name.ends_with("tests.rs")
            {
                read += 1;
                found.extend(writes(&path).into_iter().map(|word| format!("{}: {word}", name.display())));
            }
        }
    }
    assert!(read > 50, "{read} files");
    assert!(found.is_empty(), "go through `output_file`: {found:?}");
}

/// The words in a file before its tests.
fn writes(path: &Path) -> Vec<&'static str> {
    let text = fs::read_to_string(path).unwrap();
    let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
    WRITES.into_iter().filter(|word| code.contains(word)).collect()
}
