//! `frixel play --record` and `frixel replay`.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Stdio;

use frixel_felt::recorder::MarkedEvent;
use frixel_lab::recording::{Recording, SourceFile, Values};
use frixel_play::TO_THE_END;
use tempfile::TempDir;

use crate::processes::{bundled, frixel, run, run_fed, said, succeed};
use crate::stream::{tones, write_wav};

/// A scene with a picture, a finger and a part of its own.
const SCENE: &str = "version = 1\ninclude = [\"parts/part.toml\"]\n[[layer]]\nname = \"wall\"\nkind = \"bitmap\"\n\
                     picture = \"brick.png\"\nx_mm = 10\ny_mm = 5\nwidth_mm = 100\npitch_mm = 0.4\nlive = true\n\
                     black_fraction = 0.2\nwhite_fraction = 0.6\n";
const PART: &str = "version = 1\n[[layer]]\nname = \"button\"\nkind = \"constant\"\nfriction_fraction = 0.5\n\
                    live = true\nstart = \"off\"\n";

fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("parts")).unwrap();
    fs::write(path("scene.toml"), SCENE).unwrap();
    fs::write(path("parts/part.toml"), PART).unwrap();
    fs::copy(bundled("textures/brick.png"), path("brick.png")).unwrap();
    fs::write(path("stroke.csv"), "t_s,x_mm,y_mm,force_n\n0,10,20,0.4\n0.3,60,25,0.6\n0.7,30.1,40,0.5\n").unwrap();
    fs::write(path("touch.toml"), "reports_per_s = 120\nlatency_ms = 8\nlost_share = 0.05\n").unwrap();
    folder
}

fn read(folder: &Path, name: &str) -> Recording {
    Recording::read_parquet(fs::read(folder.join(name)).unwrap(), TO_THE_END).unwrap()
}

fn write(folder: &Path, name: &str, recording: &Recording) {
    let mut bytes = Vec::new();
    recording.write_parquet(&mut bytes).unwrap();
    fs::write(folder.join(name), bytes).unwrap();
}

/// Replays a recording that cannot be replayed, or differs, and returns the error.
fn refused(folder: &Path, name: &str) -> String {
    let output = run(folder, &["replay", name]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    said.lines().last().unwrap().to_owned()
}

/// Every option that changes what is felt, in a folder without the files.
#[test]
fn a_recording_plays_the_same_bits_again_without_its_files() {
    let plays = [
        "--seconds 0.3",
        "--seconds 0.3 --ideal --seed 18446744073709551615",
        "--seconds 0.5 --csv-hz 40000 --skin no-leakage --finger moist --screen example",
        "--stroke stroke.csv --touch touch.toml --finger-seed 7",
        "--stroke human --seconds 1 --seed 5 --touch 500",
        "--from 10.1,20.3 --to 33.3,21.7 --speed 77.7 --times 2 --minimum-jerk --csv-hz 500",
    ];
    for play in plays {
        let folder = folder();
        let line = format!("play scene.toml {play} --record a.parquet");
        succeed(folder.path(), &line.split(' ').collect::<Vec<_>>());
        let elsewhere = TempDir::new().unwrap();
        fs::copy(folder.path().join("a.parquet"), elsewhere.path().join("a.parquet")).unwrap();
        let said = succeed(elsewhere.path(), &["replay", "a.parquet"]);
        assert!(said.contains("a.parquet: the same bits, ") && said.contains("rows of 12 columns"), "{play}: {said}");
        succeed(folder.path(), &line.replace("a.parquet", "b.parquet").split(' ').collect::<Vec<_>>());
        let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
        assert!(bytes("a.parquet") == bytes("b.parquet"), "{play}: the same play has the same bytes");
    }
}

#[test]
fn a_recording_has_the_rows_of_felt_csv_and_what_made_them() {
    let folder = folder();
    let line = "play scene.toml --stroke stroke.csv --record a.parquet --participant P07";
    succeed(folder.path(), &line.split(' ').collect::<Vec<_>>());
    let recording = read(folder.path(), "a.parquet");
    let mut csv = csv::Reader::from_path(folder.path().join("frixel-out/felt.csv")).unwrap();
    let names: Vec<String> = csv.headers().unwrap().iter().map(str::to_owned).collect();
    let mut compared = 0;
    for (row, cells) in csv.records().enumerate() {
        for (name, cell) in names.iter().zip(&cells.unwrap()) {
            match &recording.column(name).unwrap().values {
                Values::Numbers(numbers) => {
                    let difference = numbers[row].map(|number| number - cell.parse::<f64>().unwrap());
                    assert!(difference.map_or(cell.is_empty(), |difference| difference.abs() < 1e-3), "{name}, {row}");
                }
                Values::Integers(numbers) => assert_eq!(numbers[row].unwrap().to_string(), cell),
                Values::Texts(texts) => assert_eq!(texts[row].as_deref().unwrap(), cell),
            }
            compared += 1;
        }
    }
    assert_eq!(compared, 10 * recording.rows());

    let metadata = &recording.metadata;
    assert_eq!((metadata.scene.as_str(), metadata.participant.as_deref()), (SCENE, Some("P07")));
    assert_eq!((metadata.rig.as_str(), metadata.is_simulated, metadata.tick_hz), ("sim", true, 40_000));
    assert_eq!(metadata.files["scene/parts/part.toml"], SourceFile::Text(PART.to_owned()));
    let picture = fs::read(folder.path().join("brick.png")).unwrap();
    assert_eq!(metadata.files["scene/brick.png"].bytes(), Some(picture));
    assert_eq!(metadata.files.len(), 3);
    let events: Vec<_> = metadata.markers.iter().map(|marker| (marker.ticks, &marker.event)).collect();
    assert_eq!(events, [(0, &MarkedEvent::SceneBegan), (28_000, &MarkedEvent::Stopped)]);

    // No path, user or host.
    let bytes = String::from_utf8_lossy(&fs::read(folder.path().join("a.parquet")).unwrap()).into_owned();
    assert!(!bytes.contains(&*folder.path().to_string_lossy()) && !bytes.contains("stroke.csv"));
}

/// Runs a line with something on its standard input.
fn fed(folder: &Path, line: &str, input: &[u8]) {
    let ended = run_fed(folder, &line.split(' ').collect::<Vec<_>>(), input);
    assert!(ended.status.success(), "{line}: {}", said(&ended));
}

#[test]
fn bytes_behind_the_rows_of_a_recording_are_noticed() {
    let folder = folder();
    succeed(folder.path(), &["play", "scene.toml", "--seconds", "0.3", "--record", "a.parquet"]);
    let bytes = fs::read(folder.path().join("a.parquet")).unwrap();
    fs::write(folder.path().join("b.parquet"), [bytes.as_slice(), b"more"].concat()).unwrap();
    let said = refused(folder.path(), "b.parquet");
    assert!(said.contains("play the same bits, but the bytes after them are not rows"), "{said}");
}

/// Asserts that the recording `a.parquet` of a folder is played again from this file alone.
fn assert_played_again(folder: &Path, what: &str) {
    let elsewhere = TempDir::new().unwrap();
    fs::copy(folder.join("a.parquet"), elsewhere.path().join("a.parquet")).unwrap();
    let output = run(elsewhere.path(), &["replay", "a.parquet"]);
    let said = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap()).concat();
    assert!(said.contains("a.parquet: the same bits, "), "{what}: {said}");
}

