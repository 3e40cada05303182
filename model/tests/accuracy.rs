//! Every variant, forward and inverse, in both precisions, against the paper's dimensional equations in 80 digits.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::common;
use crate::documented::row_of_page;

use std::collections::BTreeMap;

use common::{Row, relative_error, rows};
use frixel_model::{ContactState, InverseError, Real, StateError, VACUUM_PERMITTIVITY_F_PER_M};

const FORWARD: &str = include_str!("fixtures/forward.csv");
const INVERSE: &str = include_str!("fixtures/inverse.csv");

/// The bounds on the error: one for closed forms, one for variants that need a root-finder or a power.
fn bound<T: Real>(variant: &str) -> f64 {
    let single = T::EPSILON > T::from_f64(1e-10);
    match (variant, single) {
        ("wf-upper" | "wf-loaded" | "wf-lower", false) => 4e-15,
        ("wf-upper" | "wf-loaded" | "wf-lower" | "wf-finite", true) => 1e-6,
        (_, false) => 4e-14,
        (_, true) => 1e-5,
    }
}

/// For each variant, the largest ratio of error to bound, and its row.
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

/// Compares every forward row; `distort` is applied to the model's result before the comparison.
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

/// Compares every inverse row; `distort` is applied to the model's result before the comparison.
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

/// Asserts that every variant keeps its bound, that `docs/inside/model.md` lists how much of it is used, and that every
/// variant exceeds it when the output is forced to zero.
fn hold(what: &str, found: &Worst, zeroed: &Worst) {
    assert_eq!(found.len(), 7);
    for (variant, (share, place)) in found {
        let column = row_of_page("variant").iter().position(|heading| heading == what).unwrap();
        let on_page = &row_of_page(&format!("`{variant}`"))[column];
        println!("{what} {variant}: {share:.2} of the bound");
        assert_eq!(*on_page, format!("{share:.2}"), "{what} {variant} in docs/inside/model.md");
        assert!(*share <= 1.0, "{what} {variant}: {share} of the bound at {place}");
        assert!(zeroed[variant].0 > 1.0, "{what} {variant} passes with a zero output");
    }
}

fn zero_state<T: Real>(_: ContactState<T>) -> ContactState<T> {
    let zero = T::ZERO;
    ContactState { contact_radius_m: zero, stiffness_pa_per_m: zero, friction_n: zero, electric_friction_n: zero }
}

/// The fixtures contain every named row, at least once within the range of f32.
#[test]
fn the_fixtures_contain_the_named_rows() {
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

/// The dimensionless groups computed from a row agree with the row's name.
#[test]
fn named_rows_match_their_names() {
    let groups = |row: &Row| {
        let number = |column| row.number(column).unwrap_or(0.0);
        let gap_m = number("coating_m") / number("permittivity");
        let (radius_m, k) = (number("radius_m"), number("stiffness_pa_per_m"));
        let q = 0.5 * VACUUM_PERMITTIVITY_F_PER_M * number("voltage_v").powi(2) / gap_m.powi(3) / k;
        let n = number("normal_force_n") / (core::f64::consts::PI * k * radius_m * gap_m * gap_m);
        (q, n, q + (q * q + 2.0 * q / (1.0 + q) + n).sqrt())
    };
    let near = |found: f64, said: f64| (found / said - 1.0).abs() < 0.15;
    let named = |text, name: &str| {
        let found: Vec<_> = rows(text).into_iter().filter(|row| row.text("name") == name).collect();
        assert!(!found.is_empty(), "{name}");
        found
    };
    for row in named(FORWARD, "squares overflow f32") {
        let (q, _, y) = groups(&row);
        assert!(q * q > f64::from(f32::MAX) && y * y > f64::from(f32::MAX));
    }
    for (name, expected) in
        [("q = 4e-29", 4.4e-29), ("wrong branch off by 245 %", 4e-6), ("wrong branch overflows", 7e7)]
    {
        assert!(named(FORWARD, name).iter().all(|row| near(groups(row).0, expected)), "{name}");
    }
    for (name, expected) in [("y = 1e-19", 1e-19), ("y = 2e19", 2e19)] {
        assert!(named(FORWARD, name).iter().all(|row| near(groups(row).2, expected)), "{name}");
    }
    for row in named(FORWARD, "y^2 - n cancels") {
        let (q, n, _) = groups(&row);
        assert!(near(q, 1e-12) && near(n, 6e7));
    }
    assert!(named(INVERSE, "y^2 - n cancels").iter().any(|row| row.number("electric_friction_n").is_some()));
    for (name, sign) in [("within 1e-6 of pull-off", -1.0), ("beyond pull-off by 1e-6", 1.0)] {
        for row in named(FORWARD, name) {
            let (q, n, _) = groups(&row);
            let beyond = sign * (-n / (q * q + 2.0 * q / (1.0 + q)) - 1.0);
            assert!(beyond > 8e-7 && beyond < 1.2e-6, "{name}: {beyond:e}");
        }
    }
    for (name, ok) in [("beta = y", true), ("just passes the outer radius", false)] {
        for row in named(FORWARD, name) {
            let (q, n, _) = groups(&row);
            let gap_m = row.number("coating_m").unwrap();
            let beta = row.number("outer_radius_m").unwrap().powi(2) / (2.0 * row.number("radius_m").unwrap() * gap_m);
            let left = (beta * beta - 2.0 * q * beta - n) / (beta * beta);
            assert!(if ok { left.abs() < 1e-6 } else { left < 0.0 && left > -1e-4 }, "{name}: {left:e}");
            assert_eq!(row.text("status") == "ok", ok);
        }
    }
    for name in ["no friction", "no friction under a pull"] {
        let zero = |row: &Row| row.number("friction_n").or(row.number("electric_friction_n")) == Some(0.0);
        assert!(named(INVERSE, name).iter().all(zero), "{name}");
    }
    let soft = named(FORWARD, "stress exponent 1e-6");
    assert!(soft.iter().all(|row| near(row.number("stress_exponent").unwrap(), 1e-6)));
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
