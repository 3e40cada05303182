//! Rules that data must satisfy before they are fitted.

use super::Settings;
use super::contrast::{Levels, Phases, StrokeMeans};
use super::defects::{Defects, StrokeDefect};
use super::error::{FitError, plain};
use super::least_squares::{Measured, Solution};
use super::recording::{Recording, Stroke};
use super::sensor::ROWS_HZ_MIN;
use super::table::Row;
use crate::bootstrap::GROUP_MIN;
use crate::statistics::{mean, median};

/// Least number of strokes: intervals from fewer are too wide to be of use.
const STROKES_MIN: usize = 8;
/// Loads of a finger on a touchscreen, in newtons: 0.1 to 1 N are usual; the margin is a factor of three.
const LOADS_N: core::ops::RangeInclusive<f64> = 0.03..=3.0;
/// Friction coefficients of skin on glass: 0.1 to 3 are published, rising as the load falls (Dzidek 2017); with margin.
const COEFFICIENTS: core::ops::RangeInclusive<f64> = 0.05..=5.0;
/// Tolerance of a stroke's load around the median, as a fraction of it: the rule of a published rig.
const LOAD_TOLERANCE: f64 = 0.15;
/// Fraction of the highest voltage above which voltages are near it.
const NEAR_TOP: f64 = 0.8;
/// Least ratio of the highest to the lowest voltage from which an exponent can be told.
const VOLTAGE_RATIO_MIN: f64 = 1.15;
/// Largest plausible force of a finger on a touchscreen, in newtons. A larger one is in another unit.
pub(crate) const FORCE_MAX_N: f64 = 50.0;
/// Smallest mean time for which a voltage rests, in seconds: `frixel finger calibrate` switches every 20 to 30 ms, and
/// the samples of a carrier of 60 Hz change by a fifth of the peak every 2 ms.
const REST_MIN_S: f64 = 8e-3;
/// The same in rows, where there are no times.
const REST_MIN_ROWS: f64 = 2.0;
/// Factor by which a voltage or load may exceed the data and still count as measured.
const EXTRAPOLATION: f64 = 1.05;
/// Fraction of the median friction below which a stroke did not slip all the way.
const SLIP_SHARE: f64 = 0.5;
/// Fraction of the usual electric friction at its voltage below which a stroke did not slip: the drive acts in full
/// slip only (Sirin, arXiv 2104.01090).
const RESPONSE_SHARE: f64 = 0.25;
/// Minimum of the data's highest voltage, in volts rms. Below it, no effect can be measured: the example finger has 5
/// uN at 1 V.
const VOLTAGE_MIN_V_RMS: f64 = 1.0;

/// Checks that there are rows, and that their loads are newtons.
pub(super) fn check_units(rows: &[Row]) -> Result<(), FitError> {
    if rows.is_empty() {
        return Err(too_few_strokes(0));
    }
    check_load_unit(rows.iter().map(|row| row.normal_force_n))
}

/// Checks that loads are newtons.
pub(super) fn check_load_unit(loads_n: impl Iterator<Item = f64> + Clone) -> Result<(), FitError> {
    if loads_n.clone().all(|load_n| load_n.abs() < 1e-9) {
        return Err(FitError::Refused(
            "column normal_force_n is zero throughout: record the normal force with a load cell".to_owned(),
        ));
    }
    let median = median(loads_n);
    if !LOADS_N.contains(&median) {
        let guess = match median {
            median if median < 0.0 => "has the wrong sign: count the force of the finger on the screen as positive",
            median if median <= *LOADS_N.start() => "is too small: in kilonewtons, or without its calibration",
            median if median <= 30.0 => {
                "looks like a pressure in kilopascals, which must be multiplied by the contact area"
            }
            _ => "looks like millinewtons",
        };
        return Err(FitError::Refused(format!(
            "the median of normal_force_n is {}, and a finger on a touchscreen presses with 0.03 to 3 N: the column \
             {guess}; give newtons, or name the column normal_force_mn if it is in millinewtons",
            plain(median)
        )));
    }
    Ok(())
}

/// Checks that there are enough strokes.
pub(super) fn check_strokes(recording: &Recording) -> Result<(), FitError> {
    let found = recording.strokes.len();
    if found < STROKES_MIN { Err(too_few_strokes(found)) } else { Ok(()) }
}

fn too_few_strokes(found: usize) -> FitError {
    FitError::TooFew(format!(
        "{found} strokes are too few for an interval: record at least {STROKES_MIN}; 60 s of strokes back and forth \
         are best"
    ))
}

