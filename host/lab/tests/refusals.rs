//! Each rule of refusal: good data are accepted, and one thing wrong with them is refused in a sentence that says what
//! was found and what to do.

use frixel_lab::fit::{self, Fit, FitError, Row, Settings, Verdict};

use super::person::{Person, Protocol};
use super::tally::settings;

fn example() -> Vec<Row> {
    Person::example(3).record(&Protocol::default())
}

fn fit_of(rows: Vec<Row>) -> Result<Fit, FitError> {
    fit::fit(rows, &settings())
}

/// Fits the example after a change, and checks that the refusal has these words.
fn refused(change: impl Fn(&mut Row), words: &[&str]) {
    let mut rows = example();
    rows.iter_mut().for_each(change);
    says(fit_of(rows), words);
}

fn says(result: Result<Fit, FitError>, words: &[&str]) {
    let message = match result {
        Ok(fit) => panic!("expected {words:?}, found a fit: {:?}", fit.electric_friction_n),
        Err(error) => error.to_string(),
    };
    assert!(words.iter().all(|word| message.contains(word)), "{message} has not {words:?}");
    assert!(!message.contains(". "), "one sentence: {message}");
}

fn is_stroke(row: &Row, stroke: &str) -> bool {
    row.stroke.as_deref() == Some(stroke)
}

#[test]
fn good_data_are_accepted_and_give_the_example_back() {
    let fit = fit_of(example()).unwrap();
    assert!((fit.friction_coefficient.value / 0.5 - 1.0).abs() < 0.05);
    assert!((fit.electric_friction_n.value / 0.1298 - 1.0).abs() < 0.03, "{:?}", fit.electric_friction_n);
    assert!((fit.skin_gap_m - 4.74e-6).abs() < 0.15e-6, "{}", fit.skin_gap_m);
    assert_eq!(fit.voltage_exponent.verdict, Verdict::Kept);
    assert!(fit.voltage_exponent.measured.low > 2.1, "{:?}", fit.voltage_exponent);
}

#[test]
fn a_force_that_no_finger_has_is_refused_by_its_row() {
    let mut rows = example();
    rows[700].friction_n = 200.0;
    let hint = "200 N is not a valid force of a finger";
    says(fit::fit(rows, &settings()), &["row 702, column friction_n", hint, "friction_mn"]);
}

/// A rectified carrier of 125 Hz, as a data logger samples it. Without the rule, it is fitted for a minute, or taken.
#[test]
fn samples_of_the_carrier_are_refused() {
    let carrier = |row: &mut Row| {
        let time_s = row.time_s.unwrap();
        row.voltage_v_rms *= std::f64::consts::SQRT_2 * (std::f64::consts::TAU * 125.0 * time_s).sin().abs();
    };
    refused(carrier, &["look like samples of the carrier", "root mean square"]);
    let without_times = |row: &mut Row| {
        carrier(row);
        row.time_s = None;
    };
    refused(without_times, &["look like samples of the carrier"]);
}

#[test]
fn loads_and_units() {
    refused(|row| row.normal_force_n = 0.0, &["is zero throughout", "load cell"]);
    refused(|row| row.normal_force_n *= 1e3, &["millinewtons", "give newtons"]);
    refused(|row| row.normal_force_n *= 20.0, &["kilopascals", "contact area"]);
    refused(|row| row.friction_n *= 1e3, &["friction looks like millinewtons"]);
    refused(|row| row.normal_force_n *= -1.0, &["wrong sign"]);
}

#[test]
fn a_load_that_is_off_by_more_than_15_percent() {
    let heavier = |row: &mut Row| {
        if is_stroke(row, "5") {
            row.normal_force_n *= 1.25;
            row.friction_n *= 1.25;
        }
    };
    let mut rows = example();
    rows.iter_mut().for_each(heavier);
    let left_out = fit_of(rows.clone()).unwrap().data.preparation.notes(fit::Division::Column);
    assert!(left_out[0].contains("stroke 5 left out") && left_out[0].contains("% off the median load"), "{left_out:?}");
    let settings = Settings { without: vec!["5".to_owned()], ..settings() };
    assert_eq!(fit::fit(rows.clone(), &settings).unwrap().strokes.len(), 35);
    let settings = Settings { without: vec!["77".to_owned()], ..settings };
    says(fit::fit(rows, &settings), &["--without 77", "1 to 36"]);
}