#[test]
fn what_changes_a_play_is_marked_and_changes_it_again() {
    let folder = folder();
    fs::write(folder.path().join("other.toml"), PART).unwrap();
    let lines = "wait 0.1\ntrigger button 20\nwait 0.1\nlayer wall gain 0.5\nwait 0.05\nreplace other.toml\n";
    fed(folder.path(), "play scene.toml --control --seconds 0.4 --record a.parquet", lines.as_bytes());

    let recording = read(folder.path(), "a.parquet");
    let markers = &recording.metadata.markers;
    let changed = |name: &str, on: bool, gain: f32| {
        let is = |event: &MarkedEvent| {
            matches!(event, MarkedEvent::LayerChanged { layer, on: found, gain: of }
                if layer.contains(name) && *found == on && of.to_bits() == gain.to_bits())
        };
        markers.iter().find(|marker| is(&marker.event)).unwrap_or_else(|| panic!("{name}: {markers:?}")).t_s
    };
    for (found_s, expected_s) in
        [(changed("button", true, 1.0), 0.1), (changed("button", false, 1.0), 0.12), (changed("wall", true, 0.5), 0.2)]
    {
        assert!((found_s - expected_s).abs() < 2e-3, "{found_s} s, expected {expected_s} s");
    }
    let is_trigger =
        |event: &MarkedEvent| matches!(event, MarkedEvent::Triggered { layer } if layer.contains("button"));
    assert!(markers.iter().any(|marker| is_trigger(&marker.event)), "{markers:?}");
    assert!(markers.iter().any(|marker| marker.event == MarkedEvent::SceneReplaced && marker.t_s > 0.2));
    assert!(markers.iter().all(|marker| (marker.ticks as f64 / 40_000.0 - marker.t_s).abs() < 1e-9));
    assert_eq!(recording.metadata.later_scenes[0].scene, PART);
    assert_played_again(folder.path(), "control");

    // The lines that were carried out are compared: another line gives other bits.
    let mut other = recording.clone();
    other.metadata.play["lines"][3] = "layer wall gain 0.6".into();
    write(folder.path(), "other.parquet", &other);
    assert!(refused(folder.path(), "other.parquet").contains("other.parquet does not play the same bits: row 2"));
    let mut without = recording.clone();
    without.metadata.play.as_object_mut().unwrap().remove("lines");
    write(folder.path(), "without.parquet", &without);
    assert_eq!(
        refused(folder.path(), "without.parquet"),
        "frixel: without.parquet cannot be played again: lines on standard input changed it (--control), which the \
         recording does not have"
    );
}

