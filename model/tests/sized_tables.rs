//! Tables of every order and both precisions against the closed form: the proven bound, and how sharp it is.
#![allow(clippy::unwrap_used)]

use frixel_model::{Contact, Finger, LoadedContact, Precision, TableBuilder, TableError, TableShape, U0F32, U1F31};

use crate::documented::row_of_page;

const FINGER: Finger<f64> = Finger::<f64>::EXAMPLE;

fn contact(gap_m: f64, normal_load_n: f64) -> LoadedContact<f64> {
    Contact::new(&FINGER, gap_m).unwrap().under_load(normal_load_n).unwrap()
}

/// The contacts under test: the example finger with and without load, and one for which friction grows fastest.
fn contacts() -> [LoadedContact<f64>; 3] {
    [contact(1e-5, 0.0), contact(1e-5, 0.5), contact(2.5e-7, 1e-3)]
}

/// Relative error in friction of a voltage that a table returned for `friction_n`.
fn error(contact: &LoadedContact<f64>, friction_n: f64, voltage_v_rms: f64) -> f64 {
    (contact.electric_friction_n(voltage_v_rms) / friction_n - 1.0).abs()
}

fn range(contact: &LoadedContact<f64>) -> (f64, f64) {
    (contact.electric_friction_n(1.0), contact.electric_friction_n(200.0))
}

/// The largest error over the range of a table in f32, with its output through `distort`.
fn worst_f32<const C: usize>(
    contact: &LoadedContact<f64>,
    builder: &TableBuilder,
    rows: usize,
    distort: impl Fn(f32) -> f32,
) -> f64 {
    let mut storage = vec![[0.0; C]; rows];
    let table = builder.build_f32(&mut storage).unwrap();
    let (low, _) = range(contact);
    let (first, last) = ((low as f32).to_bits() + 1, table.electric_friction_max_n().to_bits());
    let mut highest = 0.0_f32;
    let worst = (first..last)
        .step_by(10_007)
        .chain([last])
        .map(f32::from_bits)
        .map(|x| {
            let voltage_v_rms = table.voltage_v_rms(x);
            highest = highest.max(voltage_v_rms);
            error(contact, f64::from(x), f64::from(distort(voltage_v_rms)))
        })
        .fold(0.0, f64::max);
    assert!(highest <= table.voltage_max_v_rms());
    assert_eq!(table.voltage_v_rms(f32::NAN).to_bits(), 0);
    assert_eq!(table.voltage_v_rms(-1.0).to_bits(), 0);
    assert_eq!(table.voltage_v_rms(f32::INFINITY).to_bits(), table.voltage_max_v_rms().to_bits());
    worst
}

/// The same for a table in integers.
fn worst_fixed<const C: usize>(
    contact: &LoadedContact<f64>,
    builder: &TableBuilder,
    rows: usize,
    distort: impl Fn(U1F31) -> U1F31,
) -> f64 {
    let mut storage = vec![[0; C]; rows];
    let table = builder.build_fixed(&mut storage).unwrap();
    let (low, _) = range(contact);
    let first = table.friction(low).to_num::<f64>();
    assert_eq!(table.voltage(U0F32::ZERO), U1F31::ZERO);
    assert!(table.voltage(U0F32::MAX) <= U1F31::ONE);
    // Frictions spread evenly over octaves.
    let steps = ((1.0 / first).ln() / 3.7e-4) as i32;
    (0..steps)
        .map(|step| U0F32::from_num(first * (3.7e-4 * f64::from(step)).exp()))
        .chain([U0F32::MAX])
        .map(|friction| {
            let voltage_v_rms = distort(table.voltage(friction)).to_num::<f64>() * table.voltage_max_v_rms();
            error(contact, friction.to_num::<f64>() * table.friction_max_n(), voltage_v_rms)
        })
        .fold(0.0, f64::max)
}

