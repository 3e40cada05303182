//! Tests of the screen and finger of a scene: precedence, refusals and warnings.
#![allow(clippy::float_cmp, reason = "what has to be exact is tested as exact")]

use super::*;
use crate::diagnostic::Message;
use crate::warning::Warning;
use crate::{Elasticity, FingerProfile, Origin, Profile};
use frixel_layers::Header;
use frixel_model::{Carrier, Waveform};
use frixel_wire::hello::feature;

/// All of a scene but its layers: the example screen and finger.
const SHORT: &str = "version = 1\n";
const LAYER: &str = "[[layer]]\nkind = \"constant\"\nfriction_n = 0.3\n";
/// Mixed coefficients of friction tell the fingers apart.
const EMBEDDED: &str = "finger = { friction_coefficient = 0.4, normal_load_n = 0.5, radius_mm = 8, stiffness_pa_per_m = 1.8e7, \
                        skin_gap_um = 4.74 }\n";

fn parse(text: &str) -> Result<Scene, CompileError> {
    let anna = FingerProfile { friction_coefficient: 0.45, ..FingerProfile::example() };
    let broken = anna.to_toml().replace("radius_mm", "raduis_mm");
    let large = "width_mm = 300\nheight_mm = 200\nvoltage_max_v_rms = 100\n";
    let files = BTreeMap::from([
        ("anna.toml".to_owned(), anna.to_toml().into_bytes()),
        ("broken.toml".to_owned(), broken.into_bytes()),
        ("large.toml".to_owned(), large.as_bytes().to_vec()),
        ("latin.toml".to_owned(), vec![0xff]),
    ]);
    let scene = Scene::parse(text, "test.toml", &files);
    schema::check_agrees(text, mistakes(&scene));
    scene
}

fn program(scene: &Scene) -> Result<Program, CompileError> {
    compile::compile(scene, &LIMITS, TICK_HZ)
}

fn natural_n(scene: Result<Scene, CompileError>) -> f64 {
    program(&scene.expect("it reads")).expect("it compiles").reach.natural_friction_n
}

#[test]
fn an_option_counts_before_what_the_scene_says_and_that_before_the_example() {
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-6, "{found} and not {expected}");
    close(natural_n(parse(SHORT)), 0.25);
    close(natural_n(parse(&format!("{SHORT}{EMBEDDED}"))), 0.2);
    close(natural_n(parse(&format!("{SHORT}finger = \"anna.toml\""))), 0.225);
    close(natural_n(parse(&format!("{SHORT}finger = \"dry\""))), 0.175);
    for text in [SHORT, &format!("{SHORT}{EMBEDDED}"), &format!("{SHORT}finger = \"anna.toml\"")] {
        let moist = FingerProfile::bundled("moist").expect("it is bundled");
        close(natural_n(parse(text).map(|scene| scene.with_finger(moist, "moist"))), 0.4);
    }
}

#[test]
fn of_the_limits_of_the_drive_the_least_counts() {
    let limits = |text: &str| {
        let Header { voltage_max_v_rms, voltage_max_v_peak, slew_v_per_s, .. } =
            program(&parse(text).expect("it reads")).expect("it compiles").header;
        (voltage_max_v_rms, voltage_max_v_peak, slew_v_per_s)
    };
    let screen = |limits: &str| format!("{SHORT}screen = {{ width_mm = 100, height_mm = 80{limits} }}\n");
    let rms = |text: &str| limits(text).0;
    assert_eq!(rms(&screen("")).to_bits(), 150.0_f32.to_bits());
    assert_eq!(rms(&screen(", voltage_max_v_rms = 120")).to_bits(), 120.0_f32.to_bits());
    assert_eq!(rms(&screen(", voltage_max_v_rms = 200")).to_bits(), 150.0_f32.to_bits());
    assert_eq!(rms(&format!("{SHORT}screen = \"large.toml\"")).to_bits(), 100.0_f32.to_bits());
    let drive = "[drive]\nvoltage_max_v_rms = 90\nvoltage_max_v_peak = 130\nslew_v_per_us = 2\n";
    assert_eq!(rms(&format!("{}{drive}", screen(", voltage_max_v_rms = 120"))).to_bits(), 90.0_f32.to_bits());
    let (v_rms, v_peak, _) = limits(&format!("{}{drive}", screen(", voltage_max_v_peak = 60")));
    assert!(v_peak.to_bits() == 60.0_f32.to_bits() && v_rms < 60.0, "{v_rms} V rms, {v_peak} V peak");
    let slew = |limit: &str| limits(&format!("{}{drive}", screen(limit))).2;
    assert_eq!([slew(""), slew(", slew_v_per_us = 1"), slew(", slew_v_per_us = 3")], [2e6, 1e6, 2e6]);
}

