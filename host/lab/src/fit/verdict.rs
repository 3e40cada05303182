//! The verdict of a fit on the model, and the rules for its estimates.

use serde::Serialize;

use super::error::FitError;
use super::intervals::Fitted;
use super::law::{Attraction, Coupling, REFERENCE_V_RMS};
use super::least_squares::{Form, Measured, Observation, Solution, residuals_n, solve};
use super::search::{Replicate, coupling_of};
use super::{DataSummary, Division, Fit, Settings, StrokeResult};
use crate::bootstrap::{Estimate, Z_95, Z_999};
use crate::statistics::mean;

/// Minimum of the data's highest voltage for a verdict on its exponent, in volts rms.
const VERDICT_V_RMS: f64 = 100.0;
/// Tolerance of the voltage exponent above the model's.
///
/// Charge that leaks through the skin makes the voltage sag within a half-period of the carrier, which raises the
/// exponent: without noise, by 0.02 to 0.04 in most people of the simulator and by 0.07 in a moist finger.
const LEAKAGE: f64 = 0.07;
/// Tolerance of the voltage exponent below the model's.
///
/// The carrier's ripple raises the model's exponent by 0.01 from a steady voltage to a square wave of 1 kHz, and data
/// seldom state their carrier. Twice that, since edges and frequencies differ.
const RIPPLE: f64 = 0.02;
/// Difference of exponents up to which a doubted model is still fitted: [`LEAKAGE`] and a margin.
const ALLOWANCE: f64 = 0.1;
/// Largest half-interval of the load exponent for which it is judged.
const LOAD_EXPONENT_WIDTH: f64 = 0.5;
/// Smallest standard deviation of loads for a verdict on the load exponent, as a fraction of their mean.
///
/// It is that of strokes at 94, 100 and 106 % of a load. A person who holds one load varies by 2 to 4 %; over so short
/// a range, one outlier decides.
const LOAD_SPREAD_MIN: f64 = 0.05;
/// Largest half-interval, as a fraction of friction with the drive off. As a fraction of electric friction, the limit
/// would refuse data whose noise makes electric friction small, and so bias the rest.
const INTERVAL_SHARE: f64 = 0.2;
/// Largest change from the first to the last third, as a part of the mean.
const DRIFT_SHARE: f64 = 0.15;
/// Step of the logarithm of the coupling, for derivatives.
const STEP: f64 = 0.01;

/// Verdict of an exponent on the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The data are inconclusive.
    #[default]
    None,
    /// Consistent with the model, within the 95 % interval and, for the voltage, the effect of charge leakage.
    Kept,
    /// It lies outside, but within the 99.9 % interval and its allowance.
    Doubted,
}

/// A measured exponent beside the model's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// Exponent of a power law that is fitted to the same data.
    pub measured: Estimate,
    /// Exponent of a power law that is fitted to the model's predictions for these data.
    pub model: f64,
    /// Verdict on the difference.
    pub verdict: Verdict,
}

/// Judges the model by exponents that are measured without it.
pub(super) struct Judge<'f> {
    pub(super) fitted: &'f Fitted,
    pub(super) observations: &'f [Observation],
}

/// `d ln attraction/d ln F_N` of a law at 150 V under a load.
pub(super) fn load_exponent_of(solution: &Solution, normal_load_n: f64) -> Option<f64> {
    let at = |load_n| solution.attraction.attraction_n(REFERENCE_V_RMS, load_n).map(libm::log);
    Some((at(normal_load_n * (1.0 + STEP))? - at(normal_load_n * (1.0 - STEP))?) / (2.0 * STEP))
}

