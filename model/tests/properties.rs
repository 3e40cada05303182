//! Properties that hold for every finger, coating, load and voltage.
#![allow(clippy::unwrap_used, clippy::panic)]

use frixel_model::{
    Contact, ContactModel, Finger, InverseError, Real, SoftFinger, StateError, TissueSpring, contact_attraction_pa,
};
use proptest::prelude::*;

/// A number from `low` to `high`, evenly spread in its logarithm.
fn log_range(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

fn fingers() -> impl Strategy<Value = (Finger<f64>, f64)> {
    (log_range(1e-3, 5e-2), log_range(1e3, 1e14), log_range(0.01, 10.0), log_range(1e-12, 1e-3)).prop_map(
        |(radius_m, stiffness_pa_per_m, friction_coefficient, gap_m)| {
            (Finger { radius_m, stiffness_pa_per_m, friction_coefficient }, gap_m)
        },
    )
}

fn soft_fingers() -> impl Strategy<Value = (SoftFinger<f64>, f64)> {
    let finger = (log_range(1e-3, 5e-2), log_range(1e2, 1e10), log_range(0.02, 1.0), log_range(0.1, 10.0));
    (finger, log_range(0.01, 10.0), log_range(1e-7, 1e-3)).prop_map(|(finger, friction_coefficient, gap_m)| {
        let (radius_m, modulus_pa, stress_exponent, shape_constant) = finger;
        (SoftFinger { radius_m, modulus_pa, stress_exponent, shape_constant, friction_coefficient }, gap_m)
    })
}

fn loads() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), log_range(1e-9, 50.0)]
}

/// The same finger in f32.
fn narrow((finger, gap_m): &(Finger<f64>, f64)) -> (Finger<f32>, f32) {
    let Finger { radius_m, stiffness_pa_per_m, friction_coefficient } = *finger;
    (
        Finger {
            radius_m: radius_m as f32,
            stiffness_pa_per_m: stiffness_pa_per_m as f32,
            friction_coefficient: friction_coefficient as f32,
        },
        *gap_m as f32,
    )
}