/// Lines that do nothing, scenes that cannot be played or have files of their own, and an end before the time.
#[test]
fn every_line_of_a_play_is_carried_out_again() {
    let plays = [
        "layer wall off\nwait 0.03\nlayer wall on\nnonsense\nlayer nobody off\n\n# a word\nlayer wall gain 77\n",
        "wait 0.05\nreplace nowhere.toml\nreplace broken.toml\nlayer button on\nwait 0.05\nreplace wall.toml\n\
         wait 0.05\nreplace scene.toml\ntrigger button 30\n",
        "wait 0.1234567\ntrigger button\nwait 0.01\nquit\nlayer wall off\n",
        "trigger button 1000\nwait 0.1\nreplace scene.toml\nreplace scene.toml\nwait 0.0000125\nlayer button off\n",
    ];
    for lines in plays {
        for rate in ["--csv-hz 40000", "--csv-hz 1000 --finger moist"] {
            let folder = folder();
            fs::write(folder.path().join("broken.toml"), "version = 1\n[[layer]]\nkind = \"constnat\"\n").unwrap();
            fs::write(folder.path().join("wall.toml"), SCENE.replace("0.6", "0.4")).unwrap();
            let line = format!("play scene.toml --control --seconds 0.3 {rate} --record a.parquet");
            fed(folder.path(), &line, lines.as_bytes());
            let bytes = String::from_utf8_lossy(&fs::read(folder.path().join("a.parquet")).unwrap()).into_owned();
            assert!(!bytes.contains("wall.toml") && !bytes.contains("nowhere"), "no name of a file is in it");
            assert_played_again(folder.path(), &format!("{rate}: {lines}"));
        }
    }
}

/// A scene with a stream layer.
const STREAMED: &str = "version = 1\n[[layer]]\nname = \"voice\"\nkind = \"stream\"\nlow_n = 0.01\nhigh_n = 0.09\n\
                        live = true\n";

/// Two bytes for each sample, little-endian: a rough texture.
fn samples(count: u32) -> Vec<u8> {
    (0..count).flat_map(|sample| ((sample.wrapping_mul(2_654_435_761) >> 16) as u16).to_le_bytes()).collect()
}

#[test]
fn what_is_streamed_is_in_the_recording_and_streamed_again() {
    // The pipe ends in the middle, long after the play, or has nothing; its last byte is half a sample.
    for (count, rest) in [(900, 1), (40_000, 0), (0, 0)] {
        let folder = folder();
        fs::write(folder.path().join("stream.toml"), STREAMED).unwrap();
        let input = [samples(count), vec![7; rest]].concat();
        let line = "play stream.toml --stream - --stream-hz 8000 --seconds 0.3 --csv-hz 40000 --record a.parquet";
        fed(folder.path(), line, &input);
        assert_played_again(folder.path(), &format!("{count} samples"));
        let recording = read(folder.path(), "a.parquet");
        let kept = recording.metadata.files["stream"].bytes().unwrap();
        assert!(input.starts_with(&kept) && (count == 0 || kept.len() > 1000), "{} bytes", kept.len());
        if count > 0 {
            let mut other = recording;
            let mut bytes = kept;
            bytes[100] ^= 0x80;
            other.metadata.files = SourceFile::all([("stream".to_owned(), bytes.as_slice())]);
            write(folder.path(), "other.parquet", &other);
            assert!(
                refused(folder.path(), "other.parquet").contains("other.parquet does not play the same bits: row ")
            );
            // Beyond 4 MiB.
            let hash = SourceFile::Hash { sha256: "00".to_owned(), bytes: 9_000_000 };
            other.metadata.files.insert("stream".to_owned(), hash);
            write(folder.path(), "other.parquet", &other);
            assert!(refused(folder.path(), "other.parquet").contains("only the hash of the large file stream"));
        }
    }
}

/// A play lasts as long as its file of samples, while the finger repeats its stroke.
#[test]
fn a_wav_file_is_in_the_recording_and_streamed_again() {
    let folder = folder();
    fs::write(folder.path().join("stream.toml"), STREAMED).unwrap();
    write_wav(&folder.path().join("a.wav"), &tones());
    for (what, input) in [
        ("", ""),
        ("--seconds 0.2", ""),
        ("--from 10,20 --to 30,20", ""),
        ("--control", "wait 0.1\nlayer voice gain 0.5\nwait 0.1\nlayer voice off\nwait 0.02\nlayer voice on\n"),
        ("--control --seconds 0.3", "wait 0.1\nreplace scene.toml\nwait 0.05\nquit\n"),
    ] {
        let line = format!("play stream.toml --stream a.wav --record a.parquet {what}");
        fed(folder.path(), line.trim_end(), input.as_bytes());
        assert_played_again(folder.path(), what);
    }
}