#[test]
fn speeds_and_slip() {
    let speed = |stroke: &'static str, factor: f64| {
        move |row: &mut Row| {
            if is_stroke(row, stroke) {
                row.speed_mm_s = row.speed_mm_s.map(|speed| factor * speed);
            }
        }
    };
    for factor in [4.0, 0.2] {
        let mut rows = example();
        rows.iter_mut().for_each(speed("4", factor));
        let left_out = fit_of(rows).unwrap().data.preparation.notes(fit::Division::Column);
        assert!(
            left_out[0].contains("stroke 4 left out") && left_out[0].contains("outside 20 to 100 mm/s"),
            "{left_out:?}"
        );
    }
    refused(speed("9", 0.0), &["stroke 9 did not slip", "0.0 mm/s"]);
    // A finger that sticks: it is pulled with less force than slipping takes, or the drive has no effect.
    let pulled = |row: &mut Row| {
        if is_stroke(row, "6") {
            row.friction_n *= 0.4;
        }
    };
    refused(pulled, &["stroke 6 did not slip", "friction over load"]);
    let without_effect = |row: &mut Row| {
        if is_stroke(row, "6") {
            row.friction_n = 0.5 * row.normal_force_n;
        }
    };
    refused(without_effect, &["stroke 6 did not slip", "the drive added"]);
}

#[test]
fn all_strokes_with_faults_are_named_at_once() {
    let change = |row: &mut Row| match row.stroke.as_deref() {
        Some("3") => row.speed_mm_s = row.speed_mm_s.map(|speed| 4.0 * speed),
        Some("7") => {
            row.normal_force_n *= 1.25;
            row.friction_n *= 1.25;
        }
        Some("11") => row.friction_n *= 0.4,
        Some("20") => row.friction_n = 0.5 * row.normal_force_n,
        _ => (),
    };
    let words = ["stroke 3: its speed", "stroke 7: its load", "stroke 11 did not slip", "stroke 20 did not slip"];
    refused(change, &[&words[..], &["--without 3,7,11,20"]].concat());
    let mut rows = example();
    rows.iter_mut().for_each(change);
    let settings = Settings { without: ["3", "7", "11", "20"].map(str::to_owned).to_vec(), ..settings() };
    assert_eq!(fit::fit(rows, &settings).unwrap().strokes.len(), 32);
    let fast = |row: &mut Row| row.speed_mm_s = row.speed_mm_s.map(|speed| 4.0 * speed);
    refused(fast, &["and 30 more", "--without 1,2,3,", "35,36"]);
}

#[test]
fn voltages() {
    refused(|row| row.voltage_v_rms = 0.0, &["the voltage is zero throughout"]);
    refused(|row| row.voltage_v_rms = 150.0, &["only one voltage"]);
    refused(|row| row.voltage_v_rms = if row.voltage_v_rms > 0.0 { 150.0 } else { 0.0 }, &["only one voltage", "106"]);
    refused(|row| row.voltage_v_rms = row.voltage_v_rms.max(50.0), &["no row has a voltage of zero"]);
    refused(|row| row.voltage_v_rms *= 0.8, &["the data end at 120.0 V rms", "--voltage 120"]);
    // Voltage and friction that do not belong together.
    refused(|row| row.friction_n = 0.5 * row.normal_force_n, &["adds no friction"]);
}

#[test]
fn friction_is_stated_where_it_was_measured() {
    let mut rows = example();
    for row in &mut rows {
        row.voltage_v_rms *= 0.6;
    }
    let fit = fit::fit(rows, &Settings { voltage_v_rms: 90.0, ..settings() }).unwrap();
    assert_eq!(fit.voltage_exponent.verdict, Verdict::None, "below 100 V rms there is no verdict");
    assert!(fit.json()["electric_friction_150_v_n"].is_null());
    assert!((fit.electric_friction_n.value / 0.1298 - 1.0).abs() < 0.03);
    let settings = Settings { normal_load_n: Some(0.8), ..settings() };
    says(fit::fit(example(), &settings), &["0.8 N would be extrapolated", "leave out --load"]);
}

