//! Every variant, forward and inverse, in both precisions, against the paper's dimensional equations in 80 digits.
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use std::collections::BTreeMap;

use common::{Row, relative_error, rows};
use frixel_model::{ContactState, InverseError, Real, StateError};

const FORWARD: &str = include_str!("fixtures/forward.csv");
const INVERSE: &str = include_str!("fixtures/inverse.csv");

/// The bounds: closed forms, and what needs a root-finder or a power.
fn bound<T: Real>(variant: &str) -> f64 {
    let single = T::EPSILON > T::from_f64(1e-10);
    match (variant, single) {
        ("wf-upper" | "wf-loaded" | "wf-lower", false) => 4e-15,
        ("wf-upper" | "wf-loaded" | "wf-lower" | "wf-finite", true) => 1e-6,
        (_, false) => 4e-14,
        (_, true) => 1e-5,
    }
}

/// The largest error of each variant over its bound, and the row it comes from.
type Worst = BTreeMap<String, (f64, String)>;

fn record(worst: &mut Worst, row: &Row, what: &str, share: f64) {
    let place = || format!("{what} {} {:?}", row.text("name"), row);
    let entry = worst.entry(row.text("variant").to_owned()).or_insert_with(|| (-1.0, String::new()));
    if share > entry.0 {
        *entry = (share, place());
    }
}

fn status(error: StateError) -> &'static str {
    match error {
        StateError::NoContact => "no-contact",
        StateError::PassesOuterRadius => "passes-outer-radius",
        other => panic!("{other}"),
    }
}

fn inverse_status(error: InverseError) -> &'static str {
    match error {
        InverseError::BelowNatural => "below-natural",
        InverseError::Unstable => "unstable",
        InverseError::PassesOuterRadius => "passes-outer-radius",
        other => panic!("{other}"),
    }
}

/// Every forward row; `distort` stands between the model and the comparison.
fn forward<T: Real + 'static>(distort: impl Fn(ContactState<T>) -> ContactState<T>) -> Worst {
    let mut worst = Worst::new();
    for row in rows(FORWARD).iter().filter(|row| row.in_f32() || T::EPSILON < T::from_f64(1e-10)) {
        let limit = bound::<T>(row.text("variant")) * row.widening();
        let state = row.model::<T>().unwrap().state(row.input("voltage_v"));
        let state = match state {
            Ok(state) => state,
            Err(error) => {
                assert_eq!(status(error), row.text("status"), "{row:?}");
                continue;
            }
        };
        assert_eq!(row.text("status"), "ok", "{row:?}");
        let state = distort(state);
        for (column, found) in [
            ("contact_radius_m", state.contact_radius_m),
            ("effective_stiffness_pa_per_m", state.stiffness_pa_per_m),
            ("friction_n", state.friction_n),
            ("electric_friction_n", state.electric_friction_n),
        ] {
            record(&mut worst, row, column, relative_error(found.into(), row.number(column).unwrap()) / limit);
        }
    }
    worst
}

/// Every inverse row; `distort` stands between the model and the comparison.
fn inverse<T: Real + 'static>(distort: impl Fn(T) -> T) -> Worst {
    let mut worst = Worst::new();
    for row in rows(INVERSE).iter().filter(|row| row.in_f32() || T::EPSILON < T::from_f64(1e-10)) {
        let limit = bound::<T>(row.text("variant")) * row.widening();
        let model = row.model::<T>().unwrap();
        let voltage = match row.number("friction_n") {
            Some(friction_n) => model.voltage_for_friction(T::from_f64(friction_n)),
            None => model.voltage_for_electric_friction(row.input("electric_friction_n")),
        };
        match voltage {
            Ok(voltage) => {
                assert_eq!(row.text("status"), "ok", "{row:?}");
                let error = relative_error(distort(voltage).into(), row.number("voltage_v").unwrap());
                record(&mut worst, row, "voltage_v", error / limit);
            }
            Err(error) => assert_eq!(inverse_status(error), row.text("status"), "{row:?}"),
        }
    }
    worst
}

/// Holds the bound for every variant, and fails for every variant when the output is forced to zero.
fn hold(what: &str, found: &Worst, zeroed: &Worst) {
    assert_eq!(found.len(), 7);
    for (variant, (share, place)) in found {
        println!("{what} {variant}: {share:.2} of the bound");
        assert!(*share <= 1.0, "{what} {variant}: {share} of the bound at {place}");
        assert!(zeroed[variant].0 > 1.0, "{what} {variant} passes with a zero output");
    }
}

fn zero_state<T: Real>(_: ContactState<T>) -> ContactState<T> {
    let zero = T::ZERO;
    ContactState { contact_radius_m: zero, stiffness_pa_per_m: zero, friction_n: zero, electric_friction_n: zero }
}

/// The rows that the issue names are among the fixtures, and none of them only in f64.
#[test]
fn named_rows_are_there() {
    for name in [
        "squares overflow f32",
        "q = 4e-29",
        "y = 1e-19",
        "y = 2e19",
        "no friction",
        "no friction under a pull",
        "less than natural",
        "barely above natural",
        "wrong branch off by 245 %",
        "wrong branch overflows",
        "y^2 - n cancels",
        "within 1e-6 of pull-off",
        "below pull-off",
        "beta = y",
        "just passes the outer radius",
        "stress exponent 1e-6",
    ] {
        let found = rows(FORWARD).into_iter().chain(rows(INVERSE)).filter(|row| row.text("name") == name);
        assert!(found.filter(Row::in_f32).count() > 0, "{name}");
    }
}

#[test]
fn forward_f64() {
    hold("forward f64", &forward::<f64>(|state| state), &forward::<f64>(zero_state));
}

#[test]
fn forward_f32() {
    hold("forward f32", &forward::<f32>(|state| state), &forward::<f32>(zero_state));
}

#[test]
fn inverse_f64() {
    hold("inverse f64", &inverse::<f64>(|voltage| voltage), &inverse::<f64>(|_| 0.0));
}

#[test]
fn inverse_f32() {
    hold("inverse f32", &inverse::<f32>(|voltage| voltage), &inverse::<f32>(|_| 0.0));
}
