//! An empirical law of the voltage, for fingers that the contact model does not describe: a power of the voltage, or
//! else points.

use std::fmt::Write;

use frixel_play::GoesOn;
use frixel_scene::{Elasticity, Evidence, Experiment, FingerProfile, MeasuredLaw};

use super::error::FitError;
use super::least_squares::Solution;
use super::measured_points::{EXPONENTS, LawOfPoints, MeasuredPoint, levels};
use super::profile::rounded;
use super::{
    Data, DataSummary, Division, FittedData, HeldOut, Point, Settings, StrokeResult, results, sensor, verdict,
};
use crate::bootstrap::{Estimate, GROUP_MIN, Z_999};
use crate::statistics::{mean, mean_and_error, student_quantile};

/// Largest deviation from a power law, as a fraction of electric friction: that of the contact model at the friction of
/// the example finger.
const LAW_SHARE: f64 = 0.05;

/// A finger with a measured law of the voltage.
#[derive(Clone, Debug, PartialEq)]
pub struct EmpiricalFit {
    /// Friction over load with the drive off.
    pub friction_coefficient: Estimate,
    /// The law up to its highest point.
    pub law: VoltageLaw,
    /// The highest voltage of the data, where the law ends, and its electric friction.
    pub highest: MeasuredPoint,
    /// Prediction of the held-out strokes. `None` for means, and if a fit without one stroke does not converge.
    pub held_out: Option<HeldOutError>,
    /// Number of strokes, or of means.
    pub strokes: usize,
    /// The data, and the load at which this holds.
    pub data: DataSummary,
}

/// Prediction error of electric friction in held-out strokes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldOutError {
    /// Root mean square error, in newtons.
    pub rms_n: f64,
    /// Mean electric friction of the strokes, in newtons.
    pub mean_friction_n: f64,
}

/// How electric friction grows up to the highest voltage of the data.
#[derive(Clone, Debug, PartialEq)]
pub enum VoltageLaw {
    /// As a power of the voltage.
    Power {
        /// The power.
        exponent: Estimate,
    },
    /// By power laws through points.
    Points {
        /// The points below the highest voltage, rising.
        below: Vec<MeasuredPoint>,
        /// Power of the voltage below the first of them.
        exponent: f64,
    },
}

/// Fits a power law of the voltage to a recording or to means, regardless of the contact model; where the strokes of a
/// recording follow none, the law is that of their means at each voltage. Fails if electric friction does not rise with
/// the voltage as a profile can have it, and with [`FitError::Interrupted`] when `goes_on` breaks.
pub fn fit_empirical(data: Data, settings: &Settings, goes_on: GoesOn<'_>) -> Result<EmpiricalFit, FitError> {
    let fitted = FittedData::of(data, settings, goes_on)?;
    let friction_coefficient = fitted.friction_coefficient(|replicate| &replicate.power)?;
    let strokes = results(&fitted.strokes, &fitted.fitted.best.power).ok_or(FitError::NotConverged)?;
    let (law, highest, held_out) = match power_law(&fitted, &strokes) {
        Err(FitError::NoPowerLaw(_)) if fitted.data.division != Division::Means => {
            points(&fitted, &strokes, &friction_coefficient)?
        }
        law => law?,
    };
    let FittedData { data, settling_error, .. } = fitted;
    verdict::check_estimates(&data, &strokes, &friction_coefficient, &highest.electric_friction_n)?;
    sensor::check_settling_error(settling_error)?;
    Ok(EmpiricalFit { friction_coefficient, law, highest, held_out, strokes: strokes.len(), data })
}

type Law = (VoltageLaw, MeasuredPoint, Option<HeldOutError>);

/// The power law of the data. Fails if their means at a voltage deviate from it.
fn power_law(fitted_data: &FittedData, strokes: &[StrokeResult]) -> Result<Law, FitError> {
    let FittedData { fitted, data, .. } = fitted_data;
    let voltage_v_rms = data.voltage_range_v_rms.1;
    let of = |solution: &Solution| {
        let attraction_n = solution.attraction.attraction_n(voltage_v_rms, data.normal_load_n)?;
        Some(solution.friction_coefficient * attraction_n)
    };
    let exponent = fitted.estimate(|replicate| replicate.power.attraction.voltage_exponent())?;
    if !EXPONENTS.contains(&exponent.value) {
        return Err(FitError::Refused(format!(
            "electric friction grows as voltage to the power {:.2}, and a profile allows 0.5 to 12: check for a \
             voltage that was not applied, and for strokes in which the finger stuck",
            exponent.value
        )));
    }
    let Estimate { value, low, high } = fitted.estimate(|replicate| of(&replicate.power))?;
    // What the strokes of the highest voltage say without the law.
    let beside_n = value + check_law(strokes)?;
    let electric_friction_n = Estimate { value, low: low.min(beside_n), high: high.max(beside_n) };
    let held_out = fitted_data.held_out;
    let held_out = held_out.map(|found| HeldOutError { rms_n: found.power_law_error_n, mean_friction_n: found.mean_n });
    Ok((VoltageLaw::Power { exponent }, MeasuredPoint { voltage_v_rms, electric_friction_n }, held_out))
}