#[test]
fn time_and_length() {
    let mut rows = example();
    rows[900].time_s = rows[800].time_s;
    says(fit_of(rows), &["row 902, column time_s", "time goes backwards"]);
    let short = Protocol { stroke_s: 0.3, length_mm: 15.0, ..Protocol::default() };
    says(fit_of(Person::example(1).record(&short)), &["stroke 1 is too short (0.299 s)", "0.4 s"]);
    let few = Protocol { strokes: 5, ..Protocol::default() };
    says(fit_of(Person::example(1).record(&few)), &["5 strokes are too few"]);
    says(fit_of(Vec::new()), &["0 strokes are too few"]);
}

#[test]
fn a_finger_that_changes() {
    let grown = Person { drift: 0.6, ..Person::example(1) };
    says(fit_of(grown.record(&Protocol::default())), &["first third", "the finger changed"]);
    // The same friction coefficient, and an attraction that halves.
    let mut rows = example();
    let natural = |row: &Row| 0.5 * row.normal_force_n;
    for row in rows.iter_mut().filter(|row| row.time_s.unwrap() > 32.0) {
        row.friction_n = natural(row) + 0.5 * (row.friction_n - natural(row));
    }
    says(fit_of(rows), &["electric friction", "first third"]);
}

#[test]
fn an_interval_that_is_too_wide() {
    let noisy = Person { noise_share: 0.5, ..Person::example(2) };
    let protocol = Protocol { strokes: 12, ..Protocol::default() };
    says(fit_of(noisy.record(&protocol)), &["95 % interval", "+-20 %", "more strokes"]);
}

#[test]
fn a_screen_whose_coating_is_thicker_than_the_fitted_gap() {
    let settings = Settings { coating_gap_m: 6e-6, ..settings() };
    says(fit::fit(example(), &settings), &["the coating alone has 6.000 um"]);
}

#[test]
fn without_strokes_rows_are_divided_by_motion_or_in_blocks() {
    let mut rows = example();
    for row in &mut rows {
        row.stroke = None;
    }
    let fit = fit_of(rows.clone()).unwrap();
    assert_eq!((fit.data.division, fit.strokes.len()), (fit::Division::Motion, 36));
    for row in &mut rows {
        (row.time_s, row.speed_mm_s) = (None, None);
    }
    // Steady sliding only: without time and speed, starts and turns cannot be left out.
    let rows: Vec<Row> = rows.chunks(1600).flat_map(|stroke| &stroke[300..1300]).cloned().collect();
    let fit = fit_of(rows).unwrap();
    assert_eq!((fit.data.division, fit.strokes.len()), (fit::Division::Blocks, 24));
    assert!((fit.electric_friction_n.value / 0.1298 - 1.0).abs() < 0.05, "{:?}", fit.electric_friction_n);
    // Friction with a sign, as a sensor gives it for strokes back and forth.
    let mut rows = example();
    for row in &mut rows {
        row.stroke = None;
        row.friction_n =
            if ((row.time_s.unwrap() / 1.8) as u32).is_multiple_of(2) { row.friction_n } else { -row.friction_n };
    }
    assert_eq!(fit_of(rows).unwrap().strokes.len(), 36);
}

/// Of a ramp, each stroke has a voltage of its own; of two voltages, one has two strokes only.
#[test]
fn few_strokes_near_the_highest_voltage_are_refused_and_a_ramp_is_not() {
    let voltages_v_rms = |strokes: usize, of: &dyn Fn(usize) -> f64| (0..strokes).map(of).collect::<Vec<_>>();
    let ramp =
        Protocol { voltages_v_rms: voltages_v_rms(36, &|stroke| 60.0 + 2.5 * stroke as f64), ..Protocol::default() };
    let fit = fit_of(Person::example(1).record(&ramp)).unwrap();
    assert!((fit.electric_friction_n.value / 0.1298 - 1.0).abs() < 0.06, "{:?}", fit.electric_friction_n);
    let two = Protocol {
        voltages_v_rms: voltages_v_rms(26, &|stroke| if stroke < 24 { 75.0 } else { 150.0 }),
        strokes: 26,
        ..Protocol::default()
    };
    says(fit_of(Person::example(1).record(&two)), &["2 of the strokes are at 150 V rms", "at least 3"]);
}
