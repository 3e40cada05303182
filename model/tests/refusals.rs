//! Invalid parameters, and the errors that the model returns for them.
#![allow(clippy::unwrap_used)]

use frixel_model::{
    Contact, ContactModel, Expected, Finger, InverseError, ParameterError, PowerLawShape, Slab, SoftFinger, StateError,
    TissueSpring, attraction_pa, contact_exponent, effective_gap_m,
};

const BAD: [f64; 5] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0];
const FINGER: Finger<f64> = Finger::<f64>::EXAMPLE;
const SOFT: SoftFinger<f64> = SoftFinger {
    radius_m: 8e-3,
    modulus_pa: 1e5,
    stress_exponent: 0.5,
    shape_constant: 4.5,
    friction_coefficient: 0.5,
};

#[track_caller]
fn refused<A>(result: Result<A, impl Into<StateError>>, parameter: &str) {
    match result.err().map(Into::into) {
        Some(StateError::Parameter(error)) => {
            assert_eq!(error.parameter, parameter);
            assert!(error.to_string().starts_with(parameter), "{error}");
        }
        other => assert_eq!(other, None, "expected {parameter} to be refused"),
    }
}

#[test]
fn parameters_are_refused_by_name() {
    for bad in BAD {
        refused(Contact::new(&Finger { radius_m: bad, ..FINGER }, 1e-5), "radius_m");
        refused(Contact::new(&Finger { stiffness_pa_per_m: bad, ..FINGER }, 1e-5), "stiffness_pa_per_m");
        refused(Contact::new(&Finger { friction_coefficient: bad, ..FINGER }, 1e-5), "friction_coefficient");
        refused(Contact::new(&FINGER, bad), "gap_m");
        refused(SOFT.on_gap(bad), "gap_m");
        refused(SoftFinger { radius_m: bad, ..SOFT }.on_gap(1e-5), "radius_m");
        refused(SoftFinger { modulus_pa: bad, ..SOFT }.on_gap(1e-5), "modulus_pa");
        refused(SoftFinger { shape_constant: bad, ..SOFT }.on_gap(1e-5), "shape_constant");
        refused(SoftFinger { stress_exponent: bad, ..SOFT }.on_gap(1e-5), "stress_exponent");
        refused(SoftFinger { friction_coefficient: bad, ..SOFT }.on_gap(1e-5), "friction_coefficient");
        refused(effective_gap_m(&[Slab { thickness_m: bad, relative_permittivity: 1.0 }]), "thickness_m");
        refused(effective_gap_m(&[Slab { thickness_m: 1e-6, relative_permittivity: bad }]), "relative_permittivity");
        refused(attraction_pa(1.0, bad, 0.0), "gap_m");
        refused(Contact::new(&FINGER, 1e-5).unwrap().within(bad, 0.5), "outer_radius_m");
        refused(Contact::new(&FINGER, 1e-5).unwrap().under_pull(bad), "pull_n");
        refused(PowerLawShape::new(bad, 1.0, 0.5), "exponent");
        refused(PowerLawShape::new(2.0, bad, 0.5), "coefficient");
        let spring = TissueSpring { stiffness_n_per_m: 100.0, length_m: 1e-2, gap_m: 1e-4, friction_coefficient: 0.5 };
        refused(TissueSpring { stiffness_n_per_m: bad, ..spring }.onset(1.0), "stiffness_n_per_m");
        refused(TissueSpring { length_m: bad, ..spring }.onset(1.0), "length_m");
        refused(TissueSpring { gap_m: bad, ..spring }.onset(1.0), "gap_m");
        refused(TissueSpring { friction_coefficient: bad, ..spring }.onset(1.0), "friction_coefficient");
        refused(spring.onset(bad), "attraction_n");
    }
    refused(effective_gap_m::<f64>(&[]), "gap_m");
    refused(contact_exponent(1.1), "stress_exponent");
    refused(PowerLawShape::new(0.9, 1.0, 0.5), "exponent");
    // In f32 this coating's scales leave the range.
    let finger = Finger { radius_m: 8e-3_f32, stiffness_pa_per_m: 1e3, friction_coefficient: 0.5 };
    refused(Contact::new(&finger, 1e-25), "gap_m");
}

