//! `frixel finger calibrate` on the port of a virtual board.

use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Output, Stdio};
use std::thread::{self, sleep};
use std::time::Duration;

use frixel_hil_sim::Person;
use frixel_scene::{FingerProfile, Profile};
use serde_json::Value;
use tempfile::TempDir;

use crate::VirtualBoard;
use crate::processes::{frixel, run, said, succeed};

/// Strokes at a speed at which friction follows the drive.
const STROKES: [&str; 7] = ["--from", "25,40", "--to", "95,40", "--speed", "44", "--minimum-jerk"];
/// The fewest strokes that can be fitted, which take 14 s.
const FEW: [&str; 2] = ["--strokes", "9"];

/// A minute of naps of 50 ms: whatever is waited for longer has hung.
const NAPS_MAX: u32 = 1_200;

/// Calibrates, and returns what the command prints.
fn calibrate(folder: &Path, arguments: &[&str], run: fn(&Path, &[&str]) -> Output) {
    let output = run(folder, &[&["finger", "calibrate", "-o", "data.csv"], &FEW[..], arguments].concat());
    let (printed, notes) = (String::from_utf8_lossy(&output.stdout), said(&output));
    assert!(output.status.success() && !notes.contains("ran out of samples"), "{notes}");
    let says = "frixel finger fit data.csv -o finger.toml";
    assert!(printed.contains("9 strokes") && printed.contains(says), "{printed}");
}

/// Runs a command whose standard input is what the virtual board's sensor measures meanwhile.
fn with_forces_on_stdin(folder: &Path, arguments: &[&str]) -> Output {
    let mut forces = fs::File::open(folder.join("board/forces.csv")).unwrap();
    let mut command = frixel();
    command.args(arguments).current_dir(folder);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let writer = thread::spawn(move || {
        let mut lines = Vec::new();
        for _ in 0..100 * NAPS_MAX {
            forces.read_to_end(&mut lines).unwrap();
            let whole = lines.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
            // The command reads no more when it has ended.
            if input.write_all(&lines.drain(..whole).collect::<Vec<u8>>()).is_err() {
                return;
            }
            sleep(Duration::from_millis(5));
        }
    });
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    output
}

/// The person of a seed is on the virtual board, and no scene changes that: what is fitted is theirs. The sensor's rows
/// are in a file, or come on standard input meanwhile.
#[test]
fn a_person_at_a_port_is_calibrated_with_the_forces_of_a_sensor() {
    type Run = fn(&Path, &[&str]) -> Output;
    for (forces, run) in [("board/forces.csv", run as Run), ("-", with_forces_on_stdin)] {
        let folder = TempDir::new().unwrap();
        let board = VirtualBoard::start(folder.path(), &[&STROKES[..], &["--finger-seed", "5"]].concat());
        calibrate(folder.path(), &["--port", &board.port, "--forces", forces], run);
        drop(board);
        let rows = fs::read_to_string(folder.path().join("data.csv")).unwrap().lines().count();
        assert!(rows > 8_000, "{forces}: {rows} rows");
        let json = succeed(folder.path(), &["finger", "fit", "data.csv", "--json"]);
        let json: Value = serde_json::from_str(&json).unwrap();
        let coefficient = json["friction_coefficient"].as_f64().unwrap();
        let interval = &json["friction_coefficient_interval"];
        let drawn = Person::drawn(5).finger.friction_coefficient;
        assert!((coefficient / drawn - 1.0).abs() < 0.05, "{forces}: {coefficient}, not {drawn}");
        let is_inside = interval[0].as_f64() < Some(coefficient) && Some(coefficient) < interval[1].as_f64();
        assert!(is_inside, "{forces}: {coefficient} is outside of {interval}");
    }
}

#[test]
fn a_finger_on_a_virtual_board_stays_whatever_scene_plays() {
    let folder = TempDir::new().unwrap();
    let board = VirtualBoard::start(folder.path(), &[&STROKES[..], &["--finger", "dry", "--ideal"]].concat());
    let rows = || fs::read_to_string(folder.path().join("board/forces.csv")).unwrap();
    let slides = (0..NAPS_MAX).any(|_| {
        sleep(Duration::from_millis(50));
        rows().lines().count() > 500
    });
    assert!(slides, "hung: the finger slides");
    drop(board);
    let rows = rows();
    let ratio = |row: &str| {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        (cells[1] > 0.0).then(|| cells[2] / cells[1])
    };
    let ratios: Vec<f64> = rows.lines().skip(1).take(400).filter_map(ratio).collect();
    let dry = FingerProfile::bundled("dry").unwrap().friction_coefficient;
    let wrong = ratios.iter().filter(|ratio| (*ratio - dry).abs() > 1e-6).count();
    assert!(ratios.len() > 300 && wrong == 0, "{wrong} of {} are not {dry}", ratios.len());
}
