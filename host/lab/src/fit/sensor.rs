//! Checks that friction had settled in the compared rows: that the force sensor and its filters are fast enough, and
//! that friction was not smoothed afterwards.
//!
//! A slow sensor has not settled when the edge of a phase ends, and a filter that looks ahead, such as a centred mean,
//! moves friction before its switch. Either mixes the friction of both voltages. Two things show it: the time that
//! friction takes to rise, averaged over all switches; and electric friction that depends on how many rows beside a
//! switch are left out.

use super::contrast::{Edge, Edges, Phases, Run, StrokeMeans};
use super::error::FitError;
use super::least_squares::Measured;
use super::recording::usual_interval_s;
use crate::bootstrap::{GROUP_MIN, Z_999};
use crate::statistics::{mean, student_quantile};

/// Edges that leave out more than [`Edges::USED`] on one side of a switch. What comes after a slow or ringing sensor
/// and what comes before a smoothed switch decays differently, so each side has several. What reaches ahead by few rows
/// of a millisecond stands out where little else is left out.
const WIDER: [(Side, Edge); 5] = [
    (Side::Before, Edge { duration_s: 4e-3, share: 0.16 }),
    (Side::Before, Edge { duration_s: 5e-3, share: 0.2 }),
    (Side::Before, Edge { duration_s: 8e-3, share: 0.35 }),
    (Side::After, Edge { duration_s: 8e-3, share: 0.35 }),
    (Side::After, Edge { duration_s: 12e-3, share: 0.5 }),
];
/// Largest change of electric friction under wider edges that is allowed, as a part of it. A change within its 99.9 %
/// interval is noise.
const SETTLED_SHARE: f64 = 5e-3;
/// Largest 99.9 % half-interval of such a change that is conclusive, as a fraction of electric friction. A mean over
/// whole periods of the drive removes nearly all electric friction, and the rest depends on no edge.
const SETTLING_ERROR_MAX: f64 = 0.5;

/// Tolerance between means of one voltage over different rows, as a fraction of the voltage.
const SAME_VOLTAGE: f64 = 0.01;

/// Time around a switch that is examined, in seconds: `frixel finger calibrate` switches after 20 to 30 ms.
const BEFORE_S: f64 = 8e-3;
const AFTER_S: f64 = 18e-3;
/// Time before and after a switch in which friction may be in transition, in seconds.
const EDGE_S: f64 = 3e-3;
const SETTLED_S: f64 = 12e-3;
/// Largest number of intervals, that of 1 MHz. No sensor is faster.
const BINS_MAX: usize = 26_000;
/// Smallest number of switches in either direction for a result.
const SWITCHES_MIN: usize = 50;
/// Noise of the averaged friction that hides a rise, as a fraction of its step.
const NOISE_MAX: f64 = 0.04;
/// Bandwidth times rise time from 10 to 90 %: 0.350 for one pole, 0.34 to 0.36 for the filters of force sensors.
pub(super) const BANDWIDTH_TIMES_RISE: f64 = 0.35;
/// Rise time from 10 to 90 % of a mean over an interval, as a fraction of the interval.
const RISE_OF_MEAN: f64 = 0.8;
/// Smallest accepted bandwidth, in Hz, of sensor, finger and clocks together. A sensor of one pole at 200 Hz is found
/// as 171 Hz or more, and a Savitzky-Golay filter over 11 ms, which biases a fit by 1.4 %, as 131 Hz.
const BANDWIDTH_MIN_HZ: f64 = 135.0;

/// Smallest row rate, in Hz. Below it, the bandwidth of the sensor remains unknown.
pub(crate) const ROWS_HZ_MIN: f64 = 250.0;

/// Bandwidth of the response to a switch of the drive, in Hz, including the finger's friction. `None` if the data are
/// inconclusive: without times, with few switches, or too noisy. Fails if it is too slow.
pub(super) fn check_bandwidth(phases: &Phases) -> Result<Option<f64>, FitError> {
    let Some(rise_s) = rise_s(phases) else { return Ok(None) };
    let bandwidth_hz = BANDWIDTH_TIMES_RISE / rise_s;
    if bandwidth_hz < BANDWIDTH_MIN_HZ {
        let rise_ms = 1e3 * rise_s;
        return Err(FitError::NotSettled(format!(
            "the force sensor is too slow: friction takes {rise_ms:.1} ms from 10 to 90 % of its way after a switch of \
             the drive, as with a bandwidth of {bandwidth_hz:.0} Hz, so that electric friction would come out too \
             small; use a sensor, and a filter behind it, of at least 200 Hz, with at least {ROWS_HZ_MIN} rows a second"
        )));
    }
    Ok(Some(bandwidth_hz))
}

/// A side of a switch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Before,
    After,
}

