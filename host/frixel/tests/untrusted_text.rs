//! Text that others wrote, in scenes, names of files and boards: nothing of it controls a terminal or spoils a file.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::process::Output;

use tempfile::TempDir;

use crate::processes::run;

/// Sets a terminal's title, clears it, forges a line, in C0 and C1, and turns the order of letters.
const HOSTILE: &str = "\u{1b}]0;owned\u{7}\u{1b}[2Jx\nforged: all is well\r\u{9b}2J\u{7f}\u{202e}";
/// The same as a TOML string.
const HOSTILE_TOML: &str = "\"\\u001b]0;owned\\u0007\\u001b[2Jx\\nforged: all is well\\r\\u009b2J\\u007f\\u202e\"";

/// What a command prints on both outputs, which has nothing that a terminal would do.
fn clean(output: &Output) -> String {
    let text = [&output.stdout[..], &output.stderr[..]].concat();
    let text = String::from_utf8(text).unwrap();
    let bad = |character: char| (character.is_control() && character != '\n') || character == '\u{202e}';
    assert!(!text.contains(bad), "{text:?}");
    assert!(!text.lines().any(|line| line.starts_with("forged")), "{text:?}");
    text
}

fn layer(line: &str) -> String {
    format!("version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n{line}\n")
}

#[test]
fn no_text_of_a_scene_controls_the_terminal() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("scene.toml");
    for text in [
        layer(&format!("name = {HOSTILE_TOML}")),
        layer(&format!("{HOSTILE_TOML} = 1")),
        layer(&format!("blend = {HOSTILE_TOML}")),
        format!("include = [{HOSTILE_TOML}]\n{}", layer("")),
        format!("finger = {HOSTILE_TOML}\n{}", layer("")),
        format!("screen = {HOSTILE_TOML}\n{}", layer("")),
        format!("{}[[layer]]\nkind = \"bitmap\"\npicture = {HOSTILE_TOML}\n", layer("")),
        format!("{}[[layer]]\nkind = {HOSTILE_TOML}\n", layer("")),
        format!("{}[{HOSTILE_TOML}]\n", layer("")),
        // As it stands, which is no TOML.
        layer(&format!("name = \"{HOSTILE}\"")),
        layer(HOSTILE),
    ] {
        fs::write(&path, &text).unwrap();
        for arguments in [
            &["check", "scene.toml"][..],
            &["check", "scene.toml", "--json"],
            &["play", "scene.toml", "--seconds", "0.05"],
            &["preview", "scene.toml", "-o", "map.png"],
        ] {
            let output = run(folder.path(), arguments);
            let printed = clean(&output);
            assert_eq!(output.status.code(), Some(1), "{arguments:?} of {text:?}: {printed}");
            if arguments.contains(&"--json") {
                serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap();
            }
        }
    }
}

#[test]
fn a_file_with_a_hostile_name_plays_and_spoils_nothing() {
    let folder = TempDir::new().unwrap();
    let name = "\u{1b}[2Jx\nforged <&>.toml";
    fs::write(folder.path().join(name), layer("")).unwrap();
    let output = run(folder.path(), &["play", name, "--seconds", "0.2"]);
    let printed = clean(&output);
    assert!(output.status.success(), "{printed}");
    let svg = fs::read_to_string(folder.path().join("frixel-out/felt.svg")).unwrap();
    assert!(!svg.contains(|character: char| character.is_control() && character != '\n'), "well-formed");
    assert!(svg.contains("\\u001b"), "the name is there, escaped");
}

#[test]
fn check_notes_the_files_outside_of_the_scene_s_folder() {
    let folder = TempDir::new().unwrap();
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).unwrap();
    fs::write(folder.path().join("outer.toml"), "version = 1\n").unwrap();
    fs::write(inner.join("own.toml"), "version = 1\n").unwrap();
    fs::write(inner.join("scene.toml"), format!("include = [\"../outer.toml\", \"own.toml\"]\n{}", layer(""))).unwrap();
    let printed = clean(&run(&inner, &["check", "scene.toml"]));
    let notes: Vec<&str> = printed.lines().filter(|line| line.contains("outside of the scene's folder")).collect();
    assert!(matches!(notes[..], [note] if note.contains("../outer.toml")), "{printed}");
}
