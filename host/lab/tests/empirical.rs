//! Laws of the voltage that need no model, for fingers that the contact model does not describe.

use std::fmt::Write;

use frixel_lab::fit::{
    Data, EmpiricalFit, Estimate, FitError, HeldOutError, Row, VoltageLaw, data, fit, fit_empirical,
};
use frixel_play::TO_THE_END;
use frixel_scene::{Experiment, FingerProfile, Profile};

use super::person::{Law, Person, Protocol};
use super::tally::settings;

/// Recordings for each exponent.
const SEEDS: u64 = 3;

fn contains(estimate: &Estimate, truth: f64) -> bool {
    (estimate.low..=estimate.high).contains(&truth)
}

fn person(exponent: f64, seed: u64) -> Person {
    Person { law: Law::Power { voltage: exponent, load: 1.0 }, ..Person::example(seed) }
}

fn record(exponent: f64) -> Vec<Row> {
    person(exponent, 1).record(&Protocol::default())
}

fn exponent_of(fit: &EmpiricalFit) -> Estimate {
    match fit.law {
        VoltageLaw::Power { exponent } => exponent,
        VoltageLaw::Points { .. } => panic!("no power law: {fit:?}"),
    }
}

fn empirical(rows: Vec<Row>) -> Result<EmpiricalFit, FitError> {
    fit_empirical(Data::Recording(rows), &settings(), TO_THE_END)
}

/// Of 18 intervals of 95 %, four or more miss the truth in one set of seeds in 90.
#[test]
fn powers_of_the_voltage_are_recovered_where_the_contact_model_is_refused() {
    let (mut missed_friction, mut missed_exponent) = (0, 0);
    for exponent in [1.0, 1.5, 2.0, 3.5, 4.5, 6.0] {
        for seed in 0..SEEDS {
            let person = person(exponent, seed);
            let rows = person.record(&Protocol::default());
            if !(1.5..=3.5).contains(&exponent) {
                let refused = fit(rows.clone(), &settings()).unwrap_err().to_string();
                assert!(refused.contains("--law empirical"), "{exponent}: {refused}");
            }
            let fit = empirical(rows).unwrap_or_else(|error| panic!("{exponent}: {error}"));
            let (_, truth_n) = person.truth(fit.data.normal_load_n);
            missed_friction += u32::from(!contains(&fit.highest.electric_friction_n, truth_n));
            missed_exponent += u32::from(!contains(&exponent_of(&fit), exponent));
            assert!((fit.highest.electric_friction_n.value / truth_n - 1.0).abs() < 0.03, "{exponent}: {fit:?}");
            let HeldOutError { rms_n, mean_friction_n } = fit.held_out.unwrap();
            assert!(rms_n < 0.1 * mean_friction_n, "{rms_n} of {mean_friction_n}");
        }
    }
    assert!(missed_friction <= 3 && missed_exponent <= 3, "{missed_friction} and {missed_exponent} of 18");
}

#[test]
fn a_profile_of_either_law_is_read_again() {
    let experiment = Experiment { date: "2026-11-23".into(), method: "load cell".into(), screen: "example".into() };
    let points = empirical(bent(1, [37.0, 111.0, 150.0]).1).unwrap();
    assert!(points.words().contains("points that power laws join"), "{}", points.words());
    assert_eq!(points.json()["points"].as_array().map(Vec::len), Some(3));
    for fit in [empirical(record(4.0)).unwrap(), points] {
        let profile = fit.profile(experiment.clone());
        assert_eq!(FingerProfile::parse(profile.to_toml(), "finger.toml").as_ref(), Ok(&profile));
    }
}

/// A program reads the keys of `--json` whatever the law is.
#[test]
fn the_keys_of_a_fit_are_there_for_every_law() {
    let keys = |value: &serde_json::Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    let rows = Person::example(1).record(&Protocol::default());
    let summary = fit(rows.clone(), &settings()).unwrap().json();
    for json in [empirical(rows).unwrap().json(), empirical(bent(1, [37.0, 111.0, 150.0]).1).unwrap().json()] {
        let missing: Vec<_> = keys(&summary).into_iter().filter(|key| json.get(key).is_none()).collect();
        assert!(missing.is_empty(), "{missing:?}");
        assert_eq!((&json["law"], &json["division"]), (&"empirical".into(), &"column".into()));
        assert!(json["electric_friction_150_v_n"].is_f64() && json["rows"].as_u64() > Some(10_000), "{json}");
    }
}

#[test]
fn equal_loads_and_a_small_friction_coefficient_are_no_obstacle() {
    let person = Person { load_share: 0.0, friction_coefficient: 0.1, ..person(2.0, 1) };
    let rows = person.record(&Protocol::default()).into_iter();
    let fit = empirical(rows.map(|row| Row { normal_force_n: person.load_n, ..row }).collect()).unwrap();
    assert!((fit.data.normal_load_n - person.load_n).abs() < 1e-12);
    assert!((fit.friction_coefficient.value / 0.1 - 1.0).abs() < 0.05, "{fit:?}");
}