#[test]
fn replay_names_the_first_difference_or_why_it_cannot_play() {
    let folder = folder();
    let folder = folder.path();
    succeed(folder, &["play", "scene.toml", "--seconds", "0.2", "--record", "a.parquet"]);
    let recording = read(folder, "a.parquet");

    let mut changed = recording.clone();
    let Values::Numbers(felt) = &mut changed.columns[6].values else { panic!("numbers") };
    felt[123] = felt[123].map(|felt_n| f64::from_bits(felt_n.to_bits() ^ 1));
    write(folder, "changed.parquet", &changed);
    let said = refused(folder, "changed.parquet");
    assert!(said.contains("changed.parquet does not play the same bits: row 124, column felt_n: "), "{said}");

    let mut version = recording.clone();
    version.metadata.frixel = "0.0.9".to_owned();
    write(folder, "version.parquet", &version);
    let said = refused(folder, "version.parquet");
    assert!(said.contains("frixel 0.0.9 recorded it, and this is ") && said.contains("use that version"), "{said}");

    let mut person = recording.clone();
    (person.metadata.rig, person.metadata.is_simulated) = ("board".to_owned(), false);
    write(folder, "person.parquet", &person);
    assert!(refused(folder, "person.parquet").ends_with("it was made on a board at a port, under a person's finger"));

    let mut silent = recording.clone();
    silent.metadata.play = serde_json::Value::Null;
    write(folder, "silent.parquet", &silent);
    assert!(refused(folder, "silent.parquet").contains("its metadata lacks the options of the play"));

    let mut without_stroke = recording.clone();
    without_stroke.metadata.play["stroke"]["name"] = "file".into();
    write(folder, "without-stroke.parquet", &without_stroke);
    assert!(refused(folder, "without-stroke.parquet").contains("it lacks stroke, a file that it was played with"));

    // A file that asks for ten hours is played for as long as its rows are, and one more.
    succeed(
        folder,
        &["play", "scene.toml", "--from", "20,20", "--to", "100,20", "--seconds", "0.2", "--record", "b.parquet"],
    );
    let mut long = read(folder, "b.parquet");
    long.metadata.play["seconds"] = 36_000.into();
    write(folder, "long.parquet", &long);
    let said = refused(folder, "long.parquet");
    assert!(said.contains("200") && said.contains("201"), "{said}");
}

/// Ctrl-C leaves the files of what was played, and a whole recording. What it has is played again, with the ticks in
/// which the output is switched off.
#[cfg(unix)]
#[test]
fn an_interrupted_play_leaves_what_was_played_and_its_recording_plays_again() {
    let lines = "wait 0.05\nlayer wall gain 0.5\n";
    // Nearly as long as a recording may be.
    for (seconds, what, input) in
        [(5000, "", ""), (130, "--csv-hz 40000", ""), (130, "--csv-hz 40000 --control", lines)]
    {
        let folder = folder();
        let line = format!("play scene.toml --seconds {seconds} --record a.parquet --seed 3 --json {what}");
        let mut command = frixel();
        command.args(line.trim_end().split(' ')).current_dir(folder.path());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut process = command.spawn().unwrap();
        process.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
        let rows = folder.path().join("frixel-out/.felt.csv.frixel-tmp");
        while fs::metadata(&rows).map_or(0, |file| file.len()) < 100_000 {
            assert_eq!(process.try_wait().unwrap(), None, "the play ended before it was interrupted");
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let pid = rustix::process::Pid::from_raw(process.id() as i32).unwrap();
        rustix::process::kill_process(pid, rustix::process::Signal::INT).unwrap();
        let ended = process.wait_with_output().unwrap();
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(ended.status.success() && said.contains("interrupted after "), "{said}");
        let out = folder.path().join("frixel-out");
        let json: serde_json::Value = serde_json::from_slice(&ended.stdout).unwrap();
        let rows = fs::read_to_string(out.join("felt.csv")).unwrap().lines().count() as u64 - 1;
        let ticks_per_row = if what.contains("40000") { 1 } else { 40 };
        assert_eq!(json["ticks"].as_u64().unwrap() / ticks_per_row, rows, "every whole row that was played is there");
        for name in ["felt.svg", "scene.png"] {
            assert!(fs::metadata(out.join(name)).unwrap().len() > 10_000);
        }
        assert_played_again(folder.path(), what);
    }
}