/// The law of the means at each voltage.
fn points(fitted: &FittedData, strokes: &[StrokeResult], friction_coefficient: &Estimate) -> Result<Law, FitError> {
    let Estimate { value, low, high } = *friction_coefficient;
    let attraction = &fitted.fitted.best.power.attraction;
    let law = LawOfPoints::of(strokes, attraction, fitted.data.normal_load_n, (high - low) / (2.0 * value))?;
    let LawOfPoints { points: mut below, exponent, held_out_error_n } = law;
    let highest = below.pop().ok_or(FitError::NotConverged)?;
    let measured_n = strokes.iter().flat_map(|stroke| &stroke.points).map(|point| point.measured_n);
    let held_out = HeldOutError { rms_n: held_out_error_n, mean_friction_n: mean(measured_n) };
    Ok((VoltageLaw::Points { below, exponent }, highest, Some(held_out)))
}

/// Fails if the means of the strokes at a voltage deviate from the law by more than their 99.9 % interval and 5 %.
/// Returns the deviation at the highest voltage, in newtons; 0 if there are too few strokes.
fn check_law(strokes: &[StrokeResult]) -> Result<f64, FitError> {
    let mut beside_n = 0.0;
    for level in levels(strokes) {
        beside_n = 0.0;
        if level.len() < GROUP_MIN {
            continue;
        }
        let over = |value: fn(&Point) -> f64| level.iter().map(value).collect::<Vec<_>>();
        let (residual_n, error_n) = mean_and_error(&over(|point| point.residual_n));
        let measured_n = mean(over(|point| point.measured_n).into_iter());
        let error_n = student_quantile(Z_999, level.len() as f64 - 1.0) * error_n;
        let law_n = measured_n - residual_n;
        if residual_n.abs() > error_n + LAW_SHARE * law_n.abs() {
            let voltage_v_rms = level.first().map_or(f64::NAN, |one| one.voltage_v_rms);
            let [measured_mn, law_mn, error_mn] = [measured_n, law_n, error_n].map(|newtons| 1e3 * newtons);
            return Err(FitError::NoPowerLaw(format!(
                "at {voltage_v_rms:.0} V rms electric friction was {measured_mn:.1} mN, but the best-fitting power law \
                 predicts {law_mn:.1} mN, further off than the noise of these strokes explains ({error_mn:.1} mN): \
                 write the points that you measured into a profile (docs/design/scenes.md, \"Empirical fingers\")"
            )));
        }
        beside_n = residual_n;
    }
    Ok(beside_n)
}

impl EmpiricalFit {
    /// The points below the highest, and the power of the voltage below the lowest.
    fn below(&self) -> (&[MeasuredPoint], f64) {
        match &self.law {
            VoltageLaw::Power { exponent } => (&[], exponent.value),
            VoltageLaw::Points { below, exponent } => (below, *exponent),
        }
    }

    /// All points, rising.
    pub(super) fn points(&self) -> impl Iterator<Item = &MeasuredPoint> {
        self.below().0.iter().chain([&self.highest])
    }

    /// The profile of this finger.
    pub fn profile(&self, experiment: Experiment) -> FingerProfile {
        let point = |point: &MeasuredPoint| (rounded(point.voltage_v_rms), rounded(point.electric_friction_n.value));
        let interval_n = |point: &MeasuredPoint| {
            let Estimate { low, high, .. } = point.electric_friction_n;
            (rounded(low), rounded(high))
        };
        FingerProfile {
            friction_coefficient: rounded(self.friction_coefficient.value),
            normal_load_n: rounded(self.data.normal_load_n),
            radius_mm: 0.0,
            elasticity: Elasticity::Empirical(MeasuredLaw {
                exponent: rounded(self.below().1),
                points: self.points().map(point).collect(),
                intervals_n: self.points().map(interval_n).collect(),
            }),
            skin_gap_um: 0.0,
            evidence: Evidence::Empirical { experiment },
        }
    }

    /// The fit as text, one line per item.
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
        let law = match self.law {
            VoltageLaw::Power { .. } => "a power of the voltage, without the contact model",
            VoltageLaw::Points { .. } => "points that power laws join, since no power of the voltage fits them all",
        };
        line("law", format!("empirical: {law}"));
        line("friction coefficient", interval(self.friction_coefficient, 1.0, 3));
        for MeasuredPoint { voltage_v_rms, electric_friction_n } in self.points() {
            let electric = interval(*electric_friction_n, 1e3, 1).replacen(" (", " mN (", 1);
            let load_n = self.data.normal_load_n;
            line("electric friction", format!("{electric} at {voltage_v_rms:.0} V rms under {load_n:.2} N"));
        }
        if let VoltageLaw::Power { exponent } = self.law {
            line("exponent of the voltage", interval(exponent, 1.0, 2));
        }
        if let Some(HeldOutError { rms_n, mean_friction_n }) = self.held_out {
            line("strokes left out", HeldOut::words(rms_n, mean_friction_n));
        }
        let what = if self.data.division == Division::Means { "means with their errors" } else { "strokes" };
        line("data", format!("{} {what}", self.strokes));
        let below = match self.law {
            VoltageLaw::Power { .. } => "the power law was not measured there".to_owned(),
            VoltageLaw::Points { exponent, .. } => {
                format!("friction is taken to grow as voltage to the power {exponent:.1}")
            }
        };
        let notes = [
            "the law holds for this screen and this load, and up to this voltage: above it, scenes are refused"
                .to_owned(),
            format!("below the lowest voltage of the data, {below}"),
        ];
        for note in notes.into_iter().chain(self.data.preparation.notes(self.data.division)) {
            let _ = writeln!(text, "  note: {note}");
        }
        text
    }
}
