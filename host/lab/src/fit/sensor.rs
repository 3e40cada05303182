//! Whether the force sensor is fast enough: friction after each switch of the drive, averaged over all of them.
//!
//! A sensor that is slow has not arrived when the first half of a phase of the drive is over, so that electric friction
//! comes out too small. Where the clocks of board and sensor were aligned by what the sensor saw, its delay cannot be
//! told, but its rise can.

use super::contrast::{Levels, Run, runs};
use super::error::FitError;
use super::recording::{Recording, usual_interval_s};
use crate::statistics::mean;

/// What is looked at around a switch, in seconds: `frixel calibrate` switches after 20 to 30 ms.
const BEFORE_S: f64 = 8e-3;
const AFTER_S: f64 = 18e-3;
/// Friction from this long before a switch to the switch, and from this long after it, may be on its way.
const EDGE_S: f64 = 3e-3;
const SETTLED_S: f64 = 12e-3;
/// Fewer switches in either direction than this say nothing.
const SWITCHES_MIN: usize = 50;
/// Noise of the averaged friction, as a part of its step, with which a rise cannot be told.
const NOISE_MAX: f64 = 0.04;
/// Bandwidth times rise time from 10 to 90 %: 0.350 for one pole, 0.34 to 0.36 for the filters of force sensors.
pub(super) const BANDWIDTH_TIMES_RISE: f64 = 0.35;
/// Rise from 10 to 90 % of what is a mean over an interval, as a part of the interval.
const RISE_OF_MEAN: f64 = 0.8;
/// Slowest response that is fitted, in Hz. It is that of sensor, finger and clocks together.
const BANDWIDTH_MIN_HZ: f64 = 120.0;

/// Bandwidth of the response to a switch of the drive, in Hz, that of the finger's friction included; `None` if the
/// data cannot tell: without times, with few switches, or too noisy. Fails if it is too slow.
pub(super) fn check_bandwidth(recording: &Recording, levels: &Levels) -> Result<Option<f64>, FitError> {
    let Some(rise_s) = rise_s(recording, levels) else { return Ok(None) };
    let bandwidth_hz = BANDWIDTH_TIMES_RISE / rise_s;
    if bandwidth_hz < BANDWIDTH_MIN_HZ {
        return Err(FitError::SlowSensor { rise_ms: 1e3 * rise_s, bandwidth_hz });
    }
    Ok(Some(bandwidth_hz))
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
fn rise_s(recording: &Recording, levels: &Levels) -> Option<f64> {
    if !recording.has_time {
        return None;
    }
    let interval_s = usual_interval_s(recording.rows());
    if !(interval_s > 0.0) {
        return None;
    }
    let before = (BEFORE_S / interval_s).round() as usize;
    let bins = before + (AFTER_S / interval_s).round() as usize;
    // Once for switches that turn the drive on, once for those that turn it off: their difference is free of what
    // friction does beside.
    let mut averages = [Average(vec![(0.0, 0.0); bins]), Average(vec![(0.0, 0.0); bins])];
    let mut switches = [0_usize; 2];
    for stroke in &recording.strokes {
        let runs = runs(stroke, levels);
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