#[test]
fn loads_voltages_and_frictions_are_refused_by_name() {
    let contact = Contact::new(&FINGER, 1e-5).unwrap();
    let soft = SOFT.on_gap(1e-5).unwrap();
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        refused(contact.under_load(bad), "normal_load_n");
        refused(contact.within(6e-3, bad), "normal_load_n");
        refused(soft.under_load(bad), "normal_load_n");
        let models: [&dyn ContactModel<f64>; 6] = [
            &contact.under_load(0.5).unwrap(),
            &contact.under_pull(0.5).unwrap(),
            &contact.lower_bound(0.5).unwrap(),
            &contact.within(6e-3, 0.5).unwrap(),
            &soft.under_load(0.5).unwrap(),
            &soft.lower_bound(),
        ];
        for model in models {
            refused(model.state(bad), "voltage_v_rms");
            refused(model.sensitivity(bad), "voltage_v_rms");
            for (parameter, answer) in [
                ("friction_n", model.voltage_for_friction(bad)),
                ("electric_friction_n", model.voltage_for_electric_friction(bad)),
            ] {
                let expected = if bad.is_finite() {
                    InverseError::BelowNatural
                } else {
                    InverseError::Parameter(ParameterError { parameter, expected: Expected::Finite, found: bad })
                };
                assert_eq!(answer.unwrap_err().to_string(), expected.to_string());
            }
        }
        refused(contact.pull_off_load_n(bad), "voltage_v_rms");
        refused(contact.normal_load_n(1e-3, bad), "voltage_v_rms");
        refused(contact.normal_load_n(bad, 1.0), "contact_radius_m");
        refused(contact.capacitance_f(bad, 1.0, 6e-3), "contact_radius_m");
    }
    refused(contact.lower_bound(f64::NAN), "normal_load_n");
    // The error names the argument as it was given, not a value derived from it.
    let thin = Contact::new(&FINGER, 1e-9).unwrap();
    let error = thin.under_load(1e308).unwrap_err();
    assert_eq!(error.to_string(), "normal_load_n of 1e308 leads to numbers too large or too small for this precision");
    refused(thin.lower_bound(-1e308), "normal_load_n");
    refused(thin.within(6e-3, 1e308), "normal_load_n");
    refused(thin.under_pull(1e308), "pull_n");
    refused(thin.under_pull(5e-324), "pull_n");
    refused(attraction_pa(1e300, 1e-5, 0.0), "voltage_v_rms");
    refused(contact.capacitance_f(7e-3, 1.0, 6e-3), "contact_radius_m");
}

#[test]
fn inputs_without_an_answer_give_an_error() {
    let contact = Contact::new(&FINGER, 1e-5).unwrap();
    let pulled = contact.under_pull(0.01).unwrap();
    assert_eq!(pulled.state(0.0).unwrap_err(), StateError::NoContact);
    assert_eq!(contact.lower_bound(-0.01).unwrap().state(1.0).unwrap_err(), StateError::NoContact);
    assert_eq!(contact.within(3e-3, 0.5).unwrap().state(150.0).unwrap_err(), StateError::PassesOuterRadius);
    let loaded = contact.under_load(0.5).unwrap();
    assert_eq!(loaded.voltage_for_friction(0.2).unwrap_err(), InverseError::BelowNatural);
    assert_eq!(loaded.voltage_for_electric_friction(-1e-9).unwrap_err(), InverseError::BelowNatural);
    assert_eq!(loaded.state(1e200).unwrap_err(), StateError::OutOfRange);
    let spring = TissueSpring { stiffness_n_per_m: 100.0, length_m: 1e-2, gap_m: 1e-4, friction_coefficient: 0.5 };
    assert_eq!(spring.onset(0.009).unwrap_err(), StateError::NoContact);
    for error in
        [StateError::NoContact, StateError::PassesOuterRadius, StateError::OutOfRange, StateError::NotConverged]
    {
        assert!(error.to_string().len() > 20, "{error}");
    }
    let unanswered = [InverseError::BelowNatural, InverseError::Unstable, InverseError::PassesOuterRadius];
    for error in unanswered.into_iter().chain([InverseError::OutOfRange, InverseError::NotConverged]) {
        assert!(error.to_string().len() > 20, "{error}");
    }
}