/// Checks that there are enough strokes at a voltage for an interval.
pub(super) fn check_at_voltage(found: usize, voltage_v_rms: f64) -> Result<(), FitError> {
    if found >= GROUP_MIN {
        return Ok(());
    }
    Err(FitError::TooFew(format!(
        "{found} of the strokes are at {voltage_v_rms:.0} V rms, too few for an interval: record at least {GROUP_MIN}, \
         best as many as at the other voltages, or leave them out with --without"
    )))
}

/// Checks that there are enough strokes near the highest voltage, on which electric friction depends.
pub(super) fn check_top(strokes: &[StrokeMeans], voltage_v_rms: f64) -> Result<(), FitError> {
    let is_near =
        |stroke: &&StrokeMeans| stroke.observations.iter().any(|one| one.voltage_v_rms >= NEAR_TOP * voltage_v_rms);
    check_at_voltage(strokes.iter().filter(is_near).count(), voltage_v_rms)
}

/// Whether there are voltages to compare: the lowest and the highest of the drive, which are returned, have to be
/// volts, and far enough apart. `None` if it is never on.
pub(super) fn check_voltages(range_v_rms: Option<(f64, f64)>) -> Result<(f64, f64), FitError> {
    let Some((low, high)) = range_v_rms else {
        let sentence = "the voltage is zero throughout: record with the drive switched on and off";
        return Err(FitError::Refused(sentence.to_owned()));
    };
    if high < VOLTAGE_MIN_V_RMS {
        return Err(FitError::Refused(format!(
            "the highest voltage of voltage_v_rms is {high} V, and below 1 V a drive adds no friction that can be \
             measured: name the column voltage_kv_rms if it is in kilovolts"
        )));
    }
    if high < VOLTAGE_RATIO_MIN * low {
        return Err(FitError::Refused(format!(
            "only one voltage ({high:.1} V rms besides zero): the model is tested by how friction grows from one \
             voltage to another; record at least two, for example 75, 106 and 150 V rms"
        )));
    }
    Ok((low, high))
}

/// Checks that the voltages are those of an envelope, not of the carrier itself. An envelope rests at a level for some
/// rows.
pub(super) fn check_carrier(recording: &Recording, levels: &Levels) -> Result<(), FitError> {
    let (rest_rows, rest_s) = levels.rest(recording);
    let is_carrier = rest_s.map_or(rest_rows < REST_MIN_ROWS, |rest_s| rest_s < REST_MIN_S);
    if !is_carrier {
        return Ok(());
    }
    Err(FitError::Refused(format!(
        "the voltages look like samples of the carrier itself, since they stay the same for {rest_rows:.1} rows only: give \
         the root mean square of the drive over one carrier period"
    )))
}

/// Checks that rows are close enough together to leave out those beside each switch of the drive.
pub(super) fn check_phases(phases: &Phases) -> Result<(), FitError> {
    let Some(rows) = phases.unresolved_rows() else { return Ok(()) };
    Err(FitError::Refused(format!(
        "the drive is switched every {rows:.0} rows, too few to leave out the rows beside a switch, where friction is \
         still changing: record at least {ROWS_HZ_MIN} rows a second and switch every 20 ms or later"
    )))
}

/// Leaves out the strokes whose loads are not like those of the others; returns the median load, and the smallest and
/// the largest of a stroke.
pub(super) fn check_loads(recording: &mut Recording, defects: &mut Defects) -> (f64, (f64, f64)) {
    let of_stroke = |stroke: &Stroke| stroke.median(|row| row.normal_force_n);
    let median_n = median(recording.rows().map(|row| row.normal_force_n));
    recording.strokes.retain(|stroke| {
        let load_n = of_stroke(stroke);
        let off = (load_n / median_n - 1.0).abs();
        if off > LOAD_TOLERANCE {
            defects.push(&stroke.name, StrokeDefect::Load { load_n, percent: 100.0 * off, median_n });
        }
        off <= LOAD_TOLERANCE
    });
    let loads = || recording.strokes.iter().map(of_stroke);
    (median_n, (loads().fold(f64::INFINITY, f64::min), loads().fold(0.0, f64::max)))
}

/// Checks that natural friction is known and is that of skin. Leaves out the strokes in which it was not that of a
/// sliding finger.
pub(super) fn check_natural(strokes: &mut Vec<StrokeMeans>, defects: &mut Defects) -> Result<(), FitError> {
    let ratio = median(strokes.iter().filter_map(|stroke| stroke.natural_coefficient));
    if ratio.is_nan() {
        let sentence = "no row has a voltage of zero, so natural friction is unknown: switch the drive on and off while \
                        the finger slides";
        return Err(FitError::Refused(sentence.to_owned()));
    }
    if !COEFFICIENTS.contains(&ratio) {
        let guess = if ratio > *COEFFICIENTS.end() {
            "is not in newtons; friction looks like millinewtons, or the load like kilonewtons"
        } else {
            "is not in newtons; the load looks like millinewtons or kilopascals"
        };
        return Err(FitError::Refused(format!(
            "friction_n over normal_force_n has a median of {ratio:.3} at no voltage, and that of skin on glass is 0.05 to \
             5: one of the columns {guess}; give newtons in both, or name the column friction_mn or normal_force_mn if it \
             is in millinewtons"
        )));
    }
    strokes.retain(|stroke| {
        let Some(coefficient) = stroke.natural_coefficient else { return true };
        let slips = coefficient >= SLIP_SHARE * ratio;
        if !slips {
            let found = format!("friction over load is {coefficient:.3} with the drive off, and {ratio:.3} in others");
            defects.push(&stroke.name, StrokeDefect::NoSlip { found });
        }
        slips
    });
    Ok(())
}