/// Fails if electric friction depends on how many rows beside a switch are left out; `used` are the means without
/// [`Edges::USED`]. Returns the widest 99.9 % half-interval of its changes, as a part of it.
pub(super) fn check_settled(phases: &Phases, used: &[StrokeMeans]) -> Result<f64, FitError> {
    let shifts = WIDER.iter().filter_map(|(side, edge)| {
        let edges = match side {
            Side::Before => Edges { before: *edge, ..Edges::USED },
            Side::After => Edges { after: *edge, ..Edges::USED },
        };
        Some((side, edge, shift(used, &phases.means(&edges))?))
    });
    let shifts: Vec<(&Side, &Edge, Shift)> = shifts.collect();
    let excess = |shift: &Shift| shift.share.abs() / shift.error.max(SETTLED_SHARE);
    let largest = shifts.iter().max_by(|(_, _, one), (_, _, other)| excess(one).total_cmp(&excess(other)));
    let Some((side, edge, shift)) = largest.filter(|(_, _, shift)| excess(shift) > 1.0) else {
        return Ok(shifts.iter().map(|(_, _, shift)| shift.error).fold(0.0, f64::max));
    };
    let edge = match usual_interval_s(phases.rows()) {
        interval_s if interval_s.is_nan() => format!("{:.0} % of a phase", 1e2 * edge.share),
        _ => format!("{:.0} ms", 1e3 * edge.duration_s),
    };
    let (side, cause) = match side {
        Side::Before => ("before", FORESIGHT),
        Side::After => ("after", SLOWNESS),
    };
    let (percent, change) = (1e2 * shift.share.abs(), if shift.share < 0.0 { "smaller" } else { "larger" });
    Err(FitError::NotSettled(format!(
        "electric friction comes out {percent:.1} % {change} if rows within {edge} {side} each switch of the drive are \
         left out: {cause}"
    )))
}

/// Fails if the intervals of [`check_settled`] are too wide to show anything. This check follows that of the estimates'
/// intervals, which the same noise widens, and whose message has more detail.
pub(super) fn check_settling_error(error: f64) -> Result<(), FitError> {
    if error <= SETTLING_ERROR_MAX {
        return Ok(());
    }
    Err(FitError::Refused(format!(
        "the drive adds too little friction for the noise to tell whether friction was smoothed: electric friction may \
         change by {:.0} % with the rows that are left out beside each switch; fit what the sensor gave, without a mean \
         or a filter behind it, and check that the electrode is driven",
        1e2 * error
    )))
}

const FORESIGHT: &str = "friction changes before the drive switches, as it does after a centred mean, filtfilt or a \
                         Savitzky-Golay filter; use the sensor's own samples, with their times in a column time_s";
const SLOWNESS: &str = "the force sensor or a filter behind it is slower than 200 Hz, or friction was smoothed so that \
                        it changes before the drive switches; record with a faster sensor, and with its times in a \
                        column time_s";

/// A change of electric friction.
struct Shift {
    /// As a part of electric friction.
    share: f64,
    /// 99.9 % half-interval of the share.
    error: f64,
}

/// Change of electric friction under wider edges, over strokes; `None` if too few strokes are left.
fn shift(used: &[StrokeMeans], wider: &[StrokeMeans]) -> Option<Shift> {
    let pairs: Vec<(f64, f64)> =
        used.iter().zip(wider).filter_map(|(used, wider)| weighted_attractions(used, wider)).collect();
    if pairs.len() < GROUP_MIN {
        return None;
    }
    let total: f64 = pairs.iter().map(|(used, _)| used).sum();
    let share = pairs.iter().map(|(used, wider)| wider - used).sum::<f64>() / total;
    let square: f64 = pairs.iter().map(|(used, wider)| (wider - used - share * used).powi(2)).sum();
    let count = pairs.len() as f64;
    let deviation = (count / (count - 1.0) * square).sqrt() / total.abs();
    let error = student_quantile(Z_999, count - 1.0) * deviation;
    if !(share.is_finite() && error.is_finite()) {
        // Without electric friction there is nothing to compare.
        return Some(Shift { share: 0.0, error: f64::INFINITY });
    }
    // Recordings without noise have none.
    Some(Shift { share, error: error.max(f64::MIN_POSITIVE) })
}

/// Sums of a stroke's attractions with the used and with the wider edges, weighted by the square of the voltage as in a
/// least-squares fit of a square law. `None` if no voltage has rows with both edges.
fn weighted_attractions(used: &StrokeMeans, wider: &StrokeMeans) -> Option<(f64, f64)> {
    let mut sums = None;
    for (voltage_v_rms, attraction_n) in attractions(used) {
        let is_same = |other_v_rms: f64| (other_v_rms - voltage_v_rms).abs() <= SAME_VOLTAGE * voltage_v_rms;
        if let Some((_, wider_n)) = attractions(wider).find(|(other_v_rms, _)| is_same(*other_v_rms)) {
            let weight = voltage_v_rms * voltage_v_rms;
            let (of_used, of_wider) = sums.unwrap_or_default();
            sums = Some((of_used + weight * attraction_n, of_wider + weight * wider_n));
        }
    }
    sums
}

