//! A power law of the voltage, for fingers that the contact model does not describe.

use std::fmt::Write;

use frixel_scene::{Elasticity, Evidence, Experiment, FingerProfile, MeasuredLaw};

use super::contrast::LEVEL_WIDTH;
use super::error::FitError;
use super::least_squares::Solution;
use super::profile::rounded;
use super::{Data, Division, FittedData, HeldOut, Settings, StrokeResult, results, verdict};
use crate::bootstrap::{Estimate, Z_999};
use crate::statistics::{mean, student_quantile};

/// Least number of strokes at a voltage that tell whether a power law holds there.
const STROKES_MIN: usize = 3;
/// Difference from a power law that is allowed, as a part of electric friction: that of the contact model at the
/// friction of the example finger.
const LAW_SHARE: f64 = 0.05;
/// Powers that a profile may have (`docs/scene.md`, "Empirical fingers").
const EXPONENTS: core::ops::RangeInclusive<f64> = 0.5..=12.0;

/// A finger whose electric friction is `electric_friction_n (V/voltage_max_v_rms)^voltage_exponent`.
#[derive(Clone, Debug, PartialEq)]
pub struct EmpiricalFit {
    /// Friction over load with the drive off.
    pub friction_coefficient: Estimate,
    /// Exponent of the voltage.
    pub voltage_exponent: Estimate,
    /// Highest voltage of the data, in volts rms; the law ends there.
    pub voltage_max_v_rms: f64,
    /// What that voltage adds to the friction, in newtons.
    pub electric_friction_n: Estimate,
    /// Normal load at which this holds, in newtons.
    pub normal_load_n: f64,
    /// Errors in strokes that a fit has not seen; `None` for means, and if a fit without one stroke does not converge.
    pub held_out: Option<HeldOut>,
    /// Number of strokes, or of means.
    pub strokes: usize,
    /// How rows were divided into strokes.
    pub division: Division,
}

/// Fits a power law of the voltage to a recording or to means, whatever the contact model says about them. Fails if
/// electric friction follows no power law either.
pub fn fit_power_law(data: Data, settings: &Settings) -> Result<EmpiricalFit, FitError> {
    let data = FittedData::of(data, settings)?;
    let voltage_max_v_rms = data.voltage_range_v_rms.1;
    let electric_friction_n = |solution: &Solution| {
        let attraction_n = solution.attraction.attraction_n(voltage_max_v_rms, data.normal_load_n)?;
        Some(solution.friction_coefficient * attraction_n)
    };
    let fit = EmpiricalFit {
        friction_coefficient: data.friction_coefficient(|replicate| &replicate.power)?,
        voltage_exponent: data.fitted.estimate(|replicate| replicate.power.attraction.voltage_exponent())?,
        voltage_max_v_rms,
        electric_friction_n: data.fitted.estimate(|replicate| electric_friction_n(&replicate.power))?,
        normal_load_n: data.normal_load_n,
        held_out: data.held_out,
        strokes: data.strokes.len(),
        division: data.division,
    };
    let exponent = fit.voltage_exponent.value;
    if !EXPONENTS.contains(&exponent) {
        return Err(FitError::ExponentOutOfRange { exponent });
    }
    let strokes = results(&data.strokes, &data.fitted.best.power).ok_or(FitError::NotConverged)?;
    // What the strokes of the highest voltage say without the law.
    let beside_n = check_law(&strokes)?;
    let Estimate { value, low, high } = fit.electric_friction_n;
    let electric_friction_n = Estimate { value, low: low.min(value + beside_n), high: high.max(value + beside_n) };
    verdict::check_estimates(fit.division, &strokes, &fit.friction_coefficient, &electric_friction_n)?;
    Ok(EmpiricalFit { electric_friction_n, ..fit })
}

