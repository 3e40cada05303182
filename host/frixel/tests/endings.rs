//! Inputs without an end are refused, and lists of mistakes end.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::Path;

use crate::processes::{run, said};
use rustix::fs::{CWD, FileType, Mode, mknodat};
use tempfile::TempDir;

const SCENE: &str = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n";

fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    folder
}

fn pipe(path: &Path) {
    mknodat(CWD, path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).unwrap();
}

#[test]
fn a_pipe_or_a_device_in_place_of_a_file_is_one_sentence() {
    let folder = folder();
    let path = folder.path();
    pipe(&path.join("pipe"));
    pipe(&path.join("pipe.toml"));
    let with = |line: &str| format!("version = 1\n{line}\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n");
    fs::write(path.join("include.toml"), with("include = [\"pipe.toml\"]")).unwrap();
    fs::write(path.join("zero.toml"), with("include = [\"/dev/zero\"]")).unwrap();
    fs::write(path.join("finger.toml"), with("finger = \"pipe.toml\"")).unwrap();
    let bitmap =
        "version = 1\n[[layer]]\nkind = \"bitmap\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 50\nblack_n = 0.3\nwhite_n = 0.4\n";
    fs::write(path.join("picture.toml"), format!("{bitmap}picture = \"pipe\"\n")).unwrap();
    for (arguments, what) in [
        (&["play", "pipe"][..], "pipe"),
        (&["play", "/dev/zero"], "device"),
        (&["check", "pipe"], "pipe"),
        (&["check", "include.toml"], "pipe"),
        (&["check", "zero.toml"], "device"),
        (&["check", "finger.toml"], "pipe"),
        (&["check", "picture.toml"], "pipe"),
        (&["play", "scene.toml", "--stroke", "pipe"], "pipe"),
        (&["play", "scene.toml", "--finger", "pipe"], "pipe"),
        (&["sim", "--stroke", "pipe"], "pipe"),
        (&["sim", "--finger", "pipe"], "pipe"),
        (&["finger", "fit", "pipe"], "pipe"),
        (&["model", "eval", "--input", "pipe"], "pipe"),
        (&["finger", "calibrate", "--port", "sim", "--forces", "pipe", "-o", "data.csv"], "pipe"),
        (&["new", "wood", "--picture", "pipe"], "pipe"),
        (&["studio", "--no-browser", "--page", "pipe"], "pipe"),
    ] {
        let output = run(path, arguments);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.contains(&format!("it is a {what}, and a regular file is expected")), "{arguments:?}: {said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{arguments:?}: {said}");
    }
}

#[test]
fn a_file_of_8_gb_is_refused_with_both_numbers() {
    let folder = folder();
    let path = folder.path();
    for name in ["big.csv", "big.toml", "big.wav", "big.png"] {
        File::create(path.join(name)).unwrap().set_len(8_000_000_000).unwrap();
    }
    let stream = "version = 1\n[[layer]]\nkind = \"stream\"\nlow_n = 0.3\nhigh_n = 0.4\n";
    fs::write(path.join("stream.toml"), stream).unwrap();
    for arguments in [
        &["play", "big.toml"][..],
        &["play", "scene.toml", "--stroke", "big.csv"],
        &["play", "stream.toml", "--stream", "big.wav"],
        &["finger", "fit", "big.csv"],
        &["model", "eval", "--input", "big.csv"],
        &["new", "wood", "--picture", "big.png"],
    ] {
        let output = run(path, arguments);
        let said = said(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.contains("it has 8000000000 bytes, and at most "), "{arguments:?}: {said}");
    }
}

#[test]
fn a_list_of_mistakes_stops_at_100() {
    let folder = folder();
    let mut scene = "version = 1\n".to_owned();
    for layer in 0..4_000 {
        writeln!(scene, "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\nwrong_{layer} = 1").unwrap();
    }
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let said = said(&run(folder.path(), &["check", "scene.toml"]));
    assert_eq!(said.lines().count(), 101, "{}", said.lines().take(5).collect::<String>());
    assert!(said.lines().last().unwrap().contains("these are 100 mistakes, and there are more"), "{said}");
    let output = run(folder.path(), &["check", "scene.toml", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((json["mistakes"].as_array().unwrap().len(), json["has_more"].as_bool()), (100, Some(true)));
}
