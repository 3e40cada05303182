//! Where the simulated finger goes.

use std::fs;

use tempfile::TempDir;

use super::{frixel, scene, succeed};

/// Columns of a felt.csv, row by row.
fn rows(folder: &TempDir) -> Vec<Vec<String>> {
    let text = fs::read_to_string(folder.path().join("frixel-out/felt.csv")).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn number(rows: &[Vec<String>], row: usize, column: usize) -> f64 {
    rows[row][column].parse().unwrap()
}

#[test]
fn a_straight_stroke_goes_back_and_forth_at_its_speed() {
    let folder = TempDir::new().unwrap();
    let brick = scene("brick.toml");
    let from = ["play", &brick, "--from", "20,40", "--to", "100,40", "--speed", "200"];
    succeed(folder.path(), &from);
    let once = rows(&folder);
    assert_eq!(once.len(), 400);
    assert!((number(&once, 199, 1) - 60.0).abs() < 0.01 && (number(&once, 199, 3) - 200.0).abs() < 1e-6);

    succeed(folder.path(), &[&from[..], &["--times", "3"]].concat());
    let thrice = rows(&folder);
    assert_eq!(thrice.len(), 1200);
    for (row, x_mm) in [(99, 40.0), (399, 100.0), (499, 80.0), (799, 20.0), (899, 40.0), (1199, 100.0)] {
        assert!((number(&thrice, row, 1) - x_mm).abs() < 0.01, "row {row}: {}", number(&thrice, row, 1));
    }

    succeed(folder.path(), &[&from[..], &["--times", "2", "--minimum-jerk"]].concat());
    let curved = rows(&folder);
    assert_eq!(curved.len(), 800);
    // A stroke of minimum jerk begins at rest, and is 1.875 times as fast as on average in its middle.
    assert!(number(&curved, 2, 3) < 10.0 && (number(&curved, 599, 3) - 375.0).abs() < 1.0);

    // The name that the option had before.
    succeed(folder.path(), &[&from[..], &["--times", "2", "--natural"]].concat());
    assert_eq!(rows(&folder), curved);
}

#[test]
fn a_felt_csv_is_a_stroke_and_other_columns_are_named() {
    let folder = TempDir::new().unwrap();
    let brick = scene("brick.toml");
    succeed(folder.path(), &["play", &brick, "--from", "20,40", "--to", "100,40", "--csv-hz", "100"]);
    let felt = folder.path().join("felt.csv");
    fs::copy(folder.path().join("frixel-out/felt.csv"), &felt).unwrap();
    let (_, notes) = succeed(folder.path(), &["play", &brick, "--stroke", "felt.csv"]);
    assert!(!notes.contains("ignored"), "{notes}");
    assert!((number(&rows(&folder), 400, 1) - 60.1).abs() < 0.05);
    fs::write(folder.path().join("pen.csv"), "t_s,x_mm,y_mm,tilt\n0,10,10,3\n0.2,30,10,4\n").unwrap();
    let (_, notes) = succeed(folder.path(), &["play", &brick, "--stroke", "pen.csv"]);
    assert!(
        notes.contains("warning: pen.csv: ignored column tilt: a stroke has t_s, x_mm, y_mm and force_n"),
        "{notes}"
    );
}

#[test]
fn layers_that_were_never_touched_are_named() {
    let folder = TempDir::new().unwrap();
    let keyboard = scene("keyboard.toml");
    let (said, _) = succeed(folder.path(), &["play", &keyboard, "--from", "1,1", "--to", "3,1", "--speed", "20"]);
    assert!(said.contains("never touched") && said.contains("more copies"), "{said}");
    let (json, _) = succeed(folder.path(), &["play", &keyboard, "--seconds", "0.1", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(!json["untouched_layers"].as_array().unwrap().is_empty());
}

#[test]
fn a_stroke_that_makes_no_sense_is_explained() {
    let folder = TempDir::new().unwrap();
    let brick = scene("brick.toml");
    for (arguments, code, part) in [
        (&["--from", "20,40"][..], 2, "--to <X,Y>"),
        (&["--speed", "20"], 2, "--from <X,Y>"),
        (&["--from", "20;40", "--to", "1,1"], 2, "for example 12,34.5"),
        (&["--from", "20,40", "--to", "50,40", "--speed", "0"], 2, "above 0, at most 10000 mm/s"),
        (&["--from", "20,40", "--to", "50,40", "--times", "0"], 2, "1..=10000"),
        (&["--from", "20,40", "--to", "50,40", "--stroke", "a.csv"], 2, "cannot be used with"),
        (&["--from", "20,40", "--to", "20,40"], 1, "give two places that differ"),
        (&["--from", "320,40", "--to", "300,40"], 1, "nowhere on the screen"),
        (&["--from", "-5,40", "--to", "-1,40"], 1, "nowhere on the screen"),
        (&["--from", "--to", "1,1"], 2, "unexpected argument '1,1'"),
        (&["--from", "20,40", "--to", "100,40", "--speed", "0.001", "--times", "9"], 1, "longer than a day"),
    ] {
        let output = frixel(folder.path(), &[&["play", brick.as_str()], arguments].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(said.contains(part), "{arguments:?}: {said}");
    }
}
