//! Standard output, pipes and devices.

use std::fs::{self, File, OpenOptions};
use std::io::{Read, Seek};
use std::process::{Command, Stdio};
use std::thread;

use super::{Folder, answered, ran};

/// Commands that write one file, with its name at the end.
const LINES: [&str; 3] =
    ["model eval --input points.csv --output ", "model invert --input frictions.csv --output ", "fit data.csv -o "];

#[test]
fn a_dash_and_the_name_of_standard_output_are_standard_output() {
    for line in LINES {
        let folder = Folder::new();
        assert_eq!(folder.run(&format!("{line}file")).code, Some(0));
        let expected = folder.text("file");
        for name in ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
            let before = folder.names();
            let ran = folder.run(&format!("{line}{name}"));
            assert_eq!(ran.code, Some(0), "{line}{name}: {}", ran.notes);
            assert!(ran.said == expected, "{line}{name}: {}", ran.said);
            assert_eq!(folder.names(), before, "{line}{name}");
        }
    }
}

#[test]
fn a_log_that_standard_output_is_appended_to_keeps_its_lines() {
    for line in LINES {
        let folder = Folder::new();
        folder.write("log", "earlier\n");
        let mut log = OpenOptions::new().append(true).read(true).open(folder.path("log")).unwrap();
        let mut command = folder.command(&format!("{line}/dev/stdout"));
        assert_eq!(answered(command.stdout(log.try_clone().unwrap())).code, Some(0));
        log.rewind().unwrap();
        let mut text = String::new();
        log.read_to_string(&mut text).unwrap();
        assert!(text.starts_with("earlier\n") && text.len() > 20, "{line}: {text}");
        assert_eq!(folder.text("log"), text, "the name still leads to the file");
    }
}

#[test]
fn a_pipe_is_written_and_stays_a_pipe() {
    let preview = "scene preview scene.toml -o ";
    for line in LINES.into_iter().chain([preview]) {
        let folder = Folder::new();
        assert_eq!(folder.run(&format!("{line}file.png")).code, Some(0));
        let pipe = folder.path("pipe.png");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = thread::spawn({
            let pipe = pipe.clone();
            move || fs::read(pipe).unwrap()
        });
        let ran = folder.run(&format!("{line}pipe.png"));
        assert_eq!(ran.code, Some(0), "{line}: {}", ran.notes);
        assert!(reader.join().unwrap() == folder.read("file.png").unwrap(), "{line}");
        assert!(std::os::unix::fs::FileTypeExt::is_fifo(&fs::metadata(&pipe).unwrap().file_type()), "{line}");
    }
}

#[test]
fn devices_are_written_and_stay() {
    for line in LINES {
        let folder = Folder::new();
        assert_eq!(folder.run(&format!("{line}/dev/null")).code, Some(0), "{line}");
        let ran = folder.run(&format!("{line}/dev/full"));
        assert!(ran.code == Some(1) && ran.notes.contains("/dev/full"), "{line}: {}", ran.notes);
    }
}

/// Who reads the old file while it is replaced reads it to its end.
#[test]
fn a_reader_of_the_old_file_reads_it_to_its_end() {
    let folder = Folder::new();
    folder.write("map.png", "the old one");
    let mut reader = File::open(folder.path("map.png")).unwrap();
    assert_eq!(folder.run("scene preview scene.toml -o map.png").code, Some(0));
    let mut text = String::new();
    reader.read_to_string(&mut text).unwrap();
    assert_eq!(text, "the old one");
    assert!(folder.read("map.png").unwrap().starts_with(b"\x89PNG"));
}

/// A result goes where a symbolic link leads, and keeps the permissions of what it replaces.
#[test]
fn links_and_permissions_stay() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
    let folder = Folder::new();
    folder.write("kept/map.png", "old");
    fs::set_permissions(folder.path("kept/map.png"), fs::Permissions::from_mode(0o640)).unwrap();
    symlink("kept/map.png", folder.path("map.png")).unwrap();
    symlink("kept/new.png", folder.path("new.png")).unwrap();
    for name in ["map.png", "new.png"] {
        assert_eq!(folder.run(&format!("scene preview scene.toml -o {name}")).code, Some(0));
        assert!(fs::symlink_metadata(folder.path(name)).unwrap().is_symlink());
        assert!(folder.read(&format!("kept/{name}")).unwrap().starts_with(b"\x89PNG"));
    }
    assert_eq!(fs::metadata(folder.path("kept/map.png")).unwrap().mode() & 0o777, 0o640);
    // A new file has the permissions that others have.
    folder.write("plain", "");
    let mode = |name: &str| fs::metadata(folder.path(name)).unwrap().mode() & 0o777;
    assert_eq!(mode("kept/new.png"), mode("plain"));
}

#[test]
fn a_reader_that_goes_away_ends_a_stream_of_rows() {
    let folder = Folder::new();
    let mut command = folder.command("model eval --input /dev/stdin");
    let mut child = command.stdin(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    drop(child.stdin.take());
    let output = ran(&child.wait_with_output().unwrap());
    assert!(!output.notes.contains("panicked"), "{}", output.notes);
}
