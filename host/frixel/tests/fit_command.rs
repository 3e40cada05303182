//! From a board to a profile: `frixel finger calibrate` on the in-process simulator, then `frixel finger fit` on what
//! it wrote.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::path::Path;

use frixel_hil_sim::Person;
use frixel_lab::fit;
use frixel_scene::{Evidence, FingerProfile, Profile};
use serde_json::Value;
use tempfile::TempDir;

use self::simulated::steady;
use self::tally::settings;
use crate::processes::{run, said, succeed};

#[path = "fit_coverage.rs"]
mod coverage;
#[allow(dead_code, unused_imports, reason = "the tests of the fit use the rest")]
#[path = "../../lab/tests/person.rs"]
mod person;
#[allow(dead_code, reason = "the tests of the fit use the rest")]
#[path = "../../lab/tests/simulated.rs"]
mod simulated;
#[allow(dead_code, reason = "the tests of the fit use the rest")]
#[path = "../../lab/tests/tally.rs"]
mod tally;

fn fail(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}");
    said(&output)
}

#[test]
fn a_calibrated_person_is_recovered() {
    let folder = TempDir::new().unwrap();
    let said = succeed(folder.path(), &["finger", "calibrate", "-o", "data.csv", "--finger-seed", "5"]);
    assert!(said.contains("36 strokes") && said.contains("75, 106, 150 V rms"), "{said}");
    let json = succeed(folder.path(), &["finger", "fit", "data.csv", "-o", "finger.toml", "--json"]);
    let fitted: Value = serde_json::from_str(&json).unwrap();
    let number = |key: &str| fitted[key].as_f64().unwrap_or_else(|| panic!("{key} in {json}"));
    let interval = |key: &str| {
        let ends = [0, 1].map(|end| fitted[key][end].as_f64().unwrap_or_else(|| panic!("{key} in {json}")));
        assert!(ends[0] < ends[1], "{key}: {ends:?}");
        ends
    };

    // The command prints the fit that `fit_coverage.rs` evaluates.
    let rows = fit::rows(fs::File::open(folder.path().join("data.csv")).unwrap()).unwrap().value;
    let summary = fit::fit(rows, &settings()).unwrap().json();
    assert_eq!(json.trim_end(), summary.to_string());

    let person = Person::drawn(5);
    // Of what the amplifier's edges lose, the board makes up for a part: friction lies between that of a drive of 150
    // V rms
    // and that of 150 V rms on the electrode.
    let load_n = number("normal_load_n");
    let drive = steady(&person, load_n, 150.0);
    let electrode = steady(&person, load_n, 150.0 * 150.0 / drive.electrode_v_rms);
    let between_n = 0.98 * drive.electric_friction_n..1.02 * electrode.electric_friction_n;
    assert!((number("friction_coefficient") / drive.friction_coefficient - 1.0).abs() < 0.02, "{json}");
    assert!(between_n.contains(&number("electric_friction_150_v_n")), "{between_n:?}: {json}");
    for key in ["friction_coefficient", "electric_friction_150_v", "voltage_exponent"] {
        let unit = if key == "electric_friction_150_v" { ("_n", "_interval_n") } else { ("", "_interval") };
        let [low, high] = interval(&format!("{key}{}", unit.1));
        assert!((low..=high).contains(&number(&format!("{key}{}", unit.0))), "{key}: {json}");
    }
    assert_eq!(fitted["strokes"], 36);

    let text = fs::read_to_string(folder.path().join("finger.toml")).unwrap();
    let profile = FingerProfile::parse(&text, "finger.toml").unwrap();
    // Nothing was measured, whatever the recording looks like.
    assert_eq!(profile.evidence, Evidence::Assumed);
    let data = fs::read_to_string(folder.path().join("data.csv")).unwrap().replace(",assumed\n", ",\n");
    fs::write(folder.path().join("measured.csv"), data).unwrap();
    succeed(folder.path(), &["finger", "fit", "measured.csv", "-o", "finger.toml"]);
    let text = fs::read_to_string(folder.path().join("finger.toml")).unwrap();
    let measured = FingerProfile::parse(&text, "finger.toml").unwrap();
    assert!(matches!(measured.evidence, Evidence::Measured { voltage_max_v_rms, .. } if voltage_max_v_rms > 149.0));
    assert_eq!(FingerProfile { evidence: Evidence::Assumed, ..measured }, profile);
    assert!(fs::read_to_string(folder.path().join("finger.svg")).unwrap().contains("contact model, fitted"));

    // The same file in words, from standard columns in another order, without the stroke column.
    let words = succeed(folder.path(), &["finger", "fit", "data.csv"]);
    assert!(words.contains("cannot tell radius, stiffness and gap apart"), "{words}");
    fs::write(
        folder.path().join("thick.toml"),
        "width_mm = 120\nheight_mm = 80\n[[coating]]\nthickness_um = 40\npermittivity = 3.9\n",
    )
    .unwrap();
    let thick = fail(folder.path(), &["finger", "fit", "data.csv", "--screen", "thick.toml"]);
    assert!(thick.contains("the coating alone has 10.256 um"), "{thick}");
}
