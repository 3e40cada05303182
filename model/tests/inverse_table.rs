//! The inverse table against the closed form, in the `f32` arithmetic of the device.
#![allow(clippy::unwrap_used)]

use frixel_model::{Contact, Finger, InverseTable, LawPoint, LoadedContact, Ripple, TableError};

/// The example finger.
const FINGER: Finger<f64> = Finger::<f64>::EXAMPLE;
const GAP_M: f64 = 10e-6;
const BOUND: f64 = InverseTable::RELATIVE_ERROR as f64;

fn contact(normal_load_n: f64) -> LoadedContact<f64> {
    Contact::new(&FINGER, GAP_M).unwrap().under_load(normal_load_n).unwrap()
}

/// The largest relative error in friction of `inverse` over every `stride`th `f32` of the contact's range.
fn worst_error(contact: &LoadedContact<f64>, voltages: (f64, f64), stride: usize, inverse: impl Fn(f32) -> f32) -> f64 {
    let bits = |voltage_v_rms| (contact.electric_friction_n(voltage_v_rms) as f32).to_bits();
    let (first, last) = (bits(voltages.0) + 1, bits(voltages.1) - 1);
    (first..last)
        .step_by(stride)
        .chain([last])
        .map(f32::from_bits)
        .map(|x| (contact.electric_friction_n(f64::from(inverse(x))) / f64::from(x) - 1.0).abs())
        .fold(0.0, |worst: f64, error| if error > worst || error.is_nan() { error } else { worst })
}

#[test]
fn example_finger_is_within_the_bound_and_zero_output_is_not() {
    for normal_load_n in [0.0, 0.5] {
        let contact = contact(normal_load_n);
        let table = InverseTable::build(&contact, 200.0).unwrap();
        assert!(size_of_val(&table) <= 2048);
        let worst = worst_error(&contact, (1.0, 200.0), 997, |x| table.voltage_v_rms(x));
        println!("load {normal_load_n} N: {worst:e}");
        assert!(worst <= BOUND, "load {normal_load_n} N: {worst:e}");
        assert!(worst_error(&contact, (1.0, 200.0), 997, |_| 0.0) > BOUND);
    }
}

#[test]
#[ignore = "every f32 pattern, run by `cargo xtask soak tables`"]
fn example_finger_is_within_the_bound_at_every_f32() {
    for normal_load_n in [0.0, 0.5] {
        let contact = contact(normal_load_n);
        let table = InverseTable::build(&contact, 200.0).unwrap();
        let worst = worst_error(&contact, (1.0, 200.0), 1, |x| table.voltage_v_rms(x));
        println!("load {normal_load_n} N: {worst:e}");
        assert!(worst <= BOUND, "load {normal_load_n} N: {worst:e}");
    }
}

#[test]
fn an_empty_or_cleared_table_answers_zero() {
    let mut cleared = InverseTable::build(&contact(0.5), 150.0).unwrap();
    cleared.clear();
    for table in [InverseTable::EMPTY, cleared] {
        assert!(table.is_empty());
        for x in (0..=u32::MAX).step_by(99_991).map(f32::from_bits).filter(|x| x.is_finite()) {
            assert!(table.voltage_v_rms(x).abs() <= 0.0, "{x:e}");
        }
    }
}

/// A board fills the table of each scene over that of an earlier one.
#[test]
fn a_table_filled_over_another_is_a_fresh_one_and_a_refusal_changes_nothing() {
    let finger = Finger { radius_m: 8e-3, stiffness_pa_per_m: 1.8e7, friction_coefficient: 0.5_f32 };
    let points = [(50.0, 0.01), (150.0, 0.09)]
        .map(|(voltage_v_rms, electric_friction_n)| LawPoint { voltage_v_rms, electric_friction_n });
    for up_to_n in [f32::INFINITY, 0.02] {
        let of_finger = InverseTable::of_finger(&finger, 1e-5, 0.5, &Ripple::NONE, 150.0, up_to_n).unwrap();
        let of_law = InverseTable::of_law(2.0, &points, 150.0, up_to_n).unwrap();
        let mut table = of_law.clone();
        let mut filling = table.begin(&finger, 1e-5, 0.5, &Ripple::NONE, 150.0, up_to_n).unwrap();
        while !filling.fill(&mut table, 3).unwrap() {}
        assert_eq!(table, of_finger);
        assert!(table.begin(&finger, 0.0, 0.5, &Ripple::NONE, 150.0, up_to_n).is_err());
        assert!(table.begin_law(2.0, &[], 150.0, up_to_n).is_err());
        assert_eq!(table, of_finger);
        let mut filling = table.begin_law(2.0, &points, 150.0, up_to_n).unwrap();
        while !filling.fill(&mut table, 3).unwrap() {}
        assert_eq!(table, of_law);
    }
}

/// Every `stride`th bit pattern: finite, within [0, largest], rising within the bound, and zero where it must be.
fn every_pattern_is_answered(normal_load_n: f64, voltage_max_v_rms: f64, stride: usize) {
    let contact = contact(normal_load_n);
    let table = InverseTable::build(&contact, voltage_max_v_rms).unwrap();
    let one_volt_n = contact.electric_friction_n(1.0);
    let mut highest = 0.0_f32;
    for x in (0..=u32::MAX).step_by(stride).map(f32::from_bits) {
        let voltage_v_rms = table.voltage_v_rms(x);
        assert!((0.0..=table.voltage_max_v_rms()).contains(&voltage_v_rms), "{x:e}: {voltage_v_rms}");
        if x.is_nan() || x <= 0.0 {
            assert_eq!(voltage_v_rms.to_bits(), 0, "{x:e}");
            continue;
        }
        assert!(f64::from(voltage_v_rms) >= f64::from(highest) * (1.0 - BOUND / 2.0), "falls at {x:e}");
        highest = highest.max(voltage_v_rms);
        if x > table.electric_friction_max_n() {
            assert_eq!(voltage_v_rms.to_bits(), table.voltage_max_v_rms().to_bits());
        }
        if f64::from(x) < one_volt_n {
            assert!(f64::from(voltage_v_rms) <= 1.0 + BOUND, "{x:e}: {voltage_v_rms}");
        }
    }
    assert_eq!(highest.to_bits(), table.voltage_max_v_rms().to_bits());
}