/// Asserts that all results of a model at a voltage are finite, and that its inverse returns the voltage.
fn answers<T: Real>(model: &dyn ContactModel<T>, voltage_v_rms: T, tolerance: f64) {
    let state = match model.state(voltage_v_rms) {
        Ok(state) => state,
        Err(StateError::OutOfRange | StateError::NoContact | StateError::PassesOuterRadius) => return,
        Err(error) => panic!("{error}"),
    };
    for number in [state.contact_radius_m, state.stiffness_pa_per_m, state.friction_n, state.electric_friction_n] {
        assert!(number.is_finite() && number >= T::ZERO);
    }
    // Subnormal numbers have no relative precision.
    if state.electric_friction_n < T::MIN_POSITIVE {
        return;
    }
    let again: f64 = match model.voltage_for_electric_friction(state.electric_friction_n) {
        Ok(again) => again.into(),
        Err(InverseError::PassesOuterRadius | InverseError::Unstable) => return,
        Err(error) => panic!("{error}"),
    };
    let voltage: f64 = voltage_v_rms.into();
    assert!((again / voltage - 1.0).abs() <= tolerance, "{again} for {voltage}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn inverse_undoes_forward(
        finger in fingers(), load_n in loads(), voltage in log_range(1e-6, 1e4), beyond in log_range(1.0, 1e6)
    ) {
        let contact = Contact::new(&finger.0, finger.1).unwrap();
        let loaded = contact.under_load(load_n).unwrap();
        answers(&loaded, voltage, 1e-14);
        answers(&contact.lower_bound(load_n).unwrap(), voltage, 1e-14);
        if let Ok(state) = loaded.state(voltage) {
            answers(&contact.within(state.contact_radius_m * beyond, load_n).unwrap(), voltage, 1e-13);
        }
        let (finger, gap_m) = narrow(&finger);
        let contact = Contact::new(&finger, gap_m).unwrap();
        answers(&contact.under_load(load_n as f32).unwrap(), voltage as f32, 2e-6);
        answers(&contact.lower_bound(load_n as f32).unwrap(), voltage as f32, 2e-6);
    }

    #[test]
    fn soft_inverse_undoes_forward(finger in soft_fingers(), load_n in loads(), voltage in log_range(1e-3, 1e4)) {
        let contact = finger.0.on_gap(finger.1).unwrap();
        answers(&contact.under_load(load_n).unwrap(), voltage, 1e-13);
        answers(&contact.lower_bound(), voltage, 1e-13);
    }

    /// The exponent is between 2 and 4 for every load, and between 2 and 4 s + 2 for a soft finger without load.
    #[test]
    fn electric_friction_grows_with_a_power_of_the_voltage(
        finger in fingers(), soft in soft_fingers(), load_n in loads(), voltage in log_range(1e-3, 1e3)
    ) {
        let power = |model: &dyn ContactModel<f64>| {
            let state = model.state(voltage).unwrap();
            let sensitivity = model.sensitivity(voltage).unwrap();
            sensitivity.friction_per_volt_n_per_v * voltage / state.electric_friction_n
        };
        let loaded = Contact::new(&finger.0, finger.1).unwrap().under_load(load_n).unwrap();
        prop_assert!((2.0 - 1e-9..=4.0 + 1e-9).contains(&power(&loaded)));
        let s = soft.0.stress_exponent;
        let upper = soft.0.on_gap(soft.1).unwrap().under_load(0.0).unwrap();
        prop_assert!((2.0 - 1e-9..=2.0 + 4.0 * s + 1e-9).contains(&power(&upper)));
    }

    /// Friction rises with the attraction around the contact: none, up to an outer radius, to any distance.
    #[test]
    fn bounds_enclose_the_finite_finger(
        finger in fingers(), load_n in loads(), voltage in log_range(1e-3, 1e3), beyond in log_range(1.001, 1e6)
    ) {
        let contact = Contact::new(&finger.0, finger.1).unwrap();
        let upper = contact.under_load(load_n).unwrap().state(voltage).unwrap();
        let lower = contact.lower_bound(load_n).unwrap().state(voltage).unwrap();
        let finite = contact.within(upper.contact_radius_m * beyond, load_n).unwrap().state(voltage).unwrap();
        prop_assert!(lower.electric_friction_n <= finite.electric_friction_n * (1.0 + 1e-13));
        prop_assert!(finite.electric_friction_n <= upper.electric_friction_n * (1.0 + 1e-13));
    }

    /// A contact may reach the outer radius, but not extend beyond it.
    #[test]
    fn contact_may_reach_the_outer_radius(finger in fingers(), load_n in loads(), voltage in log_range(1e-3, 1e3)) {
        fn reaches<T: Real>(contact: Contact<T>, load_n: T, voltage: T) {
            let reached = contact.lower_bound(load_n).unwrap().state(voltage).unwrap();
            let same = contact.within(reached.contact_radius_m, load_n).unwrap();
            let state = same.state(voltage).unwrap();
            let ratio: f64 = (state.contact_radius_m / reached.contact_radius_m).into();
            assert!((ratio - 1.0).abs() < 8.0 * T::EPSILON.into());
            assert!(same.voltage_for_electric_friction(reached.electric_friction_n).is_ok());
            let beyond = contact.within(reached.contact_radius_m * T::from_f64(0.999), load_n).unwrap();
            assert_eq!(beyond.state(voltage).unwrap_err(), StateError::PassesOuterRadius);
            let inverse = beyond.voltage_for_electric_friction(reached.electric_friction_n);
            assert_eq!(inverse.unwrap_err(), InverseError::PassesOuterRadius);
        }
        reaches(Contact::new(&finger.0, finger.1).unwrap(), load_n, voltage);
        let (finger, gap_m) = narrow(&finger);
        let contact = Contact::new(&finger, gap_m).unwrap();
        // In f32 only where no result leaves the range.
        let lower_bound = contact.lower_bound(load_n as f32).unwrap();
        let friction_n = lower_bound.state(voltage as f32).map_or(0.0, |state| state.electric_friction_n);
        if friction_n > 1e-30 {
            reaches(contact, load_n as f32, voltage as f32);
        }
    }

    /// Eqs. (20), (21): the pressure of Eq. (14) over the contact is friction over its coefficient.
    #[test]
    fn pressure_adds_up_to_friction(finger in fingers(), load_n in loads(), voltage in log_range(1e-3, 1e3)) {
        let state = Contact::new(&finger.0, finger.1).unwrap().under_load(load_n).unwrap().state(voltage).unwrap();
        let a = state.contact_radius_m;
        let rings = 1000;
        let force_n: f64 = (0..rings).map(|ring| {
            let (inner, outer) = (a * f64::from(ring) / f64::from(rings), a * f64::from(ring + 1) / f64::from(rings));
            let middle = (0.5 * (inner * inner + outer * outer)).sqrt();
            core::f64::consts::PI * (outer * outer - inner * inner) * finger.0.contact_pressure_pa(a, middle).unwrap()
        }).sum();
        prop_assert!((force_n * finger.0.friction_coefficient / state.friction_n - 1.0).abs() < 1e-9);
    }

    /// At pull-off both areas of Eq. (43) meet. Above its voltage there is contact, below there is none.
    #[test]
    fn pull_off_is_where_contact_ends(finger in fingers(), voltage in log_range(1e-2, 1e3)) {
        let contact = Contact::new(&finger.0, finger.1).unwrap();
        let pull_n = -contact.pull_off_load_n(voltage).unwrap();
        prop_assume!(pull_n > 1e-200);
        let pulled = contact.under_pull(pull_n).unwrap();
        let pull_off = pulled.pull_off_voltage_v_rms().unwrap();
        prop_assert!((pull_off / voltage - 1.0).abs() < 1e-14);
        prop_assert_eq!(pulled.state(pull_off * 0.999_999).unwrap_err(), StateError::NoContact);
        let state = pulled.state(pull_off * 1.000_001).unwrap();
        let least = pulled.pull_off_friction_n().unwrap();
        prop_assert!(state.friction_n > least);
        prop_assert_eq!(pulled.voltage_for_friction(least * 0.999_999).unwrap_err(), InverseError::Unstable);
        let (reached, _) = pulled.reachable_friction_n(voltage * 2.0).unwrap();
        prop_assert!((reached / least - 1.0).abs() < 1e-15);
    }

    /// A Winkler-Fuss finger of the soft finger's stiffness has the soft finger's contact.
    #[test]
    fn soft_finger_is_self_consistent(soft in soft_fingers(), load_n in loads(), voltage in log_range(1e-1, 1e3)) {
        let (finger, gap_m) = soft;
        let state = finger.on_gap(gap_m).unwrap().under_load(load_n).unwrap().state(voltage).unwrap();
        let springs = Finger {
            radius_m: finger.radius_m,
            stiffness_pa_per_m: state.stiffness_pa_per_m,
            friction_coefficient: finger.friction_coefficient,
        };
        let same = Contact::new(&springs, gap_m).unwrap().under_load(load_n).unwrap().state(voltage).unwrap();
        prop_assert!((same.contact_radius_m / state.contact_radius_m - 1.0).abs() < 1e-12);
        prop_assert!((same.electric_friction_n / state.electric_friction_n - 1.0).abs() < 1e-12);
        let stiffness = finger.stiffness_pa_per_m(state.friction_n / finger.friction_coefficient).unwrap();
        prop_assert!((stiffness / state.stiffness_pa_per_m - 1.0).abs() < 1e-12);
    }

    /// The sheared spring in equilibrium, from the angle alone: N = F_a - T cos(phi), T sin(phi) = mu N, N < N0.
    #[test]
    fn sheared_spring_is_in_equilibrium(
        k in log_range(1.0, 1e5), l in log_range(1e-4, 1e-1), h in log_range(1e-6, 1e-3), mu in log_range(0.05, 3.0),
        excess in log_range(1e-3, 1e4)
    ) {
        let spring = TissueSpring { stiffness_n_per_m: k, length_m: l, gap_m: h, friction_coefficient: mu };
        let attraction_n = k * h * (1.0 + excess);
        let onset = spring.onset(attraction_n).unwrap();
        let tension = k * ((h + l) / onset.angle_rad.cos() - l);
        let normal_n = attraction_n - tension * onset.angle_rad.cos();
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * attraction_n;
        prop_assert!(close(onset.normal_reaction_n, normal_n));
        prop_assert!(close(onset.tangential_force_n, tension * onset.angle_rad.sin()));
        prop_assert!(onset.normal_reaction_n < onset.initial_reaction_n);
        prop_assert!(((onset.displacement_m / (h + l)).atan() / onset.angle_rad - 1.0).abs() < 1e-14);
    }
}