fn warnings(text: &str) -> Vec<Warning> {
    let program = program(&parse(text).expect("it reads")).expect("it compiles");
    let warning = |diagnostic: Diagnostic| match diagnostic.message {
        Message::Warning(warning) => Some(warning),
        _ => None,
    };
    program.diagnostics.into_iter().filter_map(warning).collect()
}

/// A measured finger, whose largest voltage and range of loads are given.
fn measured(voltage_max_v_rms: &str, loads: &str, screen: &str) -> String {
    let evidence = format!(
        "origin = \"measured\", date = \"2026-11-22\", method = \"load cell\", screen = \"{screen}\", \
         friction_coefficient_interval = [0.39, 0.41], electric_friction_interval_n = [0.09, 0.11], \
         measured_voltage_max_v_rms = {voltage_max_v_rms}, measured_normal_load_range_n = {loads} }}"
    );
    format!("{SHORT}{}", EMBEDDED.replace(" }", &format!(", {evidence}")))
}

#[test]
fn beyond_what_a_finger_was_measured_at_is_warned_of_and_refused_by_boards() {
    let layer = |high_n: &str| format!("[[layer]]\nkind = \"constant\"\nabove = \"natural\"\nfriction_n = {high_n}\n");
    let [voltage] = &warnings(&format!("{}{}", measured("75", "[0.4, 0.6]", "example"), layer("0.05")))[..] else {
        panic!("one warning")
    };
    let [load] = &warnings(&measured("150", "[0.1, 0.3]", "example"))[..] else { panic!("one warning") };
    assert!(matches!(voltage, Warning::BeyondMeasuredVoltage { .. }) && voltage.is_refused_by_boards());
    assert!(matches!(load, Warning::BeyondMeasuredLoad { .. }) && load.is_refused_by_boards());
    let light = EMBEDDED.replace("normal_load_n = 0.5", "normal_load_n = 0.1");
    let [natural] = &warnings(&format!("{SHORT}{light}{}", layer("0.05")))[..] else { panic!("one warning") };
    assert!(matches!(natural, Warning::ElectricAboveNatural { .. }) && !natural.is_refused_by_boards());
}

fn soft(stress_exponent: f64) -> FingerProfile {
    let elasticity = Elasticity::Soft { modulus_pa: 1e5, stress_exponent, shape_constant: 4.5 };
    FingerProfile { elasticity, ..FingerProfile::example() }
}