#[test]
fn bounds_hold_and_are_tight() {
    for contact in contacts() {
        let (low, high) = range(&contact);
        for target in [1e-2, 1e-3, 1e-4, 1e-5, 4e-6] {
            let builder = TableBuilder::new(&contact, low, high, target).unwrap();
            for precision in [Precision::F32, Precision::Fixed] {
                for coefficients in [2, 3, 4] {
                    let shape = builder.shape(precision, coefficients).unwrap();
                    let worst = |zero: bool| match (precision, coefficients) {
                        (Precision::F32, 2) => {
                            worst_f32::<2>(&contact, &builder, shape.rows, |v| if zero { 0.0 } else { v })
                        }
                        (Precision::F32, 3) => {
                            worst_f32::<3>(&contact, &builder, shape.rows, |v| if zero { 0.0 } else { v })
                        }
                        (Precision::F32, _) => {
                            worst_f32::<4>(&contact, &builder, shape.rows, |v| if zero { 0.0 } else { v })
                        }
                        (Precision::Fixed, 2) => {
                            worst_fixed::<2>(&contact, &builder, shape.rows, |v| if zero { U1F31::ZERO } else { v })
                        }
                        (Precision::Fixed, 3) => {
                            worst_fixed::<3>(&contact, &builder, shape.rows, |v| if zero { U1F31::ZERO } else { v })
                        }
                        (Precision::Fixed, _) => {
                            worst_fixed::<4>(&contact, &builder, shape.rows, |v| if zero { U1F31::ZERO } else { v })
                        }
                    };
                    let found = worst(false);
                    println!("{shape:?} {} bytes: {found:e}", shape.bytes());
                    assert!(shape.relative_error <= target);
                    assert!(found <= shape.relative_error, "{shape:?}: {found:e}");
                    assert!(found >= shape.relative_error / 20.0, "{shape:?}: {found:e}");
                    assert!(worst(true) > shape.relative_error);
                }
            }
        }
    }
}

#[test]
#[ignore = "every f32 pattern, run by `cargo xtask soak tables`"]
fn every_f32_pattern_is_answered() {
    for contact in [contact(1e-5, 0.0), contact(1e-5, 0.5)] {
        let (low, high) = range(&contact);
        let builder = TableBuilder::new(&contact, low, high, 1e-5).unwrap();
        let shape = builder.smallest(Precision::F32).unwrap();
        assert!(shape.coefficients == 4 && shape.bytes() <= 2048, "{shape:?}");
        let mut storage = vec![[0.0; 4]; shape.rows];
        let table = builder.build_f32(&mut storage).unwrap();
        let largest = table.voltage_max_v_rms();
        let mut highest = 0.0_f32;
        for x in (0..=u32::MAX).map(f32::from_bits) {
            let voltage_v_rms = table.voltage_v_rms(x);
            assert!((0.0..=largest).contains(&voltage_v_rms), "{x:e}: {voltage_v_rms}");
            if x.is_nan() || x <= 0.0 {
                assert_eq!(voltage_v_rms.to_bits(), 0, "{x:e}");
            } else {
                assert!(f64::from(voltage_v_rms) >= f64::from(highest) * (1.0 - 5e-6), "falls at {x:e}");
                assert!(f64::from(x) < low || voltage_v_rms > 0.0, "nothing at {x:e}");
                highest = highest.max(voltage_v_rms);
            }
        }
        assert_eq!(highest.to_bits(), largest.to_bits());
    }
}

#[test]
#[ignore = "every 32-bit code, run by `cargo xtask soak tables`"]
fn every_code_is_answered() {
    for contact in contacts() {
        let (low, high) = range(&contact);
        let builder = TableBuilder::new(&contact, low, high, 1e-5).unwrap();
        let mut storage = vec![[0; 4]; builder.shape(Precision::Fixed, 4).unwrap().rows];
        let table = builder.build_fixed(&mut storage).unwrap();
        let first = table.friction(low);
        let mut highest = U1F31::ZERO;
        for friction in (0..=u32::MAX).map(U0F32::from_bits) {
            let voltage = table.voltage(friction);
            assert!(voltage <= U1F31::ONE, "{friction}");
            assert!(voltage.to_num::<f64>() >= highest.to_num::<f64>() * (1.0 - 5e-6), "falls at {friction}");
            assert!(friction < first || voltage > 0, "nothing at {friction}");
            highest = highest.max(voltage);
        }
    }
}

