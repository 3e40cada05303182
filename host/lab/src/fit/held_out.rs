//! Prediction error of a fit in held-out strokes.

use super::contrast::StrokeMeans;
use super::least_squares::{Observation, Solution};
use super::search::{Replicate, Search, attraction_of};
use crate::statistics::mean;

/// Errors of electric friction in strokes that were left out of the fit, one after the other. The noise of a single
/// stroke is part of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldOut {
    /// Mean electric friction of the strokes, in newtons.
    pub mean_n: f64,
    /// Root mean square error of the contact model, in newtons.
    pub contact_error_n: f64,
    /// Root mean square error of the power law, in newtons.
    pub power_law_error_n: f64,
}

impl HeldOut {
    /// An error, and the mean electric friction, in words.
    pub(super) fn words(error_n: f64, mean_n: f64) -> String {
        let percent = 100.0 * error_n / mean_n;
        format!("their electric friction is predicted within {:.1} mN rms, {percent:.1} %", 1e3 * error_n)
    }

    /// Fits the laws to all strokes but one, for each; `None` if such a fit does not converge.
    pub(super) fn of(search: &Search<'_>, strokes: &[StrokeMeans], best: &Replicate) -> Option<Self> {
        let (mut measured_n, mut contact, mut power) = (Vec::new(), Vec::new(), Vec::new());
        for left_out in 0..strokes.len() {
            let others = strokes.iter().enumerate().filter(|(index, _)| *index != left_out);
            let others: Vec<Observation> = others.flat_map(|(_, stroke)| &stroke.observations).copied().collect();
            let fitted = search.run(&others, &best.contact)?;
            for seen in strokes.get(left_out)?.observations.iter().filter(|one| one.voltage_v_rms > 0.0) {
                let coefficient = fitted.contact.friction_coefficient;
                measured_n.push(coefficient * attraction_of(seen, coefficient));
                contact.push(error_n(&fitted.contact, seen)?);
                power.push(error_n(&fitted.power, seen)?);
            }
        }
        let rms = |errors: &[f64]| mean(errors.iter().map(|error| error * error)).sqrt();
        Some(Self {
            mean_n: mean(measured_n.iter().copied()),
            contact_error_n: rms(&contact),
            power_law_error_n: rms(&power),
        })
    }
}

/// Predicted minus measured electric friction, in newtons.
fn error_n(law: &Solution, seen: &Observation) -> Option<f64> {
    let coefficient = law.friction_coefficient;
    let predicted_n = law.attraction.attraction_n(seen.voltage_v_rms, seen.normal_load_n)?;
    Some(coefficient * (predicted_n - attraction_of(seen, coefficient)))
}