/// Checks that each force can be that of a finger. Called after the checks of medians, which show a wrong unit of a
/// whole column.
pub(super) fn check_forces(recording: &Recording) -> Result<(), FitError> {
    for row in recording.rows() {
        for (column, found_n) in [("normal_force_n", row.normal_force_n), ("friction_n", row.friction_n)] {
            if found_n.abs() > FORCE_MAX_N {
                return Err(FitError::Refused(format!(
                    "row {}, column {column}: {} N is not a valid force of a finger: correct the cell, or name the \
                     column friction_mn or normal_force_mn if it is in millinewtons",
                    row.number,
                    plain(found_n)
                )));
            }
        }
    }
    Ok(())
}

/// Whether the drive acted in every stroke, as it does on a finger that slips: the strokes whose attraction is far
/// below that of others at the same voltage did not. A whole voltage below the fit shows that the law is a different
/// one.
pub(super) fn check_slip(strokes: &[StrokeMeans], fitted: &Solution, defects: &mut Defects) {
    let mut ratios: Vec<(&StrokeMeans, f64)> = strokes
        .iter()
        .filter_map(|stroke| {
            let ratio = mean(stroke.observations.iter().filter_map(|one| {
                let Measured::Attraction(attraction_n) = one.measured else { return None };
                Some(attraction_n / fitted.attraction.attraction_n(one.voltage_v_rms, one.normal_load_n)?)
            }));
            (!ratio.is_nan()).then_some((stroke, ratio))
        })
        .collect();
    // The order of strokes of one voltage stays.
    ratios.sort_by_key(|(stroke, _)| stroke.top_level);
    // Where each voltage has few strokes, only the fit tells what is usual.
    let mut rest = Vec::new();
    for alike in ratios.chunk_by(|(one, _), (other, _)| one.top_level == other.top_level) {
        if alike.len() < GROUP_MIN { rest.extend_from_slice(alike) } else { check_slip_of(alike, defects) }
    }
    check_slip_of(&rest, defects);
}

/// Finds the strokes whose part of the fitted attraction is far below the usual one of these strokes.
fn check_slip_of(ratios: &[(&StrokeMeans, f64)], defects: &mut Defects) {
    let usual = median(ratios.iter().map(|(_, ratio)| *ratio));
    if !(usual > 0.0) {
        return;
    }
    let spread = 1.4826 * median(ratios.iter().map(|(_, ratio)| (ratio - usual).abs()));
    // A stroke of little electric friction only says something where strokes agree with each other.
    let least = (RESPONSE_SHARE * usual).min(usual - 6.0 * spread);
    for (stroke, ratio) in ratios.iter().filter(|(_, ratio)| *ratio < least) {
        let found = format!("the drive added {:.0} % of the friction that it added in others", 100.0 * ratio / usual);
        defects.push(&stroke.name, StrokeDefect::NoSlip { found });
    }
}

/// Checks that friction is stated at a voltage that was measured.
pub(super) fn check_stated_voltage(settings: &Settings, max: f64) -> Result<(), FitError> {
    let stated = settings.voltage_v_rms;
    if stated <= EXTRAPOLATION * max {
        return Ok(());
    }
    Err(FitError::Refused(format!(
        "the data end at {max:.1} V rms, so friction at {stated} V would be extrapolated: record up to {stated} V rms, \
         or use --voltage {max:.0}"
    )))
}

/// Checks that friction is stated under a load that was measured.
pub(super) fn check_stated_load(settings: &Settings, loads: (f64, f64)) -> Result<(), FitError> {
    let (low, high) = loads;
    match settings.normal_load_n {
        Some(stated) if !(low / EXTRAPOLATION..=high * EXTRAPOLATION).contains(&stated) => {
            Err(FitError::Refused(format!(
                "the data have loads from {low:.3} to {high:.3} N, so friction under {stated} N would be extrapolated: \
                 record under that load, or leave out --load"
            )))
        }
        _ => Ok(()),
    }
}