/// Fails if the means of the strokes at a voltage lie beside the law by more than their 99.9 % interval and 5 %. Returns
/// how far those of the highest voltage lie beside it, in newtons; 0 if they are too few to tell.
fn check_law(strokes: &[StrokeResult]) -> Result<f64, FitError> {
    let mut beside_n = 0.0;
    let mut points: Vec<_> = strokes.iter().flat_map(|stroke| &stroke.points).collect();
    points.sort_by(|one, other| one.voltage_v_rms.total_cmp(&other.voltage_v_rms));
    for level in points.chunk_by(|one, next| next.voltage_v_rms <= LEVEL_WIDTH * one.voltage_v_rms) {
        beside_n = 0.0;
        if level.len() < STROKES_MIN {
            continue;
        }
        let count = level.len() as f64;
        let over = |value: &dyn Fn(usize) -> f64| mean((0..level.len()).map(value));
        let at = |index: usize| level.get(index).map_or((f64::NAN, f64::NAN), |one| (one.measured_n, one.residual_n));
        let (measured_n, residual_n) = (over(&|index| at(index).0), over(&|index| at(index).1));
        let square = over(&|index| (at(index).1 - residual_n).powi(2));
        let error_n = student_quantile(Z_999, count - 1.0) * (square / (count - 1.0)).sqrt();
        let law_n = measured_n - residual_n;
        if residual_n.abs() > error_n + LAW_SHARE * law_n.abs() {
            let voltage_v_rms = level.first().map_or(f64::NAN, |one| one.voltage_v_rms);
            return Err(FitError::NoPowerLaw {
                voltage_v_rms,
                measured_mn: 1e3 * measured_n,
                law_mn: 1e3 * law_n,
                error_mn: 1e3 * error_n,
            });
        }
        beside_n = residual_n;
    }
    Ok(beside_n)
}

impl EmpiricalFit {
    /// The profile of this finger: one point, and the exponent below it.
    pub fn profile(&self, experiment: Experiment) -> FingerProfile {
        let Estimate { value, low, high } = self.electric_friction_n;
        FingerProfile {
            friction_coefficient: rounded(self.friction_coefficient.value),
            normal_load_n: rounded(self.normal_load_n),
            radius_mm: 0.0,
            elasticity: Elasticity::Empirical(MeasuredLaw {
                exponent: rounded(self.voltage_exponent.value),
                points: vec![(rounded(self.voltage_max_v_rms), rounded(value))],
                intervals_n: vec![(rounded(low), rounded(high))],
            }),
            skin_gap_um: 0.0,
            evidence: Evidence::Empirical { experiment },
        }
    }

    /// The fit in words, a line each.
    pub fn words(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {name:<22} {value}");
        };
        let interval = |Estimate { value, low, high }: Estimate, scale: f64, digits: usize| {
            let [value, low, high] = [value, low, high].map(|number| scale * number);
            format!("{value:.digits$} (95 % interval {low:.digits$} to {high:.digits$})")
        };
        let (voltage, load_n) = (self.voltage_max_v_rms, self.normal_load_n);
        line("law", "empirical: a power of the voltage, without the contact model".to_owned());
        line("friction coefficient", interval(self.friction_coefficient, 1.0, 3));
        let electric = interval(self.electric_friction_n, 1e3, 1).replacen(" (", " mN (", 1);
        line("electric friction", format!("{electric} at {voltage:.0} V rms under {load_n:.2} N"));
        line("exponent of the voltage", interval(self.voltage_exponent, 1.0, 2));
        if let Some(held_out) = &self.held_out {
            line("strokes left out", held_out.words(held_out.power_law_error_n));
        }
        let what = if self.division == Division::Means { "means with their errors" } else { "strokes" };
        line("data", format!("{} {what}", self.strokes));
        let notes = [
            "the law holds for this screen and this load, and up to this voltage: above it, scenes are refused",
            "below the lowest voltage of the data, nobody measured that friction goes on by the same power",
        ];
        for note in notes {
            let _ = writeln!(text, "  note: {note}");
        }
        text
    }

    /// The fit for programs.
    pub fn json(&self) -> serde_json::Value {
        let interval = |estimate: Estimate| [estimate.low, estimate.high];
        serde_json::json!({
            "law": "empirical",
            "friction_coefficient": self.friction_coefficient.value,
            "friction_coefficient_interval": interval(self.friction_coefficient),
            "voltage_exponent": self.voltage_exponent.value,
            "voltage_exponent_interval": interval(self.voltage_exponent),
            "voltage_max_v_rms": self.voltage_max_v_rms,
            "electric_friction_n": self.electric_friction_n.value,
            "electric_friction_interval_n": interval(self.electric_friction_n),
            "normal_load_n": self.normal_load_n,
            "held_out_error_n": self.held_out.map(|held_out| held_out.power_law_error_n),
            "strokes": self.strokes,
        })
    }
}
