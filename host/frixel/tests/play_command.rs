//! `frixel play` as a person uses it: what it writes, and what it refuses of a scene. Other wrong input
//! stands in `corpus`.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

use tempfile::TempDir;

use crate::processes::{frixel, repository, succeed};

fn brick() -> String {
    repository().join("scenes/brick.toml").display().to_string()
}

#[test]
fn without_a_command_it_is_the_demo() {
    let folder = TempDir::new().unwrap();
    let said = succeed(folder.path(), &[]);
    for name in ["felt.csv", "felt.svg", "scene.png"] {
        let path = Path::new("frixel-out").join(name);
        assert!(said.contains(&path.display().to_string()), "{name} is not named in {said}");
        assert!(fs::metadata(folder.path().join(path)).unwrap().len() > 10_000);
    }
    let copy = folder.path().join("copy.toml");
    fs::copy(folder.path().join("frixel-out/brick.toml"), &copy).unwrap();
    fs::rename(folder.path().join("frixel-out/textures"), folder.path().join("textures")).unwrap();
    succeed(folder.path(), &["play", "copy.toml", "--seconds", "0.1"]);
}

/// Places of the finger in mm, a row a millisecond, in a play with the stroke of a person; `None` while it is up.
fn human_places(folder: &Path, hand: &str, seed: &str) -> Vec<Option<(f64, f64)>> {
    succeed(folder, &["play", &brick(), "--stroke", hand, "--seconds", "2", "--seed", seed]);
    let mut reader = csv::Reader::from_path(folder.join("frixel-out/felt.csv")).unwrap();
    let columns = ["x_mm", "y_mm"].map(|name| reader.headers().unwrap().iter().position(|cell| cell == name).unwrap());
    let place = |row: csv::StringRecord| {
        let [x, y] = columns.map(|column| (!row[column].is_empty()).then(|| row[column].parse::<f64>().unwrap()));
        x.zip(y)
    };
    reader.records().map(|row| place(row.unwrap())).collect()
}

#[test]
fn a_persons_stroke_stays_on_the_screen_and_every_seed_is_a_person() {
    let folder = TempDir::new().unwrap();
    let first = human_places(folder.path(), "human", "1");
    assert_eq!(first.len(), 2000);
    assert!(first.iter().flatten().all(|(x_mm, y_mm)| (0.0..120.0).contains(x_mm) && (0.0..110.0).contains(y_mm)));
    assert!(first.iter().flatten().count() > 1000, "the finger touches most of the time");
    assert_eq!(first, human_places(folder.path(), "human", "1"));
    assert_ne!(first, human_places(folder.path(), "human", "2"));
    assert_ne!(first, human_places(folder.path(), "human-rough", "1"));
}

#[test]
fn json_has_every_number_and_the_same_seed_the_same_bytes() {
    let folder = TempDir::new().unwrap();
    let play = |out: &str, seed: &str| {
        let arguments =
            ["play", &brick(), "--json", "--seconds", "0.5", "--csv-hz", "4000", "--out", out, "--seed", seed];
        let json = succeed(folder.path(), &arguments);
        (json, fs::read_to_string(folder.path().join(out).join("felt.csv")).unwrap())
    };
    let (json, first) = play("a", "7");
    let (_, second) = play("b", "7");
    let (_, third) = play("c", "8");
    assert!(first == second, "two runs of one seed differ");
    assert!(first != third, "the seed changes nothing");
    assert_eq!(first.lines().count(), 2001);

    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["rig"], "sim");
    assert_eq!(json["ticks"], 20_000);
    assert_eq!(json["frames_rejected"], 0, "no byte is late in virtual time");
    for key in [
        "friction_error_rms_n",
        "friction_error_max_n",
        "inversion_error_rms_n",
        "inversion_error_max_n",
        "slewing_ticks",
        "load_mismatch_rms_n",
        "load_mismatch_max_n",
        "carrier_ripple_rms_n",
        "reachable_min_n",
        "reachable_max_n",
        "reference_min_n",
        "reference_max_n",
        "saturated_ticks",
        "frames_sent",
        "frames_rejected",
        "payload_bytes",
        "wire_bytes",
        "realtime_factor",
    ] {
        assert!(json[key].is_number(), "{key}: {}", json[key]);
    }
    for key in ["stream_samples", "stream_underruns", "stream_gaps"] {
        assert!(json[key].is_null(), "{key}: {}", json[key]);
    }
}

