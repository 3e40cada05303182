//! `frixel play --port pico` as a person uses it.

use std::fs;
use std::path::Path;
use std::process::Command;

use frixel_hil_sim::Board;
use tempfile::TempDir;

use crate::emulator;
use crate::processes::{frixel, said};

/// A band on an otherwise plain screen, which the stroke below crosses.
const BAND: &str = "version = 1\n[[layer]]\nname = \"band\"\nkind = \"constant\"\n\
                    region = { x_mm = 30, y_mm = 0, width_mm = 6, height_mm = 80 }\nfriction_fraction = 0.9\n";

pub(super) fn play(folder: &Path) -> Command {
    fs::write(folder.join("band.toml"), BAND).unwrap();
    let mut command = frixel();
    command.args(["play", "band.toml", "--port", "pico", "--ideal", "--json"]).current_dir(folder);
    command
}

/// Goal of `docs/inside/numbers.md` for a finger at constant speed: within 5 % rms of what the drive can reach.
#[test]
fn a_band_is_felt_as_the_scene_asks_for_it() {
    if emulator::pico_image().is_none() {
        return;
    }
    let folder = TempDir::new().unwrap();
    let output = play(folder.path()).args(["--from", "4,30", "--to", "116,45", "--seconds", "0.5"]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let ticks = Board::PICO.tick_hz / 2;
    assert_eq!((&json["rig"], &json["ticks"]), (&"pico".into(), &ticks.into()));
    let number = |name: &str| json[name].as_f64().unwrap();
    let error_n = number("friction_error_rms_n");
    let range_n = number("reachable_max_n") - number("reachable_min_n");
    assert!(error_n < 0.05 * range_n && error_n > 1e-6, "{error_n} N rms of {range_n} N");
    let felt = fs::read_to_string(folder.path().join("frixel-out/felt.csv")).unwrap();
    assert_eq!(felt.lines().count(), 501);
}
