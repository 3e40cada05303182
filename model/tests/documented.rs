//! The figures in the crate's own docs and in `docs/inside/model.md`, held against the model, to their last digit.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use frixel_model::{Contact, ContactModel, Finger, LoadedContact};

const DOCS: &str = include_str!("../src/lib.rs");

/// The crate's docs without their comment signs and line breaks.
fn docs() -> String {
    let lines = DOCS.lines().filter_map(|line| line.strip_prefix("//!"));
    lines.map(str::trim).collect::<Vec<_>>().join(" ")
}

/// Asserts that `found` is `written` when rounded to the same number of digits.
#[track_caller]
fn rounds_to(found: f64, written: &str) {
    let digits = written.replace(',', "");
    let decimals = digits.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let half = 0.5 * 10_f64.powi(-(decimals as i32));
    let error = (found - digits.parse::<f64>().unwrap()).abs();
    println!("{written}: {found}");
    assert!(error <= half * (1.0 + 1e-9), "{found} is not {written}");
}

/// A row of a table in `docs/inside/model.md`: the texts of its cells, the first of which is `name`.
pub(crate) fn row_of_page(name: &str) -> Vec<String> {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/inside/model.md");
    let text = std::fs::read_to_string(page).unwrap();
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let mut rows = text.lines().filter(|line| line.starts_with('|')).map(cells);
    rows.find(|cells| cells[0] == name).unwrap_or_else(|| panic!("docs/inside/model.md has no row {name}"))
}

fn example() -> Contact<f64> {
    Contact::new(&Finger::<f64>::EXAMPLE, 1e-5).unwrap()
}

/// `d ln F_T/d ln sigma0`, half of that over the voltage.
fn slope(model: &dyn ContactModel<f64>, voltage_v_rms: f64) -> f64 {
    let friction_n = model.state(voltage_v_rms).unwrap().friction_n;
    0.5 * model.sensitivity(voltage_v_rms).unwrap().friction_per_volt_n_per_v * voltage_v_rms / friction_n
}

#[test]
fn slopes_of_both_bounds() {
    let contact = example();
    let (upper, lower) = (contact.under_load(0.0).unwrap(), contact.lower_bound(0.0).unwrap());
    let mut count = 0;
    for line in DOCS.lines().filter_map(|line| line.strip_prefix("//!   | ")) {
        let cells: Vec<&str> = line.trim_end_matches('|').split('|').map(str::trim).collect();
        let (Ok(q), &[_, upper_slope, lower_slope, ratio]) = (cells[0].parse::<f64>(), cells.as_slice()) else {
            continue;
        };
        let voltage_v_rms = q.sqrt() * contact.voltage_scale_v_rms();
        rounds_to(slope(&upper, voltage_v_rms), upper_slope);
        rounds_to(slope(&lower, voltage_v_rms), lower_slope);
        let friction_n = |model: &dyn ContactModel<f64>| model.state(voltage_v_rms).unwrap().friction_n;
        rounds_to(friction_n(&upper) / friction_n(&lower), ratio);
        count += 1;
    }
    assert_eq!(count, 6);
}

/// How far electric friction is above `2 F* sqrt(n) (V/V*)^2`, in per cent.
fn above_the_square_law(contact: &LoadedContact<f64>, load_n: f64, voltage_v_rms: f64) -> f64 {
    let scales = contact.contact();
    let square = 2.0 * scales.friction_scale_n() * scales.load(load_n).sqrt() * scales.attraction(voltage_v_rms);
    100.0 * (contact.electric_friction_n(voltage_v_rms) / square - 1.0)
}

#[test]
fn departure_from_the_square_law() {
    let docs = docs();
    let (_, figures) = docs.split_once("`n` is ").unwrap();
    let (n, figures) = figures.split_once(") the departure is ").unwrap();
    rounds_to(example().load(0.5), n);
    let contact = example().under_load(0.5).unwrap();
    let (figures, _) = figures.split_once(':').unwrap();
    let figures: Vec<&str> = figures.split(", ").collect();
    assert_eq!(figures.len(), 3);
    for figure in figures {
        let (per_cent, voltage) = figure.split_once(" % at ").unwrap();
        rounds_to(above_the_square_law(&contact, 0.5, voltage.strip_suffix(" V").unwrap().parse().unwrap()), per_cent);
    }
}
