//! What the figures say is what the paper says, and what the design was chosen by.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::{BTreeMap, HashMap};
use std::sync::OnceLock;

use super::Figure;

type Row = HashMap<String, String>;

/// The figures, which are computed once for all tests.
fn figures() -> &'static [Figure; 8] {
    static FIGURES: OnceLock<[Figure; 8]> = OnceLock::new();
    FIGURES.get_or_init(|| super::figures().unwrap())
}

/// The numbers behind a figure.
fn rows(name: &str) -> Vec<Row> {
    let figure = figures().iter().find(|figure| figure.name == name).unwrap();
    let mut reader = csv::Reader::from_reader(figure.csv.as_slice());
    let header = reader.headers().unwrap().clone();
    let row =
        |record: csv::StringRecord| header.iter().map(str::to_owned).zip(record.iter().map(str::to_owned)).collect();
    reader.records().map(|record| row(record.unwrap())).collect()
}

fn number(row: &Row, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
}

/// Rows of one curve, as pairs of numbers.
fn curve(rows: &[Row], is: &[(&str, &str)], x: &str, y: &str) -> Vec<(f64, f64)> {
    let of_curve = rows.iter().filter(|row| is.iter().all(|(column, value)| row[*column] == *value));
    let points: Vec<_> = of_curve.map(|row| (number(row, x), number(row, y))).collect();
    assert!(points.len() > 2, "{is:?}");
    points
}

/// Slope of ln y over ln x between two neighbours.
fn slope(pair: &[(f64, f64)]) -> f64 {
    (pair[1].1 / pair[0].1).ln() / (pair[1].0 / pair[0].0).ln()
}

#[test]
fn without_a_load_all_fingers_stand_on_one_line_of_slope_one_and_two() {
    let rows = rows("fig3-core-line");
    let mut fingers = BTreeMap::new();
    for row in &rows {
        // The dimensionless form of Eqs. (36), (34).
        let q = number(row, "voltage_over_scale").powi(2);
        let y = q + (q * q + 2.0 * q / (1.0 + q)).sqrt();
        for (column, right) in [("radius_over_scale", y.sqrt()), ("friction_over_scale", y * y)] {
            assert!((number(row, column) - right).abs() <= 1e-13 * right, "{column}: {row:?}");
        }
        *fingers.entry(row["finger"].as_str()).or_insert(0) += 1;
    }
    assert_eq!(fingers.into_values().collect::<Vec<_>>(), [8, 8, 8, 161 + 101]);
    let line = rows.iter().filter(|row| row["finger"] == "core line").take(161);
    let line: Vec<_> =
        line.map(|row| (number(row, "voltage_over_scale").powi(2), number(row, "friction_over_scale"))).collect();
    assert!((slope(&line[..2]) - 1.0).abs() < 0.02, "Eqs. (34), (36) at small sigma0: {}", slope(&line[..2]));
    assert!((slope(&line[159..]) - 2.0).abs() < 0.02, "and at large: {}", slope(&line[159..]));
    assert!(line.windows(2).all(|pair| slope(pair) > 1.0 && slope(pair) < 2.0));
}

#[test]
fn bounds_enclose_what_lies_between_and_part_where_voltage_is_small() {
    let rows = rows("upper-and-lower-bound");
    let bound =
        |name| curve(&rows, &[("bound", name), ("normal_force_n", "0")], "voltage_v_rms", "electric_friction_n");
    let (upper, lower) = (bound("upper"), bound("lower"));
    // Over sigma0, which is the voltage's square.
    assert!(lower.windows(2).all(|pair| (slope(pair) / 2.0 - 2.0).abs() < 1e-9), "Eq. (42) has slope 2");
    assert!((slope(&upper[..2]) / 2.0 - 1.0).abs() < 0.02);
    assert!(upper.iter().zip(&lower).all(|(upper, lower)| upper.1 > lower.1));
    for outer in ["0.001", "0.0005", "0.0002"] {
        let is = [("bound", "finite"), ("outer_radius_m", outer)];
        let finite = curve(&rows, &is, "voltage_v_rms", "electric_friction_n");
        assert!(finite.len() < upper.len(), "it would pass the outer radius at last");
        for ((finite, upper), lower) in finite.iter().zip(&upper).zip(&lower) {
            assert!(upper.1 > finite.1 && finite.1 > lower.1 * (1.0 - 1e-9), "{outer} {finite:?}");
        }
    }
}

