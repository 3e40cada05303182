//! A law of points, for fingers whose electric friction follows no power of the voltage.

use super::contrast::LEVEL_WIDTH;
use super::error::FitError;
use super::law::Attraction;
use super::search::no_electric_friction;
use super::{Point, StrokeResult, rules};
use crate::bootstrap::{Estimate, Z_95};
use crate::statistics::{mean, mean_and_error, student_quantile};

/// Most points of a profile (`docs/design/scenes.md`, "Empirical fingers").
const POINTS_MAX: usize = 16;
/// Powers of the voltage that a profile may have, below its first point and from one to the next.
pub(super) const EXPONENTS: core::ops::RangeInclusive<f64> = 0.5..=12.0;
/// Power of the voltage with which any attraction of charges begins.
const EXPONENT_BELOW: f64 = 2.0;

/// Electric friction at one voltage, without a law between voltages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPoint {
    /// Voltage, in volts rms.
    pub voltage_v_rms: f64,
    /// Electric friction at that voltage, in newtons.
    pub electric_friction_n: Estimate,
}

/// The law that measured points give.
pub(super) struct LawOfPoints {
    /// The points that a profile has; friction rises from each to the next.
    pub(super) points: Vec<MeasuredPoint>,
    /// Power of the voltage below the first of them.
    pub(super) exponent: f64,
    /// Root mean square error in strokes, predicted from the others at their voltage, in newtons.
    pub(super) held_out_error_n: f64,
}

/// The points of all strokes at each voltage, rising.
pub(super) fn levels(strokes: &[StrokeResult]) -> Vec<Vec<Point>> {
    let mut points: Vec<Point> = strokes.iter().flat_map(|stroke| &stroke.points).copied().collect();
    points.sort_by(|one, other| one.voltage_v_rms.total_cmp(&other.voltage_v_rms));
    let mut levels: Vec<Vec<Point>> = Vec::new();
    for point in points {
        let lowest_v_rms = levels.last().and_then(|level| level.first()).map(|first| first.voltage_v_rms);
        match (lowest_v_rms, levels.last_mut()) {
            (Some(lowest_v_rms), Some(level)) if point.voltage_v_rms <= LEVEL_WIDTH * lowest_v_rms => level.push(point),
            _ => levels.push(vec![point]),
        }
    }
    levels
}

impl LawOfPoints {
    /// The law of the strokes at each voltage. Within a level, `attraction` moves what was measured to the mean voltage
    /// and to `normal_load_n`. `coefficient_share` is half the interval of the friction coefficient as a part of it:
    /// all strokes have it in common. Fails if friction does not rise as a profile can have it.
    pub(super) fn of(
        strokes: &[StrokeResult],
        attraction: &Attraction,
        normal_load_n: f64,
        coefficient_share: f64,
    ) -> Result<Self, FitError> {
        let levels = levels(strokes);
        if levels.len() > POINTS_MAX {
            return Err(FitError::Refused(format!(
                "electric friction follows no power of the voltage, and was measured at {} voltages, more than the \
                 {POINTS_MAX} points of a profile: leave strokes of some voltages out with --without",
                levels.len()
            )));
        }
        let (mut points, mut errors_n) = (Vec::new(), Vec::new());
        for level in &levels {
            let voltage_v_rms = mean(level.iter().map(|point| point.voltage_v_rms));
            let found = level.len();
            rules::check_at_voltage(found, voltage_v_rms)?;
            let here_n = attraction.attraction_n(voltage_v_rms, normal_load_n).ok_or(FitError::NotConverged)?;
            let moved = |point: &Point| {
                Some(point.measured_n * here_n / attraction.attraction_n(point.voltage_v_rms, point.normal_load_n)?)
            };
            let values: Vec<f64> = level.iter().map(moved).collect::<Option<_>>().ok_or(FitError::NotConverged)?;
            let (value, error_n) = mean_and_error(&values);
            let count = found as f64;
            // The mean of the others is further from a stroke than that of all.
            errors_n.extend(values.iter().map(|one| (one - value) * count / (count - 1.0)));
            let half_n = libm::hypot(student_quantile(Z_95, count - 1.0) * error_n, coefficient_share * value);
            let electric_friction_n = Estimate { value, low: value - half_n, high: value + half_n };
            points.push(MeasuredPoint { voltage_v_rms, electric_friction_n });
        }
        let (points, exponent) = rising(&points)?;
        let held_out_error_n = mean(errors_n.iter().map(|error_n| error_n * error_n)).sqrt();
        Ok(Self { points, exponent, held_out_error_n })
    }
}

/// The points from the first one on that is above zero for sure, and the power of the voltage below it. Fails if
/// friction from one to the next has no power that a profile can have.
fn rising(points: &[MeasuredPoint]) -> Result<(Vec<MeasuredPoint>, f64), FitError> {
    let first = points.iter().position(|point| point.electric_friction_n.low > 0.0).unwrap_or(points.len());
    let (small, points) = points.split_at(first);
    let Some(lowest) = points.first() else { return Err(no_electric_friction(0.0)) };
    let power = |(from_v_rms, from_n): (f64, f64), to: &MeasuredPoint| {
        libm::log(to.electric_friction_n.value / from_n) / libm::log(to.voltage_v_rms / from_v_rms)
    };
    for (from, to) in points.iter().zip(points.iter().skip(1)) {
        let exponent = power((from.voltage_v_rms, from.electric_friction_n.value), to);
        if !EXPONENTS.contains(&exponent) {
            let (low_v_rms, high_v_rms) = (from.voltage_v_rms, to.voltage_v_rms);
            let cure = if exponent > *EXPONENTS.end() {
                "record strokes at voltages between them"
            } else {
                "check that the amplifier reaches the higher one; if it does, this finger is played up to the lower one: \
                 leave the strokes above that out with --without"
            };
            return Err(FitError::Refused(format!(
                "electric friction follows no power of the voltage, and from {low_v_rms:.0} to {high_v_rms:.0} V rms \
                 it grows as voltage to the power {exponent:.2}, and a profile allows 0.5 to 12: {cure}"
            )));
        }
    }
    // What was too small to measure was at most its upper end. The steepest power leaves 2 % of the lowest point at 0.7
    // of its voltage, which no finger feels.
    let least = small.iter().map(|point| power((point.voltage_v_rms, point.electric_friction_n.high), lowest));
    let exponent = least.fold(EXPONENT_BELOW, f64::max).min(*EXPONENTS.end());
    Ok((points.to_vec(), exponent))
}
