//! For arbitrary arguments, in either precision, every function returns a finite number or an error.
#![allow(clippy::panic, reason = "a test may fail")]

use std::fmt::Debug;

use frixel_model::{
    Contact, ContactModel, Finger, PowerLawShape, Real, Slab, SoftFinger, TissueSpring, attraction_pa,
    contact_exponent, effective_gap_m,
};
use proptest::prelude::*;

/// Numbers of every magnitude and sign, most of them realistic for a finger.
fn number() -> impl Strategy<Value = f64> {
    let special = [0.0, -0.0, 1.0, f64::MIN_POSITIVE, f64::MAX, -f64::MAX, 5e-324, f64::INFINITY, f64::NAN];
    prop_oneof![
        6 => (-12.0..8.0_f64).prop_map(|power| 10_f64.powf(power)),
        2 => (-300.0..300.0_f64).prop_map(|power| 10_f64.powf(power)),
        1 => any::<f64>(),
        1 => prop::sample::select(special.to_vec()),
    ]
}

#[track_caller]
fn finite<T: Real, E: Debug>(answer: Result<T, E>) {
    let answer = answer.unwrap_or(T::ZERO);
    assert!(answer.is_finite(), "{answer}");
}

fn contact_answers<T: Real>(model: &dyn ContactModel<T>, voltage: T, friction: T) {
    if let Ok(state) = model.state(voltage) {
        for number in [state.contact_radius_m, state.stiffness_pa_per_m, state.friction_n, state.electric_friction_n] {
            assert!(number.is_finite(), "{state:?}");
        }
    }
    if let Ok(sensitivity) = model.sensitivity(voltage) {
        assert!(sensitivity.friction_per_volt_n_per_v.is_finite(), "{sensitivity:?}");
        assert!(sensitivity.friction_per_load.is_finite(), "{sensitivity:?}");
    }
    finite(model.voltage_for_friction(friction));
    finite(model.voltage_for_electric_friction(friction));
    let reachable = model.reachable_friction_n(voltage);
    finite(reachable.map(|(least, _)| least));
    finite(reachable.map(|(_, largest)| largest));
}

/// Calls every function that returns a `Result`, with `x` as its arguments.
fn everything<T: Real>(x: &[T]) {
    let &[radius, k, mu, gap, load, voltage, friction, outer, modulus, s, b, y] = x else { panic!("twelve numbers") };
    finite(attraction_pa(voltage, gap, outer));
    finite(contact_exponent(s));
    finite(effective_gap_m(&[Slab { thickness_m: gap, relative_permittivity: k }]));
    let finger = Finger { radius_m: radius, stiffness_pa_per_m: k, friction_coefficient: mu };
    finite(finger.normal_load_n(y));
    finite(finger.approach_m(y, load));
    finite(finger.contact_pressure_pa(outer, y));
    if let Ok(contact) = Contact::new(&finger, gap) {
        finite(contact.pull_off_load_n(voltage));
        finite(contact.normal_load_n(y, voltage));
        finite(contact.capacitance_f(y, voltage, outer));
        if let Ok(loaded) = contact.under_load(load) {
            contact_answers(&loaded, voltage, friction);
        }
        if let Ok(lower) = contact.lower_bound(load) {
            contact_answers(&lower, voltage, friction);
        }
        if let Ok(lower) = contact.lower_bound(-load) {
            contact_answers(&lower, voltage, friction);
        }
        if let Ok(finite_contact) = contact.within(outer, load) {
            contact_answers(&finite_contact, voltage, friction);
            finite(finite_contact.capacitance_f(voltage));
        }
        if let Ok(pulled) = contact.under_pull(load) {
            contact_answers(&pulled, voltage, friction);
            finite(pulled.pull_off_voltage_v_rms());
            finite(pulled.pull_off_friction_n());
        }
    }
    let soft = SoftFinger {
        radius_m: radius,
        modulus_pa: modulus,
        stress_exponent: s,
        shape_constant: b,
        friction_coefficient: mu,
    };
    finite(soft.normal_load_n(y));
    finite(soft.stiffness_pa_per_m(load));
    if let Ok(contact) = soft.on_gap(gap) {
        contact_answers(&contact.lower_bound(), voltage, friction);
        if let Ok(loaded) = contact.under_load(load) {
            contact_answers(&loaded, voltage, friction);
        }
    }
    if let Ok(shape) = PowerLawShape::new(b, k, s) {
        finite(shape.profile_m(y));
        finite(shape.contact_radius_m(load, y));
        finite(shape.approach_m(load, y));
    }
    let spring = TissueSpring { stiffness_n_per_m: k, length_m: y, gap_m: gap, friction_coefficient: mu };
    if let Ok(onset) = spring.onset(load) {
        for number in [onset.angle_rad, onset.displacement_m, onset.normal_reaction_n, onset.tangential_force_n] {
            assert!(number.is_finite(), "{onset:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn every_answer_is_finite_or_an_error(numbers in prop::collection::vec(number(), 12), exponent in 0.0..1.0_f64) {
        let mut numbers = numbers;
        // Half of the stress exponents are one.
        if exponent > 0.5 {
            numbers[9] = 2.0 * (exponent - 0.5);
        }
        everything::<f64>(&numbers);
        let single: Vec<f32> = numbers.iter().map(|number| *number as f32).collect();
        everything::<f32>(&single);
    }
}