/// The slope `d ln F_T/d ln sigma0`, which is half of that over the voltage.
fn slope(model: &dyn ContactModel<f64>, voltage_v_rms: f64) -> f64 {
    let (low, high) = (model.state(voltage_v_rms * 0.999).unwrap(), model.state(voltage_v_rms * 1.001).unwrap());
    (high.friction_n / low.friction_n).ln() / (1.001_f64 / 0.999).ln() / 2.0
}

/// Eqs. (34), (36) begin with slope 1 in sigma0; Section VI.A of the paper says 2.
#[test]
fn limits_of_small_and_large_voltage() {
    let finger = Finger::<f64>::EXAMPLE;
    let (gap_m, outer_radius_m) = (1e-5, 4e-4);
    let contact = Contact::new(&finger, gap_m).unwrap();
    let upper = contact.under_load(0.0).unwrap();
    let lower = contact.lower_bound(0.0).unwrap();
    let finite = contact.within(outer_radius_m, 0.0).unwrap();
    let (tiny, huge) = (1e-6 * contact.voltage_scale_v_rms(), 1e6 * contact.voltage_scale_v_rms());
    assert!((slope(&upper, tiny) - 1.0).abs() < 1e-5);
    assert!((slope(&finite, tiny) - 1.0).abs() < 1e-5);
    assert!((slope(&lower, tiny) - 2.0).abs() < 1e-9);
    assert!((slope(&upper, huge) - 2.0).abs() < 1e-9);

    let sigma0 = contact_attraction_pa(tiny, gap_m).unwrap();
    let mu = finger.friction_coefficient;
    let first_order_n = 2.0 * core::f64::consts::PI * mu * finger.radius_m * gap_m * sigma0;
    assert!((upper.state(tiny).unwrap().friction_n / first_order_n - 1.0).abs() < 1e-5);
    let beta = contact.area(outer_radius_m);
    let finite_n = finite.state(tiny).unwrap().friction_n;
    assert!((finite_n / (first_order_n * beta / (1.0 + beta)) - 1.0).abs() < 1e-5);

    let sigma0 = contact_attraction_pa(huge, gap_m).unwrap();
    let second_order_n =
        mu * 4.0 * core::f64::consts::PI * finger.radius_m / finger.stiffness_pa_per_m * sigma0 * sigma0;
    assert!((lower.state(huge).unwrap().friction_n / second_order_n - 1.0).abs() < 1e-14);
    assert!((upper.state(huge).unwrap().friction_n / second_order_n - 1.0).abs() < 1e-9);

    // The soft bounds: slope 1 and 2 s + 1.
    let soft = SoftFinger {
        radius_m: 8e-3,
        modulus_pa: 1e5,
        stress_exponent: 0.3,
        shape_constant: 4.5,
        friction_coefficient: 0.5,
    };
    let soft = soft.on_gap(gap_m).unwrap();
    assert!((slope(&soft.lower_bound(), 1.0) - 1.6).abs() < 1e-9);
    assert!((slope(&soft.under_load(0.0).unwrap(), 1e-12) - 1.0).abs() < 1e-4);
}

