//! `frixel score`: its files, its people and the row of a page.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::path::Path;

use serde_json::Value;

use crate::processes::{bundled, repository, succeed};

/// The output of a score of the grating, with its files in a folder.
fn score(out: &Path, options: &[&str]) -> String {
    succeed(out, &[&["score", bundled("grating.toml").to_str().unwrap(), "--out", "."], options].concat())
}

#[test]
fn the_command_writes_a_row_for_each_play_and_a_picture() {
    let out = tempfile::tempdir().unwrap();
    let options = ["--strokes", "2", "--seeds", "2", "--seconds", "0.5", "--json"];
    let json: Value = serde_json::from_str(&score(out.path(), &options)).unwrap();
    assert_eq!(json["plays"].as_array().unwrap().len(), 4);
    let csv = std::fs::read_to_string(out.path().join("score.csv")).unwrap();
    assert_eq!(csv.lines().count(), 5);
    assert!(csv.starts_with("simulated_person,stroke,seed,error,correlation,"));
    assert_eq!((json["simulated_fingers"].as_u64(), json["layers"].as_array().unwrap().len()), (Some(1), 1));
    let svg = std::fs::read_to_string(out.path().join("score.svg")).unwrap();
    let layers = std::fs::read_to_string(out.path().join("score-layers.csv")).unwrap();
    assert!(
        layers.starts_with("layer,simulated_fingers,felt,") && layers.contains("\n\"layer 1 \"\"stripes\"\"\",1,1,")
    );
    assert_eq!(json["touch_source"]["latency_ms"].as_f64(), Some(10.0));
    let said = "a verdict on 1 simulated finger in 4 plays";
    assert!(svg.contains(said) && json["simulated"].as_str().unwrap().starts_with(said), "{json}");
    assert_eq!(json["verdict"], "1 of 1 layer is noticed by the simulated finger");
}

/// Each person has a finger and strokes of their own, the same in every run.
#[test]
fn people_differ_and_come_again() {
    let out = tempfile::tempdir().unwrap();
    let options = ["--people", "3", "--strokes", "2", "--seeds", "2", "--seconds", "4", "--json"];
    let plays = || serde_json::from_str::<Value>(&score(out.path(), &options)).unwrap();
    let json = plays();
    let plays_of = json["plays"].as_array().unwrap().chunks(4);
    let contrasts: Vec<f64> = (1..)
        .zip(plays_of)
        .map(|(person, played)| {
            assert!(played.iter().all(|play| play["simulated_person"] == person), "{json}");
            played.iter().filter_map(|play| play["fidelity"]["contrast_weber_steps"].as_f64()).sum::<f64>() / 4.0
        })
        .collect();
    assert_eq!(contrasts.len(), 3);
    assert!(contrasts.windows(2).all(|pair| (pair[0] - pair[1]).abs() > 0.05), "{json}");
    assert_eq!(json, plays());
}

/// The command under the table of `docs/design/touch.md` prints the row that it is said to print, on fewer strokes.
#[test]
fn the_command_of_the_touch_table_prints_its_row() {
    let docs = repository().join("docs/design");
    let page = std::fs::read_to_string(docs.join("touch.md")).unwrap();
    let command = page.lines().find(|line| line.starts_with("frixel score touch/")).unwrap();
    let row = page.lines().find_map(|line| line.strip_prefix("| 100 Hz, 10 mm | 100 mm/s | ")).unwrap();
    let row: Vec<f64> = row.split('|').take(3).map(|cell| cell.replace("mN", "").trim().parse().unwrap()).collect();
    let out = tempfile::tempdir().unwrap();
    let mut arguments: Vec<&str> = command.split(' ').skip(1).collect();
    arguments.extend(["--json", "--out", out.path().to_str().unwrap()]);
    let score: Value = serde_json::from_str(&succeed(&docs, &arguments)).unwrap();
    let mean = |key: &str| {
        let metrics = score["metrics"].as_array().unwrap().iter();
        metrics.filter(|metric| metric["key"] == key).find_map(|metric| metric["mean"].as_f64()).unwrap()
    };
    for (key, cell, rounding) in
        [("error", row[0], 0.02), ("correlation", row[1], 0.01), ("spurious_40_to_400_hz_mn", row[2], 1.0)]
    {
        assert!((mean(key) - cell).abs() <= rounding, "{key}: {}, and {cell} in the page", mean(key));
    }
}

/// Output and files do not depend on the number of threads.
#[test]
fn every_number_of_jobs_has_the_same_bytes() {
    let scored = |jobs: &str| {
        let out = tempfile::tempdir().unwrap();
        let options = ["--people", "5", "--strokes", "2", "--seeds", "1", "--seconds", "0.4", "--json", "--jobs", jobs];
        let said = score(out.path(), &options);
        let file = |name: &str| std::fs::read(out.path().join(name)).unwrap();
        (said, ["score.csv", "score-layers.csv", "score.svg"].map(file))
    };
    let (said, files) = scored("1");
    for jobs in ["2", "7"] {
        assert!(scored(jobs) == (said.clone(), files.clone()), "--jobs {jobs}");
    }
}
