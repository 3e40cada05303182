//! Where the simulated finger goes.

use std::fs;

use tempfile::TempDir;

use super::{scene, succeed};

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
}

#[test]
fn a_felt_csv_is_a_stroke() {
    let folder = TempDir::new().unwrap();
    let brick = scene("brick.toml");
    succeed(folder.path(), &["play", &brick, "--from", "20,40", "--to", "100,40", "--csv-hz", "100"]);
    let felt = folder.path().join("felt.csv");
    fs::copy(folder.path().join("frixel-out/felt.csv"), &felt).unwrap();
    let (_, notes) = succeed(folder.path(), &["play", &brick, "--stroke", "felt.csv"]);
    assert!(!notes.contains("ignored"), "{notes}");
    assert!((number(&rows(&folder), 400, 1) - 60.1).abs() < 0.05);
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