/// The voltages of a stroke with the drive on, and their attractions.
fn attractions(stroke: &StrokeMeans) -> impl Iterator<Item = (f64, f64)> {
    stroke.observations.iter().filter_map(|one| match one.measured {
        Measured::Attraction(attraction_n) => Some((one.voltage_v_rms, attraction_n)),
        Measured::Friction(_) => None,
    })
}

/// Sum and number of friction over load in each interval around a switch.
#[derive(Clone)]
struct Average(Vec<(f64, f64)>);

impl Average {
    fn at(&self, bin: usize) -> f64 {
        self.0.get(bin).map_or(f64::NAN, |(sum, count)| sum / count)
    }
}

/// Time from 10 to 90 % of the way between friction with the drive off and on.
fn rise_s(phases: &Phases) -> Option<f64> {
    let interval_s = usual_interval_s(phases.rows());
    // Not-a-number without times.
    if !(interval_s > 0.0) {
        return None;
    }
    let before = (BEFORE_S / interval_s).round() as usize;
    let bins = before + (AFTER_S / interval_s).round() as usize;
    if bins > BINS_MAX {
        return None;
    }
    // Once for switches that turn the drive on, once for those that turn it off: their difference is free of what
    // friction does beside.
    let mut averages = [Average(vec![(0.0, 0.0); bins]), Average(vec![(0.0, 0.0); bins])];
    let mut switches = [0_usize; 2];
    for (_, runs) in &phases.strokes {
        // What changes in steps, because the voltage was seen in the middle of a change, is one switch.
        let steady: Vec<&Run> = runs.iter().filter(|run| run.lasts_s() >= BEFORE_S).collect();
        for (one, next) in steady.iter().zip(steady.iter().skip(1)) {
            let direction = match (one.level, next.level) {
                (None, Some(_)) => 0,
                (Some(_), None) => 1,
                _ => continue,
            };
            let Some(switch_s) = next.starts_s() else { continue };
            if let (Some(average), Some(count)) = (averages.get_mut(direction), switches.get_mut(direction)) {
                *count += 1;
                for (_, row) in one.rows.iter().chain(&next.rows) {
                    let Some(time_s) = row.time_s else { continue };
                    let bin = ((time_s - switch_s) / interval_s).round() + before as f64;
                    if bin >= 0.0
                        && let Some((sum, number)) = average.0.get_mut(bin as usize)
                    {
                        *sum += row.friction_n / row.normal_force_n;
                        *number += 1.0;
                    }
                }
            }
        }
    }
    if switches.iter().any(|count| *count < SWITCHES_MIN) {
        return None;
    }
    let [on, off] = averages;
    let response: Vec<f64> = (0..bins).map(|bin| on.at(bin) - off.at(bin)).collect();
    let time_s = |bin: usize| (bin as f64 - before as f64) * interval_s;
    // A row is a mean over an interval, and the switch was somewhere in one.
    let sampling_s = RISE_OF_MEAN * interval_s;
    let rise_s =
        rise_of(&response, &time_s).map(|rise_s| rise_s * rise_s - 2.0 * sampling_s * sampling_s)?.max(0.0).sqrt();
    // What is shorter than an interval cannot be told.
    let rise_s = rise_s.max(interval_s);
    (rise_s > interval_s || interval_s < BANDWIDTH_TIMES_RISE / BANDWIDTH_MIN_HZ).then_some(rise_s)
}

/// Time from 10 to 90 % of a step in the response.
fn rise_of(response: &[f64], time_s: &dyn Fn(usize) -> f64) -> Option<f64> {
    let within = |from_s: f64, to_s: f64| -> Vec<f64> {
        let numbered = response.iter().enumerate();
        numbered.filter(|(bin, _)| (from_s..to_s).contains(&time_s(*bin))).map(|(_, value)| *value).collect()
    };
    let (before, after) = (within(f64::NEG_INFINITY, -EDGE_S), within(SETTLED_S, f64::INFINITY));
    let (low, high) = (mean(before.iter().copied()), mean(after.iter().copied()));
    let step = high - low;
    let noise = mean(before.iter().map(|value| (value - low).powi(2))).sqrt();
    if !(step > 0.0 && noise <= NOISE_MAX * step) {
        return None;
    }
    let part = |bin: usize| response.get(bin).map(|value| (value - low) / step);
    let middle = (0..response.len()).find(|bin| part(*bin).is_some_and(|part| part >= 0.5))?;
    // Where the way crosses a part of the step, between two bins.
    let crossing = |bin: usize, at: f64| -> Option<f64> {
        let (from, to) = (part(bin.checked_sub(1)?)?, part(bin)?);
        Some(time_s(bin - 1) + (at - from) / (to - from) * (time_s(bin) - time_s(bin - 1)))
    };
    let below = (0..middle).rev().find(|bin| part(*bin).is_some_and(|part| part < 0.1))?;
    let above = (middle..response.len()).find(|bin| part(*bin).is_some_and(|part| part >= 0.9))?;
    Some(crossing(above, 0.9)? - crossing(below + 1, 0.1)?)
}