#[test]
fn curves_of_a_pull_begin_at_pull_off_and_all_rise() {
    let (radii, frictions) = (rows("fig4-contact-radius-under-load"), rows("fig5-friction-under-load"));
    let mut last = Vec::new();
    for load in ["-20", "-10", "-5", "-1", "0", "1", "5", "10", "20"] {
        let is = [("panel", "relative"), ("relative_normal_force", load)];
        let radius = curve(&radii, &is, "voltage_over_scale", "radius_over_scale");
        let friction = curve(&frictions, &is, "voltage_over_scale", "friction_over_scale");
        // y = q there, which is where the root of the balance is double: half the digits are lost.
        let (voltage, start) = radius[0];
        if load.starts_with('-') {
            assert!((start / voltage - 1.0).abs() < 1e-4, "{load}: {voltage} {start}");
        } else {
            assert!(voltage.abs() < f64::MIN_POSITIVE);
        }
        for points in [&radius, &friction] {
            assert!(points.windows(2).all(|pair| pair[1].1 > pair[0].1), "{load} rises");
        }
        for (radius, friction) in radius.iter().zip(&friction) {
            assert!((radius.1.powi(4) - friction.1).abs() <= 1e-12 * friction.1, "Eq. (21)");
        }
        last.push(friction[friction.len() - 1].1);
    }
    assert!(last.windows(2).all(|pair| pair[1] > pair[0]), "more load, more friction");
}

#[test]
fn soft_fingers_have_their_powers_and_one_of_them_is_winkler_fuss() {
    let rows = rows("soft-finger");
    let pair = |name, exponent| {
        curve(&rows, &[("finger", name), ("stress_exponent", exponent)], "voltage_v_rms", "electric_friction_n")
    };
    for exponent in ["0.1", "0.3", "0.5", "0.75", "1"] {
        let power = 2.0 * exponent.parse::<f64>().unwrap() + 1.0;
        let lower = pair("soft-lower", exponent);
        assert!(lower.windows(2).all(|pair| (slope(pair) / 2.0 - power).abs() < 1e-9), "Eq. (40) at {exponent}");
        assert!(pair("soft-upper", exponent).iter().zip(&lower).all(|(upper, lower)| upper.1 > lower.1));
    }
    for (soft, springs) in [("soft-upper", "wf-upper"), ("soft-loaded", "wf-loaded")] {
        for (soft, springs) in pair(soft, "0.5").iter().zip(pair(springs, "")) {
            assert!((soft.1 / springs.1 - 1.0).abs() < 1e-12, "{soft:?} {springs:?}");
        }
    }
}