/// A scene that adds 2 mN to the example finger's 250 mN everywhere.
const CONSTANT: &str = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_n = 0.252\n";

/// The JSON summary of a play of [`CONSTANT`].
fn play_constant(folder: &Path, options: &[&str]) -> serde_json::Value {
    fs::write(folder.join("constant.toml"), CONSTANT).unwrap();
    let play = ["play", "constant.toml", "--from", "10,40", "--to", "110,40", "--speed", "80", "--json"];
    serde_json::from_str(&succeed(folder, &[&play[..], options].concat())).unwrap()
}

fn number(json: &serde_json::Value, key: &str) -> f64 {
    json[key].as_f64().unwrap_or_else(|| panic!("{key}: {}", json[key]))
}

/// A finger that presses with 0.6 N in place of 0.5 N: 50 mN more natural friction, and the 2 mN that the drive adds
/// grow with the root of the load.
#[test]
fn what_another_load_costs_is_reported_apart() {
    let folder = TempDir::new().unwrap();
    let play = |load_n: f64| {
        let stroke = format!("t_s,x_mm,y_mm,force_n\n0,10,40,{load_n}\n1,110,40,{load_n}\n");
        fs::write(folder.path().join("stroke.csv"), stroke).unwrap();
        fs::write(folder.path().join("constant.toml"), CONSTANT).unwrap();
        succeed(folder.path(), &["play", "constant.toml", "--stroke", "stroke.csv", "--ideal", "--json"])
    };
    let json: serde_json::Value = serde_json::from_str(&play(0.6)).unwrap();
    let mismatch_n = number(&json, "load_mismatch_max_n");
    assert!((50.1e-3..50.4e-3).contains(&mismatch_n), "{mismatch_n} N");
    assert!(number(&json, "friction_error_rms_n") < 2e-3, "the reference is under the same load: {json}");
    let json: serde_json::Value = serde_json::from_str(&play(0.5)).unwrap();
    assert!(number(&json, "load_mismatch_max_n").abs() < 1e-6, "{json}");
}

/// The natural friction of the reference changes by tens of millinewtons, and that of the finger with it. The 2 mN that
/// the drive adds is the most that the display can be off by.
#[test]
fn the_reference_has_the_load_and_the_noise_of_the_finger() {
    let folder = TempDir::new().unwrap();
    let realistic = play_constant(folder.path(), &[]);
    assert_eq!(realistic["world"], "realistic");
    let range_n = number(&realistic, "reference_max_n") - number(&realistic, "reference_min_n");
    assert!(range_n > 20e-3, "natural friction changes by {range_n} N");
    let error_n = number(&realistic, "friction_error_rms_n");
    assert!((1e-5..2e-3).contains(&error_n), "{error_n} N rms");
    assert!(number(&realistic, "inversion_error_max_n") < 1e-5);
    let without = play_constant(folder.path(), &["--no-leakage"]);
    assert_eq!(without["world"], "without-leakage");
    assert!(number(&without, "friction_error_rms_n") < error_n, "what leaks is an error: {without}");

    // Back and forth: where the finger turns, friction against its motion is negative for some micrometres.
    let turns = play_constant(folder.path(), &["--times", "3"]);
    assert!(number(&turns, "reference_min_n") > 0.15, "{turns}");
    let felt = fs::read_to_string(folder.path().join("frixel-out/felt.csv")).unwrap();
    let said = succeed(folder.path(), &["play", "constant.toml", "--seconds", "0.1", "--verbose"]);
    assert!(
        said.contains(" mN, assumed, at the load of the finger that plays; not where the finger lands or turns"),
        "{said}"
    );
    assert!(felt.lines().count() > 3_000);

    let ideal = play_constant(folder.path(), &["--ideal"]);
    assert_eq!(ideal["world"], "ideal");
    let range_n = number(&ideal, "reference_max_n") - number(&ideal, "reference_min_n");
    assert!(range_n.abs() < 1e-9, "an ideal finger's friction changes by {range_n} N");
    assert!(number(&ideal, "friction_error_rms_n") < error_n);
}

