//! The zero of the force sensor, from rows without contact.
//!
//! An untared sensor adds a constant to load and friction. While no finger touches the screen, it reads only that
//! constant, so averages over short times agree. Under a resting finger they do not.

use super::recording::usual_interval_s;
use super::table::Row;
use super::turns::STILL_MM_S;
use crate::statistics::{mean, median, quantile};

/// Duration of an average, in seconds; also the margin left out where a finger may land or lift.
const BLOCK_S: f64 = 0.05;
/// Least time without contact, in seconds.
const DURATION_MIN_S: f64 = 0.2;
/// Quantiles of the loads that count as the lowest load and as the load in contact: a finger also lifts.
const LOWEST_PART: f64 = 0.01;
const CONTACT_PART: f64 = 0.9;
/// Fraction of the load in contact below which a finger does not slide as in the rest of the recording.
const LIFTED_SHARE: f64 = 0.5;
/// Tolerance between averages without contact: so many standard errors (the noise of the sensor), or this fraction of
/// the load in contact. The load of a finger that rests on the screen varies by more.
const AGREEMENT_ERRORS: f64 = 4.0;
const AGREEMENT: f64 = 0.002;
/// How far rows without contact may differ, likewise: each has the sensor's noise.
const SCATTER: f64 = 0.2;
/// Least part of the rows below [`LIFTED_SHARE`], and of their averages, that agree: the others are a finger that lands
/// or lifts.
const AGREEING_PART: f64 = 0.8;
/// Smallest load of a finger, in newtons; less is noise.
const CONTACT_MIN_N: f64 = 0.03;

/// Reading of the force sensor without contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorZero {
    /// Normal force, in newtons.
    pub normal_force_n: f64,
    /// Friction, in newtons.
    pub friction_n: f64,
    /// Time without contact, in seconds.
    pub duration_s: f64,
}

/// Returns the rows in contact, minus the zero of the sensor, and this zero. Returns all rows unchanged and `None` if
/// no rows are certainly without contact.
pub(super) fn taken_from(rows: Vec<Row>) -> (Vec<Row>, Option<SensorZero>) {
    let Some((zero, least_n)) = zero(&rows) else { return (rows, None) };
    let in_contact = rows.into_iter().filter(|row| row.normal_force_n >= least_n);
    let tared = in_contact.map(|row| Row {
        normal_force_n: row.normal_force_n - zero.normal_force_n,
        friction_n: row.friction_n - zero.friction_n,
        ..row
    });
    (tared.collect(), Some(zero))
}

/// The zero, and the reading of the normal force at which contact begins.
fn zero(rows: &[Row]) -> Option<(SensorZero, f64)> {
    if rows.iter().any(|row| row.time_s.is_none()) {
        return None;
    }
    let mut loads_n: Vec<f64> = rows.iter().map(|row| row.normal_force_n).collect();
    loads_n.sort_by(f64::total_cmp);
    let (lowest_n, contact_n) = (quantile(&loads_n, LOWEST_PART), quantile(&loads_n, CONTACT_PART));
    let lifted_below = |low_n: f64| low_n + LIFTED_SHARE * (contact_n - low_n);
    let blocks = blocks(rows, lifted_below(lowest_n));
    let averages: Vec<[f64; 2]> = blocks.iter().map(|block| average(block.iter())).collect();
    let centre = [0, 1].map(|force| median(averages.iter().map(|average| average[force])));
    let [load_n, _] = centre;
    let step_n = contact_n - load_n;
    if !(step_n >= CONTACT_MIN_N) {
        return None;
    }
    let errors: Vec<[f64; 2]> = blocks.iter().map(|block| standard_errors(block)).collect();
    let tolerance_n = [0, 1].map(|force| {
        let noise_n = median(errors.iter().map(|error| error[force]));
        (AGREEMENT_ERRORS * noise_n).max(AGREEMENT * step_n)
    });
    let agrees = |average: [f64; 2]| (0..2).all(|force| (average[force] - centre[force]).abs() <= tolerance_n[force]);
    let agreeing: Vec<&[Row]> =
        blocks.iter().zip(&averages).filter(|(_, average)| agrees(**average)).map(|(block, _)| *block).collect();
    let duration_s = BLOCK_S * agreeing.len() as f64;
    let least_n = lifted_below(load_n);
    let lifted = loads_n.iter().take_while(|one_n| **one_n < least_n);
    let near = lifted.clone().filter(|one_n| (**one_n - load_n).abs() < SCATTER * step_n).count();
    let is_most = |part: usize, all: usize| part as f64 >= AGREEING_PART * all as f64;
    if duration_s < DURATION_MIN_S || !is_most(agreeing.len(), blocks.len()) || !is_most(near, lifted.count()) {
        return None;
    }
    // A drive that adds friction acts on a finger. Without rows of a kind, its average is not a number.
    let rows = || agreeing.iter().copied().flatten();
    let of_drive = |is_on: bool| average(rows().filter(|row| (row.voltage_v_rms > 0.0) == is_on));
    if [true, false].map(of_drive).into_iter().any(|average| !average[0].is_nan() && !agrees(average)) {
        return None;
    }
    let [normal_force_n, friction_n] = average(rows());
    Some((SensorZero { normal_force_n, friction_n, duration_s }, least_n))
}

/// Mean normal force and friction.
fn average<'r>(rows: impl Iterator<Item = &'r Row> + Clone) -> [f64; 2] {
    [mean(rows.clone().map(|row| row.normal_force_n)), mean(rows.map(|row| row.friction_n))]
}

/// Standard errors of the means of normal force and friction, as those of rows that are independent.
fn standard_errors(block: &[Row]) -> [f64; 2] {
    let means = average(block.iter());
    let count = block.len() as f64;
    let error = |value: fn(&Row) -> f64, centre: f64| {
        (mean(block.iter().map(|row| (value(row) - centre).powi(2))) / count).sqrt()
    };
    [error(|row| row.normal_force_n, means[0]), error(|row| row.friction_n, means[1])]
}

/// Blocks of consecutive rows below a load while no finger moves, without those at the ends of each run.
fn blocks(rows: &[Row], load_n: f64) -> Vec<&[Row]> {
    let interval_s = usual_interval_s(rows.iter());
    let count = (BLOCK_S / interval_s).round();
    if !(1.0..1e9).contains(&count) {
        return Vec::new();
    }
    let is_lifted = |row: &Row| {
        row.normal_force_n < load_n && row.speed_mm_s.is_none_or(|speed_mm_s| speed_mm_s.abs() < STILL_MM_S)
    };
    let is_next = |one: &Row, next: &Row| {
        let gap_s = next.time_s.zip(one.time_s).map_or(0.0, |(next_s, time_s)| next_s - time_s);
        is_lifted(one) == is_lifted(next) && (0.0..BLOCK_S).contains(&gap_s)
    };
    let runs = rows.chunk_by(is_next).filter(|run| run.first().is_some_and(is_lifted));
    runs.flat_map(|run| {
        let blocks = run.chunks_exact(count as usize);
        let inner = blocks.len().saturating_sub(2);
        blocks.skip(1).take(inner)
    })
    .collect()
}
