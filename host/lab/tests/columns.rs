//! Tables as others record and write them give the finger that made them: 0.5, and 70 mN at 150 V under 0.5 N.

use std::fmt::Write as _;

use frixel_lab::fit::{self, Fit, FitError, Row, words};
use proptest::prelude::*;

use super::person::Random;
use super::tally::settings;

/// A smooth law of the voltage near that of the contact model under a load.
fn electric_n(voltage_v_rms: f64) -> f64 {
    0.07 * (voltage_v_rms / 150.0).powf(2.15)
}

/// Strokes of 1.4 s, 1,000 rows a second, with the drive on in every second 25 rows.
fn strokes(seed: u64, count: usize) -> Vec<Row> {
    let mut random = Random::new(seed);
    let mut rows = Vec::new();
    for stroke in 1..=count {
        for index in 0..1400 {
            let on_v_rms = [75.0, 106.0, 150.0][stroke % 3];
            let voltage_v_rms = if index / 25 % 2 == 1 { on_v_rms } else { 0.0 };
            let normal_force_n = 0.5 + 0.005 * random.gaussian();
            rows.push(Row {
                number: rows.len() as u64 + 2,
                voltage_v_rms,
                normal_force_n,
                friction_n: 0.5 * normal_force_n + electric_n(voltage_v_rms) + 0.004 * random.gaussian(),
                time_s: Some(3.0 * stroke as f64 + 1e-3 * f64::from(index)),
                stroke: Some(stroke.to_string()),
                speed_mm_s: Some(60.0),
                is_simulated: false,
            });
        }
    }
    rows
}

fn csv(rows: &[Row]) -> String {
    let mut text = "time_s,stroke,voltage_v_rms,normal_force_n,friction_n,speed_mm_s\n".to_owned();
    for row in rows {
        let (time_s, speed_mm_s) = (row.time_s.unwrap(), row.speed_mm_s.unwrap());
        let (stroke, volts, load_n) = (row.stroke.as_deref().unwrap(), row.voltage_v_rms, row.normal_force_n);
        writeln!(text, "{time_s:.3},{stroke},{volts},{load_n:.4},{:.5},{speed_mm_s}", row.friction_n).unwrap();
    }
    text
}

fn fit_of(rows: Vec<Row>) -> Result<Fit, FitError> {
    fit::fit(rows, &settings())
}

/// Checks that a fit is that of the finger, and returns it in words.
fn right(fit: Result<Fit, FitError>) -> String {
    let fit = fit.unwrap_or_else(|error| panic!("{error}"));
    assert!((fit.friction_coefficient.value - 0.5).abs() < 0.005, "{:?}", fit.friction_coefficient);
    let electric = fit.electric_friction_n;
    assert!((electric.value - 0.07).abs() < 0.0021 && electric.high - electric.low < 0.006, "{electric:?}");
    words(&fit, "example")
}

/// The last part of each stroke is the way back, `pause_s` later.
fn with_turns(mut rows: Vec<Row>, part: f64, pause_s: f64) -> Vec<Row> {
    for (index, row) in rows.iter_mut().enumerate() {
        if (index % 1400) as f64 >= 1400.0 * (1.0 - part) {
            row.time_s = row.time_s.map(|time_s| time_s + pause_s);
            row.friction_n = -row.friction_n;
            row.speed_mm_s = row.speed_mm_s.map(|speed_mm_s| -speed_mm_s);
        }
    }
    rows
}

#[test]
fn strokes_that_turn_are_divided_there() {
    for (part, pause_s) in [(0.3, 0.3), (0.1, 0.0), (0.5, 0.0)] {
        right(fit_of(with_turns(strokes(1, 24), part, pause_s)));
    }
    let mut rows = with_turns(strokes(1, 24), 0.3, 0.0);
    for row in &mut rows {
        row.time_s = None;
    }
    let said = fit_of(rows).unwrap_err().to_string();
    assert!(
        said.starts_with("row 982: the finger turns within stroke 1") && said.contains("add a column time_s"),
        "{said}"
    );
}

