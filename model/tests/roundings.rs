//! Error bounds that the docs state in roundings: f32 against f64, from the same inputs.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use frixel_model::{
    Contact, Finger, PowerLawShape, Real, SoftFinger, attraction_pa, contact_attraction_pa, contact_exponent,
};
use proptest::prelude::*;

/// Half the distance from one to the next larger f32.
const ROUNDING: f64 = 0.5 * f32::EPSILON as f64;

/// An f32 from `low` to `high`, evenly spread in its logarithm.
fn log_range(low: f64, high: f64) -> impl Strategy<Value = f32> {
    (low.ln()..high.ln()).prop_map(|logarithm| logarithm.exp() as f32)
}

/// The arguments, by name.
struct Inputs {
    radius_m: f32,
    stiffness_pa_per_m: f32,
    gap_m: f32,
    voltage_v_rms: f32,
    force_n: f32,
    approach_m: f32,
    stress_exponent: f32,
    shape_exponent: f32,
}

/// Results, with the number of roundings that their docs allow.
fn answers<T: Real>(inputs: &Inputs) -> Vec<(&'static str, T, f64)> {
    let [radius_m, stiffness_pa_per_m, gap_m, voltage_v_rms, force_n, approach_m, s, lambda] = [
        inputs.radius_m,
        inputs.stiffness_pa_per_m,
        inputs.gap_m,
        inputs.voltage_v_rms,
        inputs.force_n,
        inputs.approach_m,
        inputs.stress_exponent,
        inputs.shape_exponent,
    ]
    .map(T::from);
    let friction_coefficient = T::from(0.5);
    let finger = Finger { radius_m, stiffness_pa_per_m, friction_coefficient };
    let contact = Contact::new(&finger, gap_m).unwrap();
    let (modulus_pa, shape_constant) = (T::from(131_072.0), T::from(4.5));
    let soft = SoftFinger { radius_m, modulus_pa, stress_exponent: s, shape_constant, friction_coefficient };
    let shape = PowerLawShape::new(lambda, T::ONE, s).unwrap();
    let unit_m = T::from(1.0 / 1024.0);
    let wide: f64 = inputs.radius_m.into();
    let (approach_logarithm, load_logarithm) =
        ((f64::from(inputs.approach_m) / wide).ln().abs(), f64::from(inputs.force_n).ln().abs());
    let scaled_logarithm = (f64::from(inputs.force_n) / (4.5 * 131_072.0 * wide * wide)).ln().abs();
    let exponent = 1.0 + 0.5 / f64::from(inputs.stress_exponent);
    vec![
        ("sigma0", contact_attraction_pa(voltage_v_rms, gap_m).unwrap(), 5.0),
        ("sigma", attraction_pa(voltage_v_rms, gap_m, approach_m).unwrap(), 7.0),
        ("V*", contact.voltage_scale_v_rms(), 1.0),
        ("F*", contact.friction_scale_n(), 1.0),
        ("load scale", contact.load_scale_n(), 1.0),
        ("q", contact.attraction(voltage_v_rms), 5.0),
        ("n", contact.load(force_n), 2.0),
        ("y", contact.area(approach_m), 3.0),
        ("profile", finger.profile_m(approach_m), 3.0),
        ("spring force", finger.normal_load_n(approach_m).unwrap(), 6.0),
        ("pressure", finger.contact_pressure_pa(approach_m, friction_coefficient * approach_m).unwrap(), 6.0),
        ("gamma", contact_exponent(s).unwrap(), 3.0),
        ("soft force", soft.normal_load_n(approach_m).unwrap(), 6.0 + exponent * (1.0 + 3.0 * approach_logarithm)),
        ("soft stiffness", soft.stiffness_pa_per_m(force_n).unwrap(), 11.0 + 3.0 * scaled_logarithm),
        ("shape", shape.profile_m(approach_m).unwrap(), 3.0),
        ("radius exponent", shape.contact_radius_exponent(), 3.0),
        ("radius", shape.contact_radius_m(force_n, unit_m).unwrap(), 8.0 * (1.0 + load_logarithm)),
        ("approach", shape.approach_m(force_n, unit_m).unwrap(), 8.0 * (1.0 + load_logarithm)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn bounds_in_roundings_hold(
        radius_m in log_range(1e-3, 5e-2), stiffness_pa_per_m in log_range(1e5, 1e9), gap_m in log_range(1e-7, 1e-3),
        voltage_v_rms in log_range(1e-2, 1e3), force_n in log_range(1e-6, 50.0), approach_m in log_range(1e-5, 1e-2),
        stress_exponent in log_range(0.1, 1.0), shape_exponent in log_range(1.0, 8.0)
    ) {
        let inputs = Inputs {
            radius_m, stiffness_pa_per_m, gap_m, voltage_v_rms, force_n, approach_m, stress_exponent,
            shape_exponent: shape_exponent.max(1.0),
        };
        let (found, expected) = (answers::<f32>(&inputs), answers::<f64>(&inputs));
        for ((name, found, roundings), (_, right, _)) in found.into_iter().zip(expected) {
            if right.abs() < f64::from(f32::MIN_POSITIVE) {
                continue;
            }
            let error = (f64::from(found) / right - 1.0).abs() / ROUNDING;
            prop_assert!(error <= roundings * (1.0 + 1e-6), "{name}: {error} of {roundings} roundings");
        }
    }
}