/// At the ends of f32, each result of the lower bound is computed independently: the stiffness stays representable
/// where friction is not, and friction where its scaled value is not.
#[test]
fn the_soft_lower_bound_returns_every_result_that_f32_can_represent() {
    let (soft, hard) = (131_072.0, 2_147_483_648.0);
    for (modulus_pa, stress_exponent, voltage) in
        [(soft, 1.0, 1e-5), (soft, 0.75, 1e-7), (soft, 0.02, 1e-16), (hard, 1.0, 0.05), (hard, 1.0, 0.0123)]
    {
        fn state<T: Real>(modulus_pa: f32, stress_exponent: f32, voltage: f32) -> frixel_model::ContactState<T> {
            let finger = SoftFinger {
                radius_m: T::from(1.0 / 128.0),
                modulus_pa: T::from(modulus_pa),
                stress_exponent: T::from(stress_exponent),
                shape_constant: T::from(4.5),
                friction_coefficient: T::from(0.5),
            };
            finger.on_gap(T::from(1.0 / 131_072.0)).unwrap().lower_bound().state(T::from(voltage)).unwrap()
        }
        let (right, found) =
            (state::<f64>(modulus_pa, stress_exponent, voltage), state::<f32>(modulus_pa, stress_exponent, voltage));
        let ratio = f64::from(found.stiffness_pa_per_m) / right.stiffness_pa_per_m;
        assert!((ratio - 1.0).abs() < 1e-5, "{stress_exponent}: {ratio}");
        if right.friction_n > f64::from(f32::MIN_POSITIVE) {
            let ratio = f64::from(found.friction_n) / right.friction_n;
            assert!((ratio - 1.0).abs() < 1e-5, "{stress_exponent}: {ratio}");
        }
    }
}