#[test]
fn a_soft_finger_plays_on_springs_that_have_its_friction_at_the_largest_voltage() {
    // With a stress exponent of 1/2 a soft finger has one stiffness, and springs are exact.
    let same = Scene::parse(SHORT, "test.toml", &BTreeMap::new()).expect("it reads");
    let program_of = |stress_exponent| program(&same.clone().with_finger(soft(stress_exponent), "soft"));
    let exact = program_of(0.5).expect("it compiles");
    let [note] = &exact.notes().collect::<Vec<_>>()[..] else { panic!("{:?}", exact.diagnostics) };
    assert!(note.ends_with("differ from the soft finger by at most 0.0 % of the reach"), "{note}");
    let near = program_of(0.4).expect("it compiles");
    let finger = frixel_model::SoftFinger {
        radius_m: 8e-3,
        modulus_pa: 1e5,
        stress_exponent: 0.4,
        shape_constant: 4.5,
        friction_coefficient: 0.5,
    };
    let gap_m = 1e-6 * (1.0 / 3.9 + 4.74);
    let contact = finger.on_gap(gap_m).and_then(|contact| contact.under_load(0.5)).expect("it is a finger");
    let expected_n = frixel_model::ContactModel::state(&contact, 150.0).expect("a state").electric_friction_n;
    let found_n = near.header.friction_law().expect("it is a finger").electric_friction_n(150.0);
    assert!((found_n / expected_n - 1.0).abs() < 1e-6, "{found_n} and not {expected_n}");
}

const EMPIRICAL: &str = "[finger]\nfriction_coefficient = 0.4\nnormal_load_n = 0.5\norigin = \"empirical\"\n\
                         date = \"2026-11-23\"\nmethod = \"load cell\"\nscreen = \"example\"\nexponent = 2\n\
                         points = [[50, 0.004], [100, 0.03], [150, 0.09]]\n\
                         intervals_n = [[0.003, 0.005], [0.025, 0.035], [0.08, 0.1]]\n";

#[test]
fn an_empirical_finger_is_compiled_to_its_law() {
    let text = |volts: u32| {
        format!("{SHORT}{EMPIRICAL}[drive]\nvoltage_max_v_rms = {volts}\n{LAYER}").replace("0.3\n", "0.22\n")
    };
    let compiled = program(&parse(&text(150)).expect("it reads")).expect("it compiles");
    assert_eq!((compiled.finger.origin, compiled.finger.origin.newtons_suffix()), (Origin::Empirical, ", empirical"));
    assert!((compiled.reach.natural_friction_n - 0.2).abs() < 1e-6);
    assert!((compiled.reach.electric_friction_max_n - 0.09).abs() < 1e-6, "{:?}", compiled.reach);
    assert!(compiled.features() & feature::EMPIRICAL != 0);
    let bytes = compiled.scene_bytes();
    assert_eq!(frixel_layers::Scene::parse(&bytes).expect("a board reads it").header(), &compiled.header);
    let lower = program(&parse(&text(100)).expect("it reads")).expect("it compiles");
    assert!((lower.reach.electric_friction_max_n - 0.03).abs() < 1e-6, "{:?}", lower.reach);
    assert!(program(&parse(&text(151)).expect("it reads")).is_err());
    let draft = compile::compile_draft(&parse(&text(200)).expect("it reads"), &LIMITS, TICK_HZ).expect("it is drawn");
    assert!(draft.is_draft());
    assert_eq!(draft.header.voltage_max_v_rms.to_bits(), 150.0_f32.to_bits());
}

/// The current is judged at the voltage where the law ends.
#[test]
fn the_drive_ends_with_the_law_before_its_current_is_judged() {
    let text = format!("{SHORT}{EMPIRICAL}{LAYER}").replace("0.3\n", "0.22\n");
    let text = text.replace("[150, 0.09]", "[110, 0.04]").replace("[0.08, 0.1]", "[0.03, 0.05]");
    let at_law_end = Carrier {
        waveform: Waveform::Square,
        half_period_s: 5e-4,
        half_period_ticks: 20,
        edge_time_constant_s: LIMITS.edge_time_constant_s,
    };
    let current = at_law_end.electrode_current(LIMITS.electrode_capacitance_max_f, 120.0 * at_law_end.peak_per_rms());
    let limits = BoardLimits { current_max_a_rms: current.a_rms, ..LIMITS };
    let scene = parse(&text).expect("it reads");
    let program = compile::compile(&scene, &limits, TICK_HZ).expect("it compiles");
    assert_eq!(program.header.voltage_max_v_rms.to_bits(), 110.0_f32.to_bits());
}