impl Judge<'_> {
    /// The exponent of the voltage. Fails if the model's lies outside of the 99.9 % interval.
    pub(super) fn voltage(&self, reference_load_n: f64, max_v_rms: f64) -> Result<Exponent, FitError> {
        let load_exponent =
            load_exponent_of(&self.fitted.best.contact, reference_load_n).ok_or(FitError::NotConverged)?;
        let form = Form::Power { load_exponent, reference_load_n };
        let voltage_exponent = |solution: &Solution| solution.attraction.voltage_exponent();
        let of = |replicate: &Replicate| voltage_exponent(&replicate.power);
        let exponent = self.exponent(form, [RIPPLE, LEAKAGE], &of, &voltage_exponent).ok_or(FitError::NotConverged)?;
        if max_v_rms < VERDICT_V_RMS {
            return Ok(Exponent { verdict: Verdict::None, ..exponent.0 });
        }
        refused("voltage", exponent)
    }

    /// The exponent of the load. Fails if the model's lies outside of the 99.9 % interval.
    pub(super) fn load(&self, reference_load_n: f64) -> Result<Exponent, FitError> {
        let form = Form::PowerOfLoad { reference_load_n };
        let load_exponent = |solution: &Solution| match solution.attraction {
            Attraction::Power { load_exponent, .. } => Some(load_exponent),
            Attraction::Contact(..) => None,
        };
        let of = |replicate: &Replicate| replicate.power_of_load.as_ref().and_then(load_exponent);
        let unknown = || {
            let measured = Estimate { value: f64::NAN, low: f64::NEG_INFINITY, high: f64::INFINITY };
            Exponent { measured, model: f64::NAN, verdict: Verdict::None }
        };
        match self.exponent(form, [0.0; 2], &of, &load_exponent) {
            Some((exponent, _)) if !self.loads_can_tell() || !is_narrow(&exponent.measured) => {
                Ok(Exponent { verdict: Verdict::None, ..exponent })
            }
            Some(exponent) => refused("load", exponent),
            None => Ok(unknown()),
        }
    }

    /// Whether the loads of the strokes differ enough for their exponent.
    fn loads_can_tell(&self) -> bool {
        let loads = || self.observations.iter().filter(|one| one.voltage_v_rms > 0.0).map(|one| one.normal_load_n);
        let mean_n = mean(loads());
        let variance = mean(loads().map(|load_n| (load_n - mean_n) * (load_n - mean_n)));
        variance.sqrt() >= LOAD_SPREAD_MIN * mean_n
    }

    /// An exponent of the data and of the model, and half the width of the 99.9 % interval of their difference. An
    /// exponent that is less than the model's by up to `below`, or more by up to `above`, is not doubted.
    fn exponent(
        &self,
        form: Form,
        [below, above]: [f64; 2],
        of_replicate: &dyn Fn(&Replicate) -> Option<f64>,
        of_solution: &dyn Fn(&Solution) -> Option<f64>,
    ) -> Option<(Exponent, f64)> {
        let value = of_replicate(&self.fitted.best)?;
        // The model's exponent for these data, as a function of the coupling.
        let modelled = |factor: f64| -> Option<f64> {
            let coupling = Coupling(coupling_of(&self.fitted.best.contact)? * factor);
            let Attraction::Contact(_, ripple) = self.fitted.best.contact.attraction else { return None };
            let solution = Solution { attraction: Attraction::Contact(coupling, ripple), ..self.fitted.best.contact };
            let start = match form {
                Form::Contact(_) => return None,
                Form::Power { .. } => &self.fitted.best.power,
                Form::PowerOfLoad { .. } => self.fitted.best.power_of_load.as_ref()?,
            };
            of_solution(&solve(form, &exact(self.observations, &solution)?, start)?)
        };
        let model = modelled(1.0)?;
        let slope = (modelled(1.0 + STEP)? - modelled(1.0 - STEP)?) / (2.0 * STEP);
        let best_coupling = coupling_of(&self.fitted.best.contact)?;
        let (mut values, mut differences) = (Vec::new(), Vec::new());
        for replicate in &self.fitted.replicates {
            let (Some(value), Some(coupling)) = (of_replicate(replicate), coupling_of(&replicate.contact)) else {
                continue;
            };
            values.push(value);
            differences.push(value - model - slope * libm::log(coupling / best_coupling));
        }
        let centre = mean(differences.iter().copied());
        let spread = mean(differences.iter().map(|one| (one - centre) * (one - centre))).sqrt();
        let (low, high) = self.fitted.draws.stretched_interval(&mut values, Z_95);
        let measured = Estimate { value, low: low.min(value), high: high.max(value) };
        let room = self.fitted.draws.expanded(Z_95) * spread;
        let is_kept = (-below - room..=above + room).contains(&(value - model));
        let verdict = if is_kept { Verdict::Kept } else { Verdict::Doubted };
        let half_width = self.fitted.draws.expanded(Z_999) * spread;
        spread.is_finite().then_some((Exponent { measured, model, verdict }, half_width))
    }
}

fn is_narrow(measured: &Estimate) -> bool {
    measured.high - measured.low <= 2.0 * LOAD_EXPONENT_WIDTH
}

/// Fails if the model's exponent lies outside of the 99.9 % interval by more than [`ALLOWANCE`].
fn refused(quantity: &'static str, (exponent, half_width): (Exponent, f64)) -> Result<Exponent, FitError> {
    let (value, model) = (exponent.measured.value, exponent.model);
    let room = half_width + ALLOWANCE;
    if (value - model).abs() <= room {
        return Ok(exponent);
    }
    let (low, high) = (value - room, value + room);
    // What bends the measured exponent, which a factor on volts or newtons does not; and what to do if nothing does.
    let cure = if quantity == "load" {
        "that friction does not leak into the sensor's normal force, nor the load into its friction"
    } else {
        "that the amplifier reaches the highest voltage with the electrode connected, and that the force sensor is \
         linear; if so, `frixel finger fit DATA.csv --law empirical` fits a power law of the voltage in the model's \
         place"
    };
    Err(FitError::Refused(format!(
        "electric friction grows as {quantity} to the power {value:.2} ({low:.2} to {high:.2}, the 99.9 % interval and \
         0.1 more on either side), and the model predicts {model:.2}: the contact model does not hold for these data, \
         so no profile is fitted; check {cure}; see docs/inside/evidence.md"
    )))
}