/// The friction coefficient is that of the law, not that of a model which lies beside the means.
#[test]
fn means_have_a_power_law_with_its_friction_coefficient_too() {
    for exponent in [4.0, 6.0] {
        let mut csv = String::from("voltage_v_rms,normal_force_n,friction_n,friction_se_n\n");
        for volts in [0.0_f64, 60.0, 80.0, 106.0, 150.0] {
            let friction_n = 0.25 + 0.1 * (volts / 150.0).powf(exponent);
            writeln!(csv, "{volts},0.5,{friction_n},0.001").unwrap();
        }
        let fit = fit_empirical(data(csv.as_bytes()).unwrap().value, &settings(), TO_THE_END).unwrap();
        assert!(contains(&exponent_of(&fit), exponent) && contains(&fit.highest.electric_friction_n, 0.1), "{fit:?}");
        assert_eq!((fit.strokes, fit.held_out), (5, None));
        assert!((fit.friction_coefficient.value - 0.5).abs() < 1e-3, "{:?}", fit.friction_coefficient);
    }
}

/// At half of the voltage such a finger has 1 % of the friction or less, as little as noise: no stroke of it stuck.
#[test]
fn a_steep_law_is_no_finger_that_sticks() {
    for exponent in [7.0, 9.0] {
        for seed in 0..SEEDS {
            let rows = person(exponent, seed).record(&Protocol::default());
            let refused = fit(rows.clone(), &settings()).unwrap_err().to_string();
            assert!(refused.contains("--law empirical"), "{exponent}: {refused}");
            let fit = empirical(rows).unwrap_or_else(|error| panic!("{exponent}: {error}"));
            assert!((exponent_of(&fit).value / exponent - 1.0).abs() < 0.05, "{exponent}: {fit:?}");
        }
    }
}

/// A person whose friction at three voltages is that of a square law at others.
fn bent(seed: u64, at_v_rms: [f64; 3]) -> (Person, Vec<Row>) {
    let person = person(2.0, seed);
    let mut rows = person.record(&Protocol { voltages_v_rms: at_v_rms.to_vec(), ..Protocol::default() });
    for row in &mut rows {
        let place = at_v_rms.iter().position(|volts| (row.voltage_v_rms - volts).abs() < 1e-9);
        row.voltage_v_rms = place.map_or(0.0, |place| [75.0, 106.0, 150.0][place]);
    }
    (person, rows)
}

/// A steep step and a saturation: from 75 to 106 V friction grows by 9 or by 6, and to 150 V by 1.8 or 1.4.
#[test]
fn a_finger_without_a_power_law_has_the_points_that_were_measured() {
    let mut missed = 0;
    for at_v_rms in [[37.0, 111.0, 150.0], [50.0, 125.0, 150.0]] {
        for seed in 0..SEEDS {
            let (person, rows) = bent(seed, at_v_rms);
            let fit = empirical(rows).unwrap();
            let VoltageLaw::Points { below, exponent } = &fit.law else { panic!("{fit:?}") };
            assert_eq!((below.len(), *exponent), (2, 2.0));
            for (point, volts) in below.iter().chain([&fit.highest]).zip(at_v_rms) {
                let truth_n = person.truth(fit.data.normal_load_n).1 * (volts / 150.0).powi(2);
                missed += u32::from(!contains(&point.electric_friction_n, truth_n));
                assert!((point.electric_friction_n.value / truth_n - 1.0).abs() < 0.1, "{volts}: {point:?}");
            }
            let HeldOutError { rms_n, mean_friction_n } = fit.held_out.unwrap();
            assert!(rms_n < 0.1 * mean_friction_n, "{rms_n} of {mean_friction_n}");
        }
    }
    // Of 18 intervals of 95 %, four or more miss the truth in one set of seeds in 90.
    assert!(missed <= 3, "{missed} of 18");
}

/// What is too small to measure at 75 V makes the law below 106 V as steep as a profile can have it.
#[test]
fn friction_below_the_noise_is_no_point() {
    let fit = empirical(bent(1, [0.5, 111.0, 150.0]).1).unwrap();
    let VoltageLaw::Points { below, exponent } = &fit.law else { panic!("{fit:?}") };
    assert_eq!((below.len(), *exponent), (1, 12.0));
}

#[test]
fn friction_that_does_not_rise_ends_the_law() {
    let said = empirical(bent(1, [60.0, 148.0, 150.0]).1).unwrap_err().to_string();
    assert!(said.contains("from 106 to 150 V rms") && said.contains("--without"), "{said}");
}

#[test]
fn data_without_a_law_are_refused() {
    let refused = |rows: Vec<Row>| empirical(rows).unwrap_err().to_string();
    // One voltage, and voltages that differ by less than a law can be told from.
    for voltages_v_rms in [vec![150.0], vec![148.0, 150.0]] {
        let said = refused(person(2.0, 1).record(&Protocol { voltages_v_rms, ..Protocol::default() }));
        assert!(said.contains("150 V rms"), "{said}");
    }
    // Kilovolts that are called volts: no law may end at 0.15 V.
    let mut kilovolts = record(2.0);
    for row in &mut kilovolts {
        row.voltage_v_rms *= 1e-3;
    }
    assert!(refused(kilovolts).contains("voltage_kv_rms"));
    // A friction coefficient near zero, which no finger on glass has.
    let mut smooth = record(2.0);
    for row in &mut smooth {
        row.friction_n *= 1e-2;
    }
    assert!(refused(smooth).contains("is not in newtons"));
    // A drive that does nothing.
    let nothing = record(2.0).into_iter().map(|row| Row { friction_n: 0.5 * row.normal_force_n, ..row });
    let said = refused(nothing.collect());
    assert!(said.contains("the voltage adds no friction"), "{said}");
}