/// The board's filter is better than the one before it for every class and hand, within a half of the best tuning that
/// hindsight finds, and no filter is better than a smoother that sees later reports.
#[test]
fn the_boards_touch_estimator_is_near_the_best_and_latency_is_what_remains() {
    let rows = rows("touch-estimators");
    for (stroke, of_the_one_before) in [("human", 0.5), ("human-rough", 0.6)] {
        for rate_hz in ["100", "200", "500"] {
            let error = |method: &str| {
                let of_method = |row: &&Row| {
                    row["method"].starts_with(method) && row["stroke"] == stroke && row["report_rate_hz"] == rate_hz
                };
                number(rows.iter().find(of_method).unwrap(), "error_over_rms")
            };
            let (board, best, smoother) = (error("Kalman, by speed"), error("best of"), error("smoother"));
            assert!(board < of_the_one_before * error("g-h-k"), "{stroke}, {rate_hz} Hz: {board}");
            assert!(board < 1.5 * best, "{stroke}, {rate_hz} Hz: {board}, {best}");
            assert!(smoother < 0.7 * best, "{stroke}, {rate_hz} Hz: {smoother}, {best}");
            assert!(error("linear") < 1.2 * best, "{stroke}, {rate_hz} Hz: {}", error("linear"));
        }
    }
    let timed = rows.iter().filter(|row| !row["measured_run_time_ns"].is_empty()).count();
    assert_eq!((timed, rows.len()), (36, 54));
}

#[test]
fn fewer_ticks_make_a_larger_error() {
    let rows = rows("error-against-tick-rate");
    for stripes in
        ["2 mm stripes", "1 mm stripes", "0.5 mm stripes", "2 mm stripes, touch source of 100 Hz, 10 ms late"]
    {
        let errors = curve(&rows, &[("curve", stripes)], "tick_hz", "rms_error_over_reachable_range");
        assert_eq!((errors.len(), errors[0].0, errors[8].0), (9, 1000.0, 40_000.0));
        let [slowest, slower, slow] = [errors[0].1, errors[1].1, errors[2].1];
        // At 1 and 2 kHz the touch source reports every 2 and 4 ticks, and ticks that take reports in are most of them.
        // With a touch source of 100 Hz, most of the error is that of the estimated place: the filter that follows
        // people through lost reports has more noise on this even stroke than one that averages longer.
        let least = if stripes.contains("touch source") { 1.02 } else { 1.05 };
        assert!(slowest > slower && slower > least * slow, "{stripes}: {errors:?}");
        // Beyond, ticks help less and less, and what they cannot help remains: of a touch source of 100 Hz, all of it.
        let rest = errors[3..].iter().map(|error| error.1);
        let most = if stripes.contains("touch source") { 1.02 * slow } else { slow };
        assert!(rest.clone().all(|error| error < most && error > 0.01), "{stripes}: {errors:?}");
        if stripes.contains("touch source") {
            assert!(rest.clone().all(|error| error > 0.95 * slow), "{stripes}: {errors:?}");
        }
    }
    for row in rows.iter().filter(|row| !row["rms_error_over_reachable_range"].is_empty()) {
        let (ticks, carrier) = (number(row, "tick_hz"), number(row, "carrier_hz"));
        assert!(carrier >= 125.0 && ticks / (2.0 * carrier) >= 4.0, "what a board takes");
    }
}

#[test]
fn thresholds_have_the_published_shape_without_leakage_and_the_published_order_with_it() {
    let rows = rows("threshold-over-frequency");
    let threshold = |leakage: &str, wave: &str, drive: &str| {
        let is = |row: &&Row| row["leakage_hz"] == leakage && row["wave"] == wave && row["drive_hz"] == drive;
        let text = &rows.iter().find(is).unwrap()["threshold_v_peak"];
        if text.is_empty() { f64::INFINITY } else { text.parse::<f64>().unwrap() }
    };
    // A published sine has its least threshold in the middle, and can be felt at 15 Hz within 200 V.
    let sine = |drive| threshold("0", "sine", drive);
    assert!(sine("15") > 3.0 * sine("120") && sine("240") > sine("120") && sine("15") < 200.0, "{}", sine("15"));
    assert!(threshold("250", "sine", "15") > 200.0 && threshold("250", "sine", "30") > 150.0);
    // A published square wave is felt more easily than a sine below 60 Hz.
    for drive in ["15", "30"] {
        assert!(threshold("250", "square", drive) < threshold("250", "sine", drive), "{drive}");
        assert!(threshold("0", "square", drive) > threshold("0", "sine", drive), "{drive}");
    }
}
