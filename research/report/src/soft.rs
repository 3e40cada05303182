//! The soft finger of Xydas and Kao compared with Winkler-Fuss springs.
use core::f64::consts::PI;
use std::error::Error;

use frixel::report::{Data, Figure};
use frixel_chart::{Axis, Chart, Line, Look, PALETTE, Panel, graded};
use frixel_model::{ContactModel, ParameterError, SoftContact, SoftFinger, contact_exponent};

use super::{example, geometric};

/// Stress exponents; at 0.5 the stiffness is constant.
const STRESS_EXPONENTS: [f64; 5] = [0.1, 0.3, 0.5, 0.75, 1.0];
/// The constant `B` of Eq. (24), of the magnitude of a hemisphere's.
const SHAPE_CONSTANT: f64 = 4.5;

/// A soft finger with the stiffness of the example finger at the example load: Eq. (26) solved for the modulus.
pub(super) fn alike(stress_exponent: f64) -> Result<SoftFinger<f64>, ParameterError> {
    let springs = example::FINGER;
    let (radius, stiffness) = (springs.radius_m, springs.stiffness_pa_per_m);
    let four_gamma = 4.0 * contact_exponent(stress_exponent)?;
    // k = S/(pi R^3) (P/S)^(1 - 4 gamma) with S = B E R^2.
    let scale_n = (PI * radius.powi(3) * stiffness * example::LOAD_N.powf(four_gamma - 1.0)).powf(1.0 / four_gamma);
    Ok(SoftFinger {
        radius_m: radius,
        modulus_pa: scale_n / (SHAPE_CONSTANT * radius * radius),
        stress_exponent,
        shape_constant: SHAPE_CONSTANT,
        friction_coefficient: springs.friction_coefficient,
    })
}

pub(super) fn figure() -> Result<Figure, Box<dyn Error>> {
    let volts = || Axis::log("voltage, V rms", 1.0..1e3);
    let mut unloaded = Panel::new("No load", volts(), Axis::log("friction, mN", 1e-7..1e5));
    let mut loaded = Panel::new(
        "Under 0.5 N: what voltage adds",
        volts(),
        Axis::log("electric friction F_T − µ F_N, mN", 1e-4..1e5),
    );
    let mut data = Data::new([
        "finger",
        "stress_exponent",
        "modulus_pa",
        "normal_force_n",
        "voltage_v_rms",
        "electric_friction_n",
        "stiffness_pa_per_m",
    ]);
    let mut curve = |name: &str, soft: Option<&SoftFinger<f64>>, load_n: f64, model: &dyn ContactModel<f64>| {
        let mut points = Vec::new();
        for voltage in geometric(1.0, 1e3, 121) {
            let state = model.state(voltage)?;
            points.push((voltage, 1e3 * state.electric_friction_n));
            data.row([
                name.into(),
                soft.map(|finger| finger.stress_exponent).into(),
                soft.map(|finger| finger.modulus_pa).into(),
                load_n.into(),
                voltage.into(),
                state.electric_friction_n.into(),
                state.stiffness_pa_per_m.into(),
            ]);
        }
        Ok::<_, Box<dyn Error>>(points)
    };
    for (index, stress_exponent) in STRESS_EXPONENTS.into_iter().enumerate() {
        let finger = alike(stress_exponent)?;
        let contact = SoftContact::new(&finger, example::GAP_M)?;
        let colour = graded(index, STRESS_EXPONENTS.len());
        let name = format!("soft, stress exponent {stress_exponent}");
        let solid = Look::line(colour, Line::Solid);
        unloaded.add(&name, solid, curve("soft-upper", Some(&finger), 0.0, &contact.under_load(0.0)?)?);
        let lower = curve("soft-lower", Some(&finger), 0.0, &contact.lower_bound())?;
        unloaded.add("", Look::line(colour, Line::Dashed), lower);
        loaded.add(
            &name,
            solid,
            curve("soft-loaded", Some(&finger), example::LOAD_N, &contact.under_load(example::LOAD_N)?)?,
        );
    }
    let springs = Look::line(PALETTE[1], Line::Dashed);
    let contact = example::contact::<f64>()?;
    loaded.add(
        "Winkler-Fuss",
        springs,
        curve("wf-loaded", None, example::LOAD_N, &contact.under_load(example::LOAD_N)?)?,
    );
    unloaded.add("Winkler-Fuss", springs, curve("wf-upper", None, 0.0, &contact.under_load(0.0)?)?);
    unloaded.add("lower bound, Eq. (40)", Look::line(PALETTE[6], Line::Dashed), Vec::new());
    Ok(Figure {
        name: "soft-finger",
        title: "Soft finger against Winkler-Fuss".to_owned(),
        caption: vec![
            "A soft finger's stiffness follows from the force it carries, Eq. (29). All of these are as stiff as the \
             example finger under 0.5 N. Left: without a load they carry far less, so that a stress exponent below 0.5 \
             makes them softer there and one above it stiffer; the lower bounds, Eq. (40), grow with the power 2 s + 1 \
             of σ₀ ∝ V². Right: under the load at which they are alike they stay alike until voltage adds as much as \
             the load."
                .to_owned(),
            "A stress exponent of 0.5 has a constant stiffness, and falls on the Winkler-Fuss finger.".to_owned(),
            example::CAPTION.to_owned(),
        ],
        chart: Chart::new(vec![unloaded, loaded], 2).with_shared_legend(),
        csv: data.csv()?,
    })
}
