//! `docs/board/safety.md` and what it names: tests, scenarios, and numbers that `frixel board safety` prints.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use frixel_felt::judge::{Advice, weber_steps};
use frixel_hil_sim::{Board, RigConfig, WorldOptions};
use frixel_lab::input::SceneFolder;
use frixel_model::TouchBound;
use frixel_play::{TO_THE_END, judge};
use frixel_scene::{FingerProfile, Profile, Program, Scene, compile_draft};
use frixel_testkit::golden;
use frixel_wire::hello::BoardLimits;

use crate::gallery::{scenes, verdict_counts};
use crate::processes::{repository, succeed};

const PAGE: &str = include_str!("../../../docs/board/safety.md");
const FIRST_BOARD: &str = include_str!("../../../docs/board/first-board.md");

#[test]
fn every_test_that_the_page_names_exists() {
    let names: Vec<&str> = PAGE.split('`').filter(|name| name.contains(".rs::")).collect();
    assert!(names.len() >= 25, "{names:?}");
    for name in names {
        let (file, test) = name.split_once("::").unwrap();
        let text = fs::read_to_string(repository().join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        let before = text.split_once(&format!("fn {test}(")).unwrap_or_else(|| panic!("no {name}")).0;
        let attributes = before.rsplit_once('}').map_or(before, |(_, attributes)| attributes);
        assert!(attributes.contains("#[test]") || before.contains("proptest!"), "{name} is no test");
    }
}

#[test]
fn every_scenario_of_a_fault_stands_on_the_page_and_no_other() {
    let folder = repository().join("hil-sim/scenarios");
    let files = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    let scenarios = files.filter(|file| fs::read_to_string(file).unwrap().contains("[[fault]]"));
    let names = |file: PathBuf| format!("hil-sim/scenarios/{}", file.file_name().unwrap().to_str().unwrap());
    let mut expected: Vec<String> = scenarios.map(names).collect();
    // Faults of the host are its commands.
    expected.extend(["two-clients", "host-hangs", "host-dies"].map(|name| format!("hil-sim/scenarios/{name}.toml")));
    let named = PAGE.split('`').filter(|name| name.starts_with("hil-sim/scenarios/"));
    let mut found: Vec<String> = named.map(str::to_owned).collect();
    expected.sort();
    found.sort();
    // One scenario may stand for several faults.
    found.dedup();
    assert_eq!(found, expected);
}

/// A drive, as a board gives it.
struct Drive {
    name: &'static str,
    board: Board,
    carrier_hz: u32,
}

fn drives() -> [Drive; 4] {
    let board = Board::NUCLEO_G474RE;
    let nobody = BoardLimits { series_resistance_ohm: f32::INFINITY, ..board.limits };
    let untouched = Board { limits: nobody, ..board };
    [
        Drive { name: "as built in, 43.8 V peak at 1 kHz", board, carrier_hz: 1_000 },
        Drive { name: "50 V peak at 1 kHz, above the bound", board: untouched, carrier_hz: 1_000 },
        Drive { name: "50 V peak at 2.5 kHz", board, carrier_hz: 2_500 },
        Drive { name: "150 V rms at 250 Hz behind 374 kOhm", board: board.behind(374e3), carrier_hz: 250 },
    ]
}

/// A scene as a drive gives it: clamped to what it can.
fn draft(text: &str, finger: &str, drive: &Drive) -> Program {
    let carrier = format!("[carrier]\nfrequency_hz = {}\n", drive.carrier_hz);
    let text = match text.split_once("[carrier]") {
        None => format!("{text}\n{carrier}"),
        // The next table begins behind an empty line.
        Some((before, after)) => format!("{before}{carrier}{}", &after[after.find("\n\n").unwrap()..]),
    };
    let pictures = SceneFolder(repository().join("scenes"));
    let scene = Scene::parse(&text, "scene.toml", &pictures).unwrap();
    let scene = scene.with_finger(FingerProfile::bundled(finger).unwrap(), finger);
    let program = compile_draft(&scene, &drive.board.limits, drive.board.tick_hz).unwrap();
    let is_bounded = drive.board.limits.series_resistance_ohm.is_finite();
    let bound =
        TouchBound::behind(drive.board.limits.series_resistance_ohm).voltage_max_v_peak(drive.carrier_hz as f32);
    assert!(!is_bounded || program.header.voltage_max_v_peak <= bound, "{}", drive.name);
    program
}

fn fingers() -> String {
    let names = ["example", "dry", "moist", "light"];
    let mut text = format!("| drive | {} |\n|---|{}\n", names.join(" | "), "---|".repeat(names.len()));
    for drive in drives() {
        let steps = names.map(|finger| {
            let scene = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 1\n";
            let reach = draft(scene, finger, &drive).reach;
            format!("{:.2}", weber_steps(reach.natural_friction_n, reach.friction_max_n()))
        });
        let _ = writeln!(text, "| {} | {} |", drive.name, steps.join(" | "));
    }
    text
}

fn gallery() -> String {
    let drives = drives();
    let names = drives.each_ref().map(|drive| drive.name);
    let mut text = format!("| scene | {} |\n|---|{}\n", names.join(" | "), "---|".repeat(names.len()));
    for (name, scene) in scenes() {
        let cells = drives.each_ref().map(|drive| {
            let program = draft(&scene, "example", drive);
            let judgement =
                judge(&program, &RigConfig::of(drive.board), &WorldOptions::default(), Advice::Omitted, TO_THE_END)
                    .unwrap();
            verdict_counts(&judgement.layers)
        });
        let _ = writeln!(text, "| {name} | {} |", cells.join(" | "));
    }
    text
}

#[test]
fn the_pages_say_what_is_felt_within_the_limits() {
    golden::hold_part(&repository().join("docs/board/safety.md"), "<!-- fingers", &fingers());
    golden::hold_part(&repository().join("docs/board/first-board.md"), "<!-- gallery", &gallery());
}

/// The page's other numbers are printed by its command.
#[test]
fn the_page_has_the_numbers_of_the_command() {
    let text = succeed(&repository(), &["board", "safety"]);
    for (found, said) in [
        ("125 Hz   28.6 V bound", "the bound is 28.6 V"),
        ("1.21  one of two", "1.21 mA at the bound at 1 kHz"),
        ("3.00  the amplifier stuck at a rail of 210 V", "3.0 mA through 68 kOhm and a person at a rail of 210 V"),
        ("3.00  the amplifier stuck at a rail of 210 V", "With one further part failed: 3 mA, of 5 mA allowed"),
        ("5.83  both", "5.8 mA by the resistors"),
        ("250 Hz   374 kOhm: 167.5 V peak", "takes 374 kOhm, two of 187, and a carrier of 250 Hz"),
        ("250 Hz   374 kOhm: 167.5 V peak", "167.5 V peak"),
        ("edges of 199 us take 20 % of the mean square", "edges of 199 us take 20 % of the mean square"),
    ] {
        assert!(text.contains(found) && PAGE.replace('\n', " ").contains(said), "{found}: {text}");
    }
    // Those of the return path.
    let hardware = include_str!("../../../docs/board/hardware.md").replace('\n', " ");
    for (found, said) in [
        ("1000 Hz   99  98  return contact", "99 % of the voltage is across the gap, and 98 % of the force"),
        ("1000 Hz   21   4  no contact, the common isolated", "without the contact 21 % and 4 %"),
        ("1000 Hz   50  25  no contact, the common on earth", "with the common on earth half and a quarter"),
    ] {
        assert!(text.contains(found) && hardware.contains(said), "{found}: {text}");
    }
    // And those of a first board, in a row of its table.
    for (found, said) in [
        ("1000 Hz   43.8 V bound", "43.8 V | 68 kOhm | 1 kHz"),
        ("250 Hz   374 kOhm: 167.5 V peak", "167.5 V | 374 kOhm | 250 Hz"),
        ("edges of 199 us take 20 % of the mean square", "199 us, 20 % of the mean square"),
    ] {
        assert!(text.contains(found) && FIRST_BOARD.contains(said), "{found}: {text}");
    }
}