/// Eqs. (24)-(26): the stiffness makes the two force laws one; Eqs. (46), (47) with a paraboloid are the soft finger's.
#[test]
fn force_laws_agree() {
    for stress_exponent in [0.02, 0.3, 0.5, 1.0] {
        let soft = SoftFinger {
            radius_m: 8e-3_f64,
            modulus_pa: 1e5,
            stress_exponent,
            shape_constant: 4.5,
            friction_coefficient: 0.5,
        };
        let gamma = frixel_model::contact_exponent(stress_exponent).unwrap();
        for approach_m in [1e-4, 1e-3, 5e-3] {
            let load_n = soft.normal_load_n(approach_m).unwrap();
            let by_hand = 4.5 * 1e5 * 6.4e-5 * (approach_m / 8e-3).powf(1.0 / (2.0 * gamma));
            assert!((load_n / by_hand - 1.0).abs() < 1e-12);
            let stiffness_pa_per_m = soft.stiffness_pa_per_m(load_n).unwrap();
            let springs = Finger { radius_m: 8e-3, stiffness_pa_per_m, friction_coefficient: 0.5 };
            assert!((springs.normal_load_n(approach_m).unwrap() / load_n - 1.0).abs() < 1e-11);
        }
        let shape = frixel_model::PowerLawShape::new(2.0, 1.0 / 16e-3, stress_exponent).unwrap();
        assert!((shape.profile_m(1e-3).unwrap() / 6.25e-5 - 1.0).abs() < 1e-14);
        assert!((shape.contact_radius_exponent() - gamma).abs() < 1e-15);
        let unit_m = 1e-3;
        assert!((shape.contact_radius_m(3.0, unit_m).unwrap() / (unit_m * 3_f64.powf(gamma)) - 1.0).abs() < 1e-14);
        assert!((shape.approach_m(3.0, unit_m).unwrap() / (unit_m * 3_f64.powf(2.0 * gamma)) - 1.0).abs() < 1e-14);
    }
}

/// Friction identifies only mu, F* and V*: a second finger with another R, k and g has the same friction everywhere.
#[test]
fn friction_does_not_identify_radius_stiffness_and_gap() {
    let one = Contact::new(&Finger::<f64>::EXAMPLE, 1e-5);
    let other =
        Contact::new(&Finger { radius_m: 16e-3_f64, stiffness_pa_per_m: 2.25e6, friction_coefficient: 0.5 }, 2e-5);
    for load_n in [0.0, 0.1, 0.5] {
        let (one, other) = (one.unwrap().under_load(load_n).unwrap(), other.unwrap().under_load(load_n).unwrap());
        for voltage_v_rms in [1.0, 30.0, 150.0] {
            let (a, b) = (one.state(voltage_v_rms).unwrap(), other.state(voltage_v_rms).unwrap());
            assert!((b.friction_n / a.friction_n - 1.0).abs() < 1e-14);
            assert!((b.contact_radius_m / a.contact_radius_m - 2.0).abs() < 1e-13);
        }
    }
}

/// In its own scales, every contact is the universal curve.
#[test]
fn universal_curve_is_every_contacts() {
    let contact = Contact::new(&Finger::<f64>::EXAMPLE, 1e-5);
    let contact = contact.unwrap();
    let load_n = 0.5;
    let universal = Contact::<f64>::universal().under_load(contact.load(load_n)).unwrap();
    for voltage_v_rms in [1.0, 30.0, 150.0] {
        let scaled = universal.electric_friction_n(voltage_v_rms / contact.voltage_scale_v_rms());
        let friction_n = contact.under_load(load_n).unwrap().electric_friction_n(voltage_v_rms);
        assert!((scaled * contact.friction_scale_n() / friction_n - 1.0).abs() < 1e-14);
        assert!(
            (contact.attraction(voltage_v_rms).sqrt() * contact.voltage_scale_v_rms() / voltage_v_rms - 1.0).abs()
                < 1e-14
        );
    }
}