#[test]
fn a_drawn_finger_is_felt_and_the_board_does_not_know_it() {
    let folder = TempDir::new().unwrap();
    let screen_gap_m = 1e-6 / 3.9;
    for seed in ["5", "6"] {
        let person = frixel_hil_sim::Person::drawn(seed.parse().unwrap());
        let natural_n = person.contact(screen_gap_m).unwrap().natural_friction_n();
        let json = play_constant(folder.path(), &["--ideal", "--finger-seed", seed]);
        assert_eq!((&json["finger_seed"].to_string()[..], &json["finger_origin"]), (seed, &"assumed".into()));
        let reference_n = number(&json, "reference_max_n");
        assert!((reference_n - natural_n - 2e-3).abs() < 1e-5, "{reference_n} N is not {natural_n} N and 2 mN");
        let reachable_n = number(&json, "reachable_min_n");
        assert!((reachable_n - 0.25).abs() < 1e-9, "the board was told of another finger: {reachable_n} N");
        let (error_n, table_error_n) = (number(&json, "friction_error_rms_n"), number(&json, "inversion_error_rms_n"));
        assert!(error_n < 2e-3 && error_n > 10.0 * table_error_n, "{error_n} N rms, of the inverse {table_error_n} N");

        let felt = fs::read_to_string(folder.path().join("frixel-out/felt.csv")).unwrap();
        let felt_n: f64 = felt.lines().nth(800).unwrap().split(',').nth(6).unwrap().parse().unwrap();
        assert!((felt_n - natural_n).abs() < 5e-3, "felt {felt_n} N, not about {natural_n} N");
    }
}

#[test]
fn the_summary_says_which_world_was_simulated() {
    let folder = TempDir::new().unwrap();
    let play = |options: &[&str]| {
        succeed(folder.path(), &[&["play", &brick(), "--seconds", "0.1", "--verbose"], options].concat())
    };
    let said = play(&[]);
    assert!(said.contains("  world            realistic: with load changes, noise,"), "{said}");
    assert!(said.contains("--ideal switches them off") && !said.contains("  finger "), "{said}");
    let said = play(&["--ideal", "--finger-seed", "7"]);
    assert!(said.contains("  world            ideal: no load changes, noise,"), "{said}");
    assert!(said.contains("  finger           random person 7, assumed;"), "{said}");
}

#[test]
fn the_shortest_play_is_one_tick() {
    let folder = TempDir::new().unwrap();
    let said = succeed(folder.path(), &["play", &brick(), "--seconds", "2.5e-5", "--json"]);
    assert!(said.contains(r#""ticks":1,"#), "{said}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_play_leaves_what_was_played() {
    let folder = TempDir::new().unwrap();
    let mut process = frixel()
        .args(["play", &brick(), "--seconds", "86400", "--json"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let felt = folder.path().join("frixel-out/felt.csv");
    // The rows before the end.
    let rows = folder.path().join("frixel-out/.felt.csv.frixel-tmp");
    while fs::metadata(&rows).map_or(0, |file| file.len()) < 100_000 {
        assert!(process.try_wait().unwrap().is_none(), "it ended by itself");
        sleep(Duration::from_millis(5));
    }
    let pid = rustix::process::Pid::from_raw(process.id() as i32).unwrap();
    rustix::process::kill_process(pid, rustix::process::Signal::INT).unwrap();
    let ended = process.wait_with_output().unwrap();
    let said = String::from_utf8(ended.stderr).unwrap();
    assert!(ended.status.success() && said.contains("interrupted: "), "{said}");
    let json: serde_json::Value = serde_json::from_slice(&ended.stdout).unwrap();
    let rows = fs::read_to_string(felt).unwrap().lines().count() as u64 - 1;
    assert_eq!(json["ticks"].as_u64().unwrap() / 40, rows, "every whole row that was played is there");
    for name in ["felt.svg", "scene.png"] {
        assert!(fs::metadata(folder.path().join("frixel-out").join(name)).unwrap().len() > 10_000);
    }
}