/// The observations that a law predicts.
fn exact(observations: &[Observation], solution: &Solution) -> Option<Vec<Observation>> {
    let residuals = residuals_n(solution, 1.0, observations)?;
    let exact = observations.iter().zip(residuals).map(|(one, residual)| {
        let measured = match one.measured {
            Measured::Friction(friction_n) => Measured::Friction(friction_n - residual),
            Measured::Attraction(attraction_n) => Measured::Attraction(attraction_n - residual),
        };
        Observation { measured, ..*one }
    });
    Some(exact.collect())
}

/// Fails if estimates are too uncertain, or if the finger changed while it was measured.
pub(super) fn check_estimates(
    data: &DataSummary,
    strokes: &[StrokeResult],
    friction_coefficient: &Estimate,
    electric_friction_n: &Estimate,
) -> Result<(), FitError> {
    let third = strokes.len() / 3;
    let first = strokes.get(..third).unwrap_or_default();
    let last = strokes.get(strokes.len() - third..).unwrap_or_default();
    let natural = |stroke: &StrokeResult| stroke.natural_coefficient.map(|coefficient| (coefficient, 1.0));
    let electric = |stroke: &StrokeResult| {
        let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
            stroke.points.iter().map(|point| of(point.measured_n, point.measured_n - point.residual_n)).sum()
        };
        let squares = sum(&|_, fitted| fitted * fitted);
        (squares > 0.0).then(|| (sum(&|measured, fitted| measured * fitted) / squares, squares))
    };
    let natural = [weighted_mean(first, natural), weighted_mean(last, natural)];
    let electric = [weighted_mean(first, electric), weighted_mean(last, electric)];
    // Rows of means do not stand in the order of time.
    if data.division != Division::Means {
        check_drift("friction coefficient", natural, 1.0)?;
        check_drift("electric friction in newtons", electric, electric_friction_n.value)?;
    }
    let natural_n = friction_coefficient.value * data.normal_load_n;
    for (quantity, estimate, natural) in [
        ("friction coefficient", friction_coefficient, friction_coefficient.value),
        ("electric friction in newtons", electric_friction_n, natural_n),
    ] {
        let Estimate { value, low, high } = *estimate;
        let room = (high - value).max(value - low);
        // An estimate that is no larger than its error is none.
        if room > INTERVAL_SHARE * natural || room >= value {
            let advice = match data.division {
                Division::Means => "give means of more values",
                Division::Column | Division::Motion | Division::Blocks => "record more strokes, more evenly",
            };
            let width = if high - value < value && value - low < value {
                format!("wider than +-20 % of the {natural:.4} without the drive")
            } else {
                "wider than the value itself, as where the drive adds next to nothing or friction was smoothed"
                    .to_owned()
            };
            return Err(FitError::Refused(format!(
                "the 95 % interval of the {quantity} is {low:.4} to {high:.4} around {value:.4}, {width}: {advice}"
            )));
        }
    }
    Ok(())
}

/// Fails if the gap of a fit is inside the coating.
pub(super) fn check_gap(fit: &Fit, settings: &Settings) -> Result<(), FitError> {
    if fit.skin_gap_m <= 0.0 {
        let (gap_um, coating_um) = (1e6 * fit.gap_m, 1e6 * settings.coating_gap_m);
        return Err(FitError::Refused(format!(
            "the measured attraction needs an effective gap of {gap_um:.3} um, and the coating alone has \
             {coating_um:.3} um: check the coating, and that the voltages are those at the electrode, not ahead of the \
             amplifier"
        )));
    }
    Ok(())
}

/// Weighted mean over strokes and its standard error.
fn weighted_mean(strokes: &[StrokeResult], of: impl Fn(&StrokeResult) -> Option<(f64, f64)>) -> Option<(f64, f64)> {
    let pairs: Vec<_> = strokes.iter().filter_map(of).collect();
    let total: f64 = pairs.iter().map(|(_, weight)| weight).sum();
    let centre = pairs.iter().map(|(value, weight)| value * weight).sum::<f64>() / total;
    let count = pairs.len() as f64;
    let square: f64 = pairs.iter().map(|(value, weight)| (weight * (value - centre)).powi(2)).sum();
    (count >= 2.0).then(|| (centre, (square * count / (count - 1.0)).sqrt() / total))
}

/// Fails if two means differ by more than 15 % and by more than their noise explains.
fn check_drift(quantity: &'static str, thirds: [Option<(f64, f64)>; 2], scale: f64) -> Result<(), FitError> {
    let [Some((first, first_error)), Some((last, last_error))] = thirds else { return Ok(()) };
    let change = (last - first).abs();
    if change > DRIFT_SHARE * 0.5 * (first + last) && change > Z_999 * libm::hypot(first_error, last_error) {
        return Err(FitError::Refused(format!(
            "the {quantity} was {:.4} in the first third and {:.4} in the last: the finger changed while it was \
             measured; rest for a minute, wipe finger and screen, and record again",
            scale * first,
            scale * last
        )));
    }
    Ok(())
}