/// Before each stroke the sensor rests for 0.3 s.
fn untared(rest: impl Fn(usize, usize) -> [f64; 2]) -> Vec<Row> {
    let mut rows = Vec::new();
    for (stroke, sliding) in strokes(4, 24).chunks(1400).enumerate() {
        for index in 0..300 {
            let [normal_force_n, friction_n] = rest(stroke, index);
            let time_s = sliding[0].time_s.map(|time_s| time_s - 0.301 + 1e-3 * index as f64);
            rows.push(Row {
                voltage_v_rms: 0.0,
                normal_force_n,
                friction_n,
                time_s,
                speed_mm_s: Some(0.0),
                ..sliding[0].clone()
            });
        }
        let tare = |row: &Row| Row {
            normal_force_n: row.normal_force_n + 0.15,
            friction_n: row.friction_n + 0.06,
            ..row.clone()
        };
        rows.extend(sliding.iter().map(tare));
    }
    rows
}

#[test]
fn rows_without_contact_show_the_zero_of_the_sensor() {
    let said = right(fit_of(untared(|_, _| [0.15, 0.06])));
    let note = "the sensor's zero was taken from 4.8 s without contact: 0.150 N of load, 0.060 N of friction";
    assert!(said.contains(note), "{said}");
    let said = right(fit_of(strokes(4, 24)));
    assert!(said.contains("a sensor that was not tared shifts the friction coefficient"), "{said}");
    // A finger that rests with another load each time is not a zero.
    let resting = fit_of(untared(|stroke, _| [0.15 + 0.005 * stroke as f64, 0.06])).unwrap();
    assert_eq!(resting.data.preparation.sensor_zero, None);
}

#[test]
fn rows_that_were_copied_are_refused() {
    let rows = strokes(1, 12);
    let copy = rows.iter().cloned().map(|row| Row {
        number: row.number + 16800,
        stroke: row.stroke.map(|name| name + "b"),
        ..row
    });
    let said = fit_of(rows.iter().cloned().chain(copy).collect()).unwrap_err().to_string();
    assert!(said.starts_with("rows 16802 to 33601 repeat rows 2 to 16801: delete the copy"), "{said}");
}

#[test]
fn an_unknown_speed_is_none() {
    let text = csv(&strokes(6, 2)).replace(",60\n", ",nan\n");
    let rows = fit::rows(text.as_bytes()).unwrap().value;
    assert!(rows.len() == 2800 && rows.iter().all(|row| row.speed_mm_s.is_none()));
}

/// A time that is unknown leaves its row out, and no more.
#[test]
fn a_row_without_a_time_is_left_out_and_many_are_refused() {
    let without = |every: usize| {
        let mut rows = untared(|_, _| [0.15, 0.06]);
        rows.iter_mut().skip(777).step_by(every).for_each(|row| row.time_s = None);
        fit_of(rows)
    };
    let said = right(without(50_000));
    assert!(said.contains("note: 1 row without a time left out") && said.contains("zero was taken from"), "{said}");
    let said = right(without(1000));
    assert!(said.contains("note: 41 rows without a time left out") && said.contains("zero was taken from"), "{said}");
    let said = without(9).unwrap_err().to_string();
    assert!(said.starts_with("4447 of 40800 rows have no time, the first of them row 479"), "{said}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A file and rows of a program are validated by the same rule.
    #[test]
    fn a_number_that_is_missing_is_named_by_row_and_column(index in 0_usize..200, column in 0_usize..3) {
        let mut rows = strokes(1, 1);
        rows.truncate(200);
        let name = ["voltage_v_rms", "normal_force_n", "friction_n"][column];
        let row = &mut rows[index];
        *[&mut row.voltage_v_rms, &mut row.normal_force_n, &mut row.friction_n][column] = f64::NAN;
        let expected = format!("row {}, column {name}: expected a number, found \"NaN\": correct the cell or delete the row", index + 2);
        prop_assert_eq!(fit::rows(csv(&rows).as_bytes()).unwrap_err().to_string(), expected.clone());
        prop_assert_eq!(fit_of(rows).unwrap_err().to_string(), expected);
    }
}
