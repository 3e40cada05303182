//! Quantities that follow from the contact, against the paper's dimensional equations: sensitivities, capacitance, the
//! load from a measured contact, pull-off, the onset of slip. Each test is also shown to fail with a zero output.
#![allow(clippy::unwrap_used, clippy::panic)]

use crate::common;

use common::{Row, relative_error, rows};
use frixel_model::{Contact, Finger, Real, Slab, TissueSpring, contact_attraction_pa, effective_gap_m};

const FORWARD: &str = include_str!("fixtures/forward.csv");
const PULL_OFF: &str = include_str!("fixtures/pull_off.csv");
const SHEAR: &str = include_str!("fixtures/shear.csv");

/// Computes a quantity that a row has the reference value for; `None` if the model returns an error.
type Quantity<T> = fn(&Row) -> Option<T>;

/// Asserts that `quantity` agrees with `column` within `bound` times the row's `widening`, and that zero does not.
fn hold<T: Real>(rows: &[Row], column: &str, quantity: Quantity<T>, bound: f64, widening: fn(&Row) -> f64) {
    let single = T::EPSILON > T::from_f64(1e-10);
    let (mut worst, mut count, mut zeroed) = (0.0_f64, 0, 0.0_f64);
    for row in rows {
        let Some(right) = row.number(column).filter(|&right| right != 0.0) else { continue };
        if single && !(right.abs() > 1e-36 && right.abs() < 1e37 && row.text("f32") != "0") {
            continue;
        }
        let found = quantity(row).unwrap_or_else(|| panic!("no {column} at {row:?}"));
        let limit = bound * widening(row);
        let share = relative_error(found.into(), right) / limit;
        assert!(share <= 1.0, "{column}: {share} of the bound, {found} for {right} at {row:?}");
        worst = worst.max(share);
        zeroed = zeroed.max(relative_error(0.0, right) / limit);
        count += 1;
    }
    println!("{column}: {count} rows, {worst:.2} of {bound:e}");
    assert!(count >= 50, "{column}: only {count} rows");
    assert!(zeroed > 1.0, "{column} passes with a zero output");
}

fn finger<T: Real>(row: &Row) -> Finger<T> {
    Finger {
        radius_m: row.input("radius_m"),
        stiffness_pa_per_m: row.input("stiffness_pa_per_m"),
        friction_coefficient: row.input("friction_coefficient"),
    }
}

fn gap_m<T: Real>(row: &Row) -> T {
    let slab = Slab { thickness_m: row.input("coating_m"), relative_permittivity: row.input("permittivity") };
    effective_gap_m(&[slab]).unwrap()
}

fn contact<T: Real>(row: &Row) -> Contact<T> {
    Contact::new(&finger(row), gap_m(row)).unwrap()
}

fn steady(_: &Row) -> f64 {
    1.0
}

/// Sensitivities are one derivative further: near pull-off their condition number is that of friction, squared.
fn squared(row: &Row) -> f64 {
    row.widening() * row.widening()
}

fn by_voltage<T: Real + 'static>(row: &Row) -> Option<T> {
    row.model::<T>().ok()?.sensitivity(row.input("voltage_v")).ok().map(|found| found.friction_per_volt_n_per_v)
}

fn by_load<T: Real + 'static>(row: &Row) -> Option<T> {
    row.model::<T>().ok()?.sensitivity(row.input("voltage_v")).ok().map(|found| found.friction_per_load)
}

#[test]
fn sensitivities() {
    hold::<f64>(&rows(FORWARD), "friction_per_volt", by_voltage, 4e-14, squared);
    hold::<f32>(&rows(FORWARD), "friction_per_volt", by_voltage, 1e-5, squared);
    hold::<f64>(&rows(FORWARD), "friction_per_load", by_load, 4e-14, squared);
    hold::<f32>(&rows(FORWARD), "friction_per_load", by_load, 1e-5, squared);
}