/// One table of the universal curve is valid for fingers and coatings that share only `n`.
#[test]
fn a_universal_table_serves_every_contact_of_its_load() {
    let n = 100.0;
    let universal = Contact::<f64>::universal().under_load(n).unwrap();
    let (low, high) = (universal.electric_friction_n(1e-2), universal.electric_friction_n(10.0));
    let builder = TableBuilder::new(&universal, low, high, 1e-5).unwrap();
    let mut storage = vec![[0.0; 4]; builder.shape(Precision::F32, 4).unwrap().rows];
    let table = builder.build_f32(&mut storage).unwrap();
    let other = Finger { radius_m: 2e-2, stiffness_pa_per_m: 5e8, friction_coefficient: 1.5 };
    for (finger, gap_m) in [(FINGER, 1e-5), (FINGER, 1e-6), (other, 3e-5)] {
        let contact = Contact::new(&finger, gap_m).unwrap();
        let loaded = contact.under_load(n * contact.load_scale_n()).unwrap();
        for step in 1..100 {
            let scaled = (low * (high / low).powf(f64::from(step) / 100.0)) as f32;
            let voltage_v_rms = f64::from(table.voltage_v_rms(scaled)) * contact.voltage_scale_v_rms();
            let friction_n = f64::from(scaled) * contact.friction_scale_n();
            assert!(error(&loaded, friction_n, voltage_v_rms) <= 1e-5, "{finger:?} {gap_m} {scaled}");
            assert!(error(&loaded, friction_n, 0.0) > 1e-5);
        }
    }
}

#[test]
fn smallest_is_the_smallest_of_all_orders() {
    let contact = contact(1e-5, 0.0);
    let (low, high) = range(&contact);
    let mut bytes = 0;
    for target in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 4e-6] {
        let builder = TableBuilder::new(&contact, low, high, target).unwrap();
        for precision in [Precision::F32, Precision::Fixed] {
            let smallest = builder.smallest(precision).unwrap();
            for coefficients in [2, 3, 4] {
                assert!(smallest.bytes() <= builder.shape(precision, coefficients).unwrap().bytes());
            }
        }
        let smallest = builder.smallest(Precision::F32).unwrap();
        let grouped = |bytes: usize| match bytes {
            ..1000 => bytes.to_string(),
            _ => format!("{},{:03}", bytes / 1000, bytes % 1000),
        };
        let TableShape { coefficients, rows, relative_error, .. } = smallest;
        let row = [
            format!("{target:e}"),
            coefficients.to_string(),
            rows.to_string(),
            grouped(smallest.bytes()),
            format!("{relative_error:.2e}"),
        ];
        assert_eq!(row_of_page(&row[0]), row, "docs/inside/model.md");
        assert!(smallest.bytes() > bytes, "a finer target costs more");
        bytes = smallest.bytes();
    }
    // A narrower range costs less.
    let whole = TableBuilder::new(&contact, low, high, 1e-5).unwrap().smallest(Precision::F32).unwrap();
    let part = TableBuilder::new(&contact, high / 16.0, high, 1e-5).unwrap().smallest(Precision::F32).unwrap();
    assert!(part.rows <= 17 && whole.rows > 70);
}

#[test]
fn a_table_that_cannot_be_built_gives_the_reason() {
    let contact = contact(1e-5, 0.5);
    for (low, high) in [(0.0, 1.0), (-1.0, 1.0), (1e-3, 1e-3), (1e-3, f64::INFINITY), (f64::NAN, 1.0), (1e-3, f64::NAN)]
    {
        assert_eq!(TableBuilder::new(&contact, low, high, 1e-5).unwrap_err(), TableError::Range);
    }
    for target in [0.0, -1.0, f64::NAN] {
        assert_eq!(TableBuilder::new(&contact, 1e-6, 1e-2, target).unwrap_err(), TableError::Target);
    }
    let fine = TableBuilder::new(&contact, 1e-6, 1e-2, 1e-7).unwrap();
    assert_eq!(fine.smallest(Precision::F32).unwrap_err(), TableError::Target);
    let wide = TableBuilder::new(&contact, 1e-50, 1e-2, 1e-5).unwrap();
    assert_eq!(wide.smallest(Precision::F32).unwrap_err(), TableError::Unrepresentable);
    let builder = TableBuilder::new(&contact, 1e-6, 1e-2, 1e-5).unwrap();
    assert_eq!(builder.build_f32(&mut [[0.0; 4]; 10]).unwrap_err(), TableError::TooManySegments);
    assert_eq!(builder.build_fixed(&mut [[0; 4]; 10]).unwrap_err(), TableError::TooManySegments);
    assert_eq!(builder.shape(Precision::F32, 5).unwrap_err(), TableError::Range);
}
