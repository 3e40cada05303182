//! Tests of reading, refusing and writing finger profiles.
#![allow(clippy::float_cmp, reason = "what has to be exact is tested as exact")]

use proptest::prelude::*;

use super::*;

const ASSUMED: &str = "\
friction_coefficient = 0.4
normal_load_n = 0.3
radius_mm = 7
stiffness_pa_per_m = 1e7
skin_gap_um = 4
";

/// Its lines follow those of [`ASSUMED`], so that the first one is line 6.
const MEASURED: &str = "\
origin = \"measured\"
date = \"2026-11-22\"
method = \"load cell, 60 s of strokes\"
screen = \"lab/tablet 3\"
friction_coefficient_interval = [0.38, 0.42]
electric_friction_interval_n = [0.06, 0.08]
measured_voltage_max_v_rms = 150
measured_normal_load_range_n = [0.25, 0.35]
";

/// A whole profile.
const EMPIRICAL: &str = "\
friction_coefficient = 0.4
normal_load_n = 0.3
exponent = 2.5
points = [[40, 0.002], [150, 0.06]]
intervals_n = [[0.001, 0.003], [0.05, 0.07]]
origin = \"empirical\"
date = \"2026-11-23\"
method = \"load cell, means of 40 strokes\"
screen = \"lab/tablet 3\"
";

const PERCEPTUAL: &str = "\
origin = \"perceptual\"
date = \"2026-11-22\"
method = \"two-alternative staircase, 40 trials\"
screen = \"lab/tablet 3\"
threshold_v_rms = 22
threshold_interval_v_rms = [19, 26]
";

#[test]
fn a_written_profile_reads_back_the_same() {
    let empirical = FingerProfile::parse(EMPIRICAL, "finger.toml").expect("it reads");
    assert_eq!(FingerProfile::parse(empirical.to_toml(), "finger.toml"), Ok(empirical));
    for evidence in ["", MEASURED, PERCEPTUAL] {
        for elasticity in [
            "stiffness_pa_per_m = 1e7",
            "model = \"soft\"\nmodulus_pa = 1e5\nstress_exponent = 0.5\nshape_constant = 4.5",
        ] {
            let text = format!("{ASSUMED}{evidence}").replace("stiffness_pa_per_m = 1e7", elasticity);
            let profile = FingerProfile::parse(&text, "finger.toml").expect("it reads");
            assert_eq!(FingerProfile::parse(profile.to_toml(), "finger.toml"), Ok(profile));
        }
    }
}

proptest! {
    #[test]
    fn numbers_and_texts_are_written_without_loss(
        (friction_coefficient, normal_load_n, radius_mm) in (0.001..10.0, 0.0..50.0, 0.1..100.0),
        (stiffness_pa_per_m, skin_gap_um) in (1e3..1e14, 0.0..1e4),
        method in "[ -~\n]{1,40}[a-z]",
    ) {
        let experiment = Experiment { date: "2026-11-22".to_owned(), method, screen: "lab\"3\\".to_owned() };
        let profile = FingerProfile {
            friction_coefficient,
            normal_load_n,
            radius_mm,
            elasticity: Elasticity::WinklerFuss { stiffness_pa_per_m },
            skin_gap_um,
            evidence: Evidence::Perceptual { experiment, threshold_v_rms: 1.0, threshold_interval_v_rms: [0.5, 2.0] },
        };
        prop_assert_eq!(FingerProfile::parse(profile.to_toml(), "finger.toml"), Ok(profile));
    }
}

#[test]
fn the_bundled_profiles_read_and_are_assumed() {
    for (name, text) in bundled::TEXTS {
        let profile = FingerProfile::parse(text, name).expect(name);
        assert_eq!(profile.evidence, Evidence::Assumed, "{name}");
        assert!(text.starts_with("# "), "{name} does not give its reasons");
    }
    assert_eq!(FingerProfile::bundled("example"), Some(FingerProfile::example()));
    assert_eq!(FingerProfile::bundled("wet"), None);
}