#[test]
fn attraction() {
    fn sigma0<T: Real>(row: &Row) -> Option<T> {
        contact_attraction_pa(row.input("voltage_v"), gap_m(row)).ok()
    }
    // Five roundings, and twice the one of the gap.
    hold::<f64>(&rows(FORWARD), "sigma0_pa", sigma0, 3.5 * f64::EPSILON, steady);
    hold::<f32>(&rows(FORWARD), "sigma0_pa", sigma0, 3.5 * f64::from(f32::EPSILON), steady);
}

#[test]
fn capacitance() {
    fn capacitance_f<T: Real>(row: &Row) -> Option<T> {
        let contact = contact(row).within(row.input("outer_radius_m"), row.input("normal_force_n")).unwrap();
        contact.capacitance_f(row.input("voltage_v")).ok()
    }
    hold::<f64>(&rows(FORWARD), "capacitance_f", capacitance_f, 4e-15, steady);
    hold::<f32>(&rows(FORWARD), "capacitance_f", capacitance_f, 1e-6, steady);
}

/// From the reference's pull-off voltage: the load that the finger withstands there.
fn pull_off_load_n<T: Real>(row: &Row) -> Option<T> {
    contact(row).pull_off_load_n(T::from_f64(row.number("voltage_v")?)).ok()
}

/// The load from the reference's contact radius. The error bound grows with the ratio of the spring's force to the
/// load.
#[test]
fn load_from_a_measured_contact() {
    fn load_n<T: Real>(row: &Row) -> Option<T> {
        contact(row).normal_load_n(T::from_f64(row.number("contact_radius_m")?), row.input("voltage_v")).ok()
    }
    fn share(row: &Row) -> f64 {
        let spring_n = row.number("friction_n").unwrap() / row.number("friction_coefficient").unwrap();
        1.0 + spring_n / row.number("normal_force_n").unwrap().abs()
    }
    let mut loaded = rows(FORWARD);
    loaded.retain(|row| row.text("variant") == "wf-loaded" && row.text("status") == "ok");
    hold::<f64>(&loaded, "normal_force_n", load_n, 2e-15, share);
    hold::<f32>(&loaded, "normal_force_n", load_n, 1e-6, share);
}

#[test]
fn pull_off() {
    fn pulled<T: Real>(row: &Row) -> frixel_model::PulledContact<T> {
        contact(row).under_pull(-row.input::<T>("normal_force_n")).unwrap()
    }
    hold::<f64>(&rows(PULL_OFF), "voltage_v", |row| pulled(row).pull_off_voltage_v_rms().ok(), 4e-15, steady);
    hold::<f32>(&rows(PULL_OFF), "voltage_v", |row| pulled(row).pull_off_voltage_v_rms().ok(), 1e-6, steady);
    hold::<f64>(&rows(PULL_OFF), "friction_n", |row| pulled(row).pull_off_friction_n().ok(), 4e-15, steady);
    hold::<f32>(&rows(PULL_OFF), "friction_n", |row| pulled(row).pull_off_friction_n().ok(), 1e-6, steady);
    hold::<f64>(&rows(PULL_OFF), "normal_force_n", pull_off_load_n, 4e-15, steady);
    hold::<f32>(&rows(PULL_OFF), "normal_force_n", pull_off_load_n, 1e-6, steady);
}

#[test]
fn shear_onset() {
    fn onset<T: Real>(row: &Row) -> frixel_model::ShearOnset<T> {
        let spring = TissueSpring {
            stiffness_n_per_m: row.input("stiffness_n_per_m"),
            length_m: row.input("length_m"),
            gap_m: row.input("gap_m"),
            friction_coefficient: row.input("friction_coefficient"),
        };
        spring.onset(row.input("attraction_n")).unwrap()
    }
    let condition = |row: &Row| row.number("condition").unwrap();
    hold::<f64>(&rows(SHEAR), "angle_rad", |row| Some(onset(row).angle_rad), 4e-15, condition);
    hold::<f32>(&rows(SHEAR), "angle_rad", |row| Some(onset(row).angle_rad), 1e-6, condition);
    hold::<f64>(&rows(SHEAR), "displacement_m", |row| Some(onset(row).displacement_m), 4e-15, condition);
    hold::<f32>(&rows(SHEAR), "displacement_m", |row| Some(onset(row).displacement_m), 1e-6, condition);
}
