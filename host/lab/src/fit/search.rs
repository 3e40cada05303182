//! Search for the laws that fit the observations best.

use frixel_model::Ripple;
use frixel_play::GoesOn;

use super::contrast::StrokeMeans;
use super::error::FitError;
use super::law::{Attraction, Coupling, REFERENCE_V_RMS};
use super::least_squares::{Form, Measured, Observation, Solution, solve};
use super::verdict;
use crate::statistics::median;

/// The laws fitted to the same observations: the contact model, and power laws without a model.
pub(super) struct Replicate {
    pub(super) contact: Solution,
    pub(super) power: Solution,
    pub(super) power_of_load: Option<Solution>,
}

/// A search for the laws that fit observations best.
pub(super) struct Search<'s> {
    /// Operating point at which the profile gives friction.
    pub(super) voltage_v_rms: f64,
    pub(super) normal_load_n: f64,
    /// Ripple of the carrier of the measurement.
    pub(super) ripple: Ripple,
    pub(super) start: &'s Solution,
    pub(super) goes_on: GoesOn<'s>,
}

impl Search<'_> {
    /// Fits the contact model and the power laws to observations; `None` if they do not converge, or if `goes_on`
    /// breaks.
    pub(super) fn run(&self, observations: &[Observation], near: &Solution) -> Option<Replicate> {
        if (self.goes_on)().is_break() {
            return None;
        }
        let weighted: Vec<_> = observations.iter().map(|observation| self.weighted(observation)).collect();
        let form = Form::Contact(self.ripple);
        let contact = solve(form, &weighted, near).or_else(|| solve(form, &weighted, self.start))?;
        let reference_load_n = self.normal_load_n;
        let load_exponent = verdict::load_exponent_of(&contact, reference_load_n)?;
        let power = Solution {
            friction_coefficient: contact.friction_coefficient,
            attraction: Attraction::Power {
                reference_n: contact.attraction.attraction_n(REFERENCE_V_RMS, reference_load_n)?,
                voltage_exponent: 2.0,
                load_exponent,
                reference_load_n,
            },
        };
        let power_of_load = solve(Form::PowerOfLoad { reference_load_n }, observations, &power);
        let power = solve(Form::Power { load_exponent, reference_load_n }, observations, &power)?;
        Some(Replicate { contact, power, power_of_load })
    }

    /// Gives observations more weight the closer they are to the stated voltage. A model that is a little wrong is then
    /// right where friction is stated, at the cost of a tenth more noise.
    fn weighted(&self, observation: &Observation) -> Observation {
        if observation.voltage_v_rms <= 0.0 {
            return *observation;
        }
        let ratio = observation.voltage_v_rms / self.voltage_v_rms;
        let closeness = ratio.min(1.0 / ratio);
        Observation { weight: observation.weight * closeness * closeness, ..*observation }
    }
}

/// Start of the search: the median friction coefficient, and the coupling at the highest voltages.
pub(super) fn start(
    strokes: &[StrokeMeans],
    observations: &[Observation],
    ripple: Ripple,
) -> Result<Solution, FitError> {
    let friction_coefficient = median(strokes.iter().filter_map(|stroke| stroke.natural_coefficient));
    let top_v_rms = observations.iter().map(|one| one.voltage_v_rms).fold(0.0, f64::max);
    let top = || observations.iter().filter(|one| one.voltage_v_rms > 0.9 * top_v_rms);
    let attraction_n = median(top().map(|one| attraction_of(one, friction_coefficient)));
    if !(attraction_n > 0.0) {
        return Err(no_electric_friction(friction_coefficient * attraction_n));
    }
    let load_n = median(top().map(|one| one.normal_load_n));
    let coupling = Coupling::of_attraction(attraction_n, top_v_rms, load_n);
    Ok(Solution { friction_coefficient, attraction: Attraction::Contact(coupling, ripple) })
}

/// The error for a voltage without electric friction; `found_n` is the electric friction at the highest voltage.
pub(super) fn no_electric_friction(found_n: f64) -> FitError {
    FitError::Refused(format!(
        "the voltage adds no friction ({found_n:.2e} N at the highest one): check that the electrode is driven, that \
         voltage and friction belong to the same time, and that friction was not smoothed, which makes it change \
         before its switch"
    ))
}

pub(super) fn attraction_of(observation: &Observation, friction_coefficient: f64) -> f64 {
    match observation.measured {
        Measured::Attraction(attraction_n) => attraction_n,
        Measured::Friction(friction_n) => friction_n / friction_coefficient - observation.normal_load_n,
    }
}

pub(super) fn coupling_of(solution: &Solution) -> Option<f64> {
    match solution.attraction {
        Attraction::Contact(coupling, _) => Some(coupling.0),
        Attraction::Power { .. } => None,
    }
}