#[test]
fn strided_patterns_are_answered() {
    for normal_load_n in [0.0, 0.5] {
        for voltage_max_v_rms in [0.3, 1.0, 150.0, 400.0] {
            every_pattern_is_answered(normal_load_n, voltage_max_v_rms, 1009);
        }
    }
}

#[test]
#[ignore = "every f32 pattern, run by `cargo xtask soak tables`"]
fn every_f32_pattern_is_answered() {
    for normal_load_n in [0.0, 0.5] {
        every_pattern_is_answered(normal_load_n, 200.0, 1);
    }
}

#[test]
fn every_contact_is_within_the_bound() {
    let mut worst: f64 = 0.0;
    for stiffness_pa_per_m in [1e5, 1.8e7, 1e9] {
        for gap_m in [2.5e-7, 1e-6, 1e-5, 1e-4] {
            for normal_load_n in [0.0, 1e-3, 0.05, 0.5, 5.0, 50.0] {
                for voltage_max_v_rms in [1.0, 30.0, 200.0] {
                    let contact = Contact::new(&Finger { stiffness_pa_per_m, ..FINGER }, gap_m)
                        .unwrap()
                        .under_load(normal_load_n)
                        .unwrap();
                    let table = InverseTable::build(&contact, voltage_max_v_rms).unwrap();
                    let lowest_v_rms = (voltage_max_v_rms / 200.0).min(1.0);
                    let error =
                        worst_error(&contact, (lowest_v_rms, voltage_max_v_rms), 4999, |x| table.voltage_v_rms(x));
                    worst = worst.max(error);
                    let zeroed = worst_error(&contact, (lowest_v_rms, voltage_max_v_rms), 4_999_999, |_| 0.0);
                    assert!(zeroed > BOUND);
                }
            }
        }
    }
    println!("{worst:e}");
    assert!(worst <= BOUND, "{worst:e}");
}

#[test]
fn a_table_that_cannot_be_built_gives_the_reason() {
    let contact = contact(0.5);
    for voltage_max_v_rms in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        assert_eq!(InverseTable::build(&contact, voltage_max_v_rms), Err(TableError::Voltage));
    }
    let thin = Contact::new(&FINGER, 1e-9).unwrap().under_load(0.0).unwrap();
    assert_eq!(InverseTable::build(&thin, 400.0), Err(TableError::TooManySegments));
    let far = Contact::new(&FINGER, 1e3).unwrap().under_load(0.0).unwrap();
    assert_eq!(InverseTable::build(&far, 1.0), Err(TableError::Unrepresentable));
}

/// Up to the largest target, a truncated table returns the same bits as the whole one; above, the voltage at its end.
#[test]
fn a_truncated_table_equals_the_whole_one_up_to_its_end() {
    for (normal_load_n, voltage_max_v_rms) in [(0.0, 0.3), (0.0, 150.0), (0.5, 150.0), (0.5, 200.0)] {
        let contact = contact(normal_load_n);
        let whole = InverseTable::build(&contact, voltage_max_v_rms).unwrap();
        let rows = |up_to_n| InverseTable::build_up_to(&contact, voltage_max_v_rms, up_to_n).unwrap().rows_filled();
        let largest_n = whole.electric_friction_max_n();
        let knee_n = contact.electric_friction_n((voltage_max_v_rms / 200.0).min(1.0)) as f32;
        let mut fewest = usize::MAX;
        for up_to_n in [2.0, 1.0, 0.999, 0.8, 0.3, 1e-3, 1e-9, 0.0, -1.0].map(|part| part * largest_n) {
            let table = InverseTable::build_up_to(&contact, voltage_max_v_rms, up_to_n).unwrap();
            let end_n = table.electric_friction_max_n();
            assert!(end_n >= up_to_n.min(largest_n) && end_n <= largest_n);
            // No row is wider than a quarter of the friction at its start.
            assert!(end_n <= 1.26 * up_to_n.max(knee_n), "{up_to_n:e} ends at {end_n:e}");
            let frictions = (0..=u32::MAX).step_by(100_003).map(f32::from_bits);
            for x in frictions.chain([up_to_n, end_n, end_n.next_up(), f32::NAN, f32::INFINITY]) {
                let expected = if x > end_n { table.voltage_max_v_rms() } else { whole.voltage_v_rms(x) };
                assert_eq!(table.voltage_v_rms(x).to_bits(), expected.to_bits(), "{x:e} of {up_to_n:e}");
            }
            let at_end_v_rms = f64::from(table.voltage_v_rms(end_n));
            assert!((at_end_v_rms / f64::from(table.voltage_max_v_rms()) - 1.0).abs() < BOUND);
            assert!(rows(up_to_n) <= fewest);
            fewest = rows(up_to_n);
        }
        assert_eq!(fewest, 1);
        assert_eq!(rows(f32::NAN), rows(f32::INFINITY));
        assert_eq!(InverseTable::build_up_to(&contact, voltage_max_v_rms, f32::NAN).unwrap(), whole);
        // An octave has four rows.
        assert_eq!(rows(f32::INFINITY) - rows(0.499 * largest_n), 4);
    }
}
