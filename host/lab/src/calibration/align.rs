//! Aligns the clock of the force sensor with the board's, and joins their data.

use super::{CalibrationError, ForceRow};
use crate::fit::turns::STILL_MM_S;
use crate::fit::{ROWS_HZ_MIN, Row, STROKE_MIN_S};

/// Rate at which both signals are compared, in Hz.
const GRID_HZ: f64 = 1000.0;
/// Grid points that are averaged for the first, coarse search.
const COARSE: usize = 5;
/// Length of the baseline, in grid points. Slower changes are not a response to the drive.
const BASELINE: usize = 100;
/// Range of the fine search around the coarse result, in grid points.
const FINE: i64 = 12;
/// Least correlation of friction with the squared voltage.
const CORRELATION_MIN: f64 = 0.1;
/// Largest drift of the clocks during the recording, in seconds.
const DRIFT_MAX_S: f64 = 1e-3;

/// A report of the board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardRow {
    /// Time on the board's clock, in seconds.
    pub time_s: f64,
    /// Envelope, in volts rms.
    pub voltage_v_rms: f64,
    /// Speed of the finger; 0 without one.
    pub speed_mm_s: f64,
}

/// Joins the board's rows with the forces of a sensor whose clock began at another time, and numbers the strokes. If
/// the finger is simulated, each row is marked.
///
/// Fails if friction does not follow the drive, or if the two clocks drift apart by more than 1 ms.
pub fn align(board: &[BoardRow], forces: &[ForceRow], is_simulated: bool) -> Result<Vec<Row>, CalibrationError> {
    let duration_s = |first: Option<f64>, last: Option<f64>| first.zip(last).map_or(0.0, |(first, last)| last - first);
    let found = duration_s(forces.first().map(|row| row.time_s), forces.last().map(|row| row.time_s));
    let needed = duration_s(board.first().map(|row| row.time_s), board.last().map(|row| row.time_s));
    if found < 0.95 * needed || forces.len() < 2 {
        return Err(CalibrationError::Refused(format!(
            "the forces last {found:.1} s, and the protocol {needed:.1} s: start the sensor before the board, and stop it \
             after"
        )));
    }
    let sensor_hz = (forces.len() - 1) as f64 / found;
    if sensor_hz.round() < ROWS_HZ_MIN {
        return Err(CalibrationError::Refused(format!(
            "the forces have {sensor_hz:.0} rows a second, fewer than {ROWS_HZ_MIN}: half-periods of 20 ms need more"
        )));
    }
    let drive = detrended(&grid(board, |row| row.time_s, |row| row.voltage_v_rms * row.voltage_v_rms));
    let answer = detrended(&grid(forces, |row| row.time_s, |row| row.friction_n.abs()));
    let coarse = best_lag(&decimated(&drive), &decimated(&answer), None).0 * COARSE as i64;
    let around = Some((coarse - FINE, coarse + FINE));
    let (lag, correlation) = best_lag(&drive, &answer, around);
    if correlation < CORRELATION_MIN {
        return Err(CalibrationError::Refused(format!(
            "friction does not follow the drive (correlation {correlation:.2}): check that the electrode is driven, that \
             the finger slides, and that the forces are those of this run"
        )));
    }
    let third = drive.len() / 3;
    let lag_of = |from: usize| {
        let part: Vec<f64> = (0..drive.len())
            .map(
                |index| {
                    if (from..from + third).contains(&index) { drive.get(index).copied().unwrap_or(0.0) } else { 0.0 }
                },
            )
            .collect();
        refined(&part, &answer, best_lag(&part, &answer, Some((lag - FINE, lag + FINE))).0)
    };
    let drift_s = (lag_of(drive.len() - third) - lag_of(0)) / GRID_HZ;
    if drift_s.abs() > DRIFT_MAX_S {
        return Err(CalibrationError::Refused(format!(
            "the clocks of board and sensor drift apart by {:.1} ms during the recording, more than 1 ms: sample the forces \
             on a steadier clock",
            1e3 * drift_s
        )));
    }
    let lag_s = refined(&drive, &answer, lag) / GRID_HZ;
    let starts = (board.first().map_or(0.0, |row| row.time_s), forces.first().map_or(0.0, |row| row.time_s));
    Ok(joined(board, forces, starts.1 + lag_s - starts.0, is_simulated))
}

/// Values on a grid of [`GRID_HZ`] from the first row on, the last row before each point.
fn grid<R>(rows: &[R], time_s: impl Fn(&R) -> f64, value: impl Fn(&R) -> f64) -> Vec<f64> {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else { return Vec::new() };
    let start_s = time_s(first);
    let count = ((time_s(last) - start_s) * GRID_HZ) as usize;
    let mut index = 0;
    (0..count)
        .map(|point| {
            let at_s = start_s + point as f64 / GRID_HZ;
            while rows.get(index + 1).is_some_and(|row| time_s(row) <= at_s + 1e-9) {
                index += 1;
            }
            rows.get(index).map_or(0.0, &value)
        })
        .collect()
}

/// Values less their mean over [`BASELINE`] points around each.
fn detrended(values: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0];
    let mut sum = 0.0;
    sums.extend(values.iter().map(|value| {
        sum += value;
        sum
    }));
    let at = |index: usize| sums.get(index).copied().unwrap_or(sum);
    let mean = |index: usize| {
        let (from, to) = (index.saturating_sub(BASELINE / 2), (index + BASELINE / 2).min(values.len()));
        (at(to) - at(from)) / (to - from) as f64
    };
    values.iter().enumerate().map(|(index, value)| value - mean(index)).collect()
}

fn decimated(values: &[f64]) -> Vec<f64> {
    values.chunks(COARSE).map(|chunk| chunk.iter().sum::<f64>() / chunk.len() as f64).collect()
}

/// Correlation of `drive` with `answer` that comes `lag` points later.
fn correlation(drive: &[f64], answer: &[f64], lag: i64) -> f64 {
    let from = (-lag).max(0) as usize;
    let shifted = answer.get((lag.max(0)) as usize..).unwrap_or_default();
    let pairs = drive.get(from..).unwrap_or_default().iter().zip(shifted);
    let (product, drives, answers) = pairs.fold((0.0, 0.0, 0.0), |(product, drives, answers), (one, other)| {
        (product + one * other, drives + one * one, answers + other * other)
    });
    let power: f64 = drive.iter().map(|value| value * value).sum();
    // What does not overlap counts as no answer.
    if answers > 0.0 && drives > 0.0 { product / (power.max(drives) * answers).sqrt() } else { 0.0 }
}

/// The lag of the largest correlation, and that correlation; among all lags, or from one to another.
fn best_lag(drive: &[f64], answer: &[f64], between: Option<(i64, i64)>) -> (i64, f64) {
    let (from, to) = between.unwrap_or((-(drive.len() as i64) / 2, answer.len() as i64));
    let lags = (from..=to).map(|lag| (lag, correlation(drive, answer, lag)));
    lags.max_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or((0, 0.0))
}

/// The lag between grid points, from a parabola through the correlations around the best one.
fn refined(drive: &[f64], answer: &[f64], lag: i64) -> f64 {
    let [before, at, after] = [lag - 1, lag, lag + 1].map(|lag| correlation(drive, answer, lag));
    let curvature = before - 2.0 * at + after;
    let shift = if curvature < 0.0 { 0.5 * (before - after) / curvature } else { 0.0 };
    lag as f64 + shift
}

/// One row for each force, with what the board reported at that time. The sensor's time is ahead by `offset_s`.
fn joined(board: &[BoardRow], forces: &[ForceRow], offset_s: f64, is_simulated: bool) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    let mut stroke = 0_u32;
    let mut stroke_start = 0;
    let mut is_sliding = false;
    for force in forces {
        let time_s = force.time_s - offset_s;
        let index = board.partition_point(|row| row.time_s <= time_s);
        let Some(seen) = index.checked_sub(1).and_then(|index| board.get(index)) else { continue };
        let slides = seen.speed_mm_s >= STILL_MM_S && index < board.len();
        if is_sliding && !slides {
            leave_out_if_short(&mut rows, stroke_start);
        }
        if slides && !is_sliding {
            stroke += 1;
            stroke_start = rows.len();
        }
        is_sliding = slides;
        if slides {
            rows.push(Row {
                number: 0,
                voltage_v_rms: seen.voltage_v_rms,
                normal_force_n: force.normal_force_n,
                friction_n: force.friction_n,
                time_s: Some(time_s),
                stroke: Some(stroke.to_string()),
                speed_mm_s: Some(seen.speed_mm_s),
                is_simulated,
            });
        }
    }
    leave_out_if_short(&mut rows, stroke_start);
    for (row, number) in rows.iter_mut().zip(2..) {
        row.number = number;
    }
    rows
}

fn leave_out_if_short(rows: &mut Vec<Row>, start: usize) {
    let time_s = |row: Option<&Row>| row.and_then(|row| row.time_s).unwrap_or(0.0);
    if time_s(rows.last()) - time_s(rows.get(start)) < STROKE_MIN_S {
        rows.truncate(start);
    }
}

#[cfg(test)]
mod tests {
    use super::super::Protocol;
    use super::{BoardRow, ForceRow, align};

    fn refused(board: &[BoardRow], forces: &[ForceRow]) -> String {
        align(board, forces, false).unwrap_err().to_string()
    }

    /// A board that drives random half-periods, and a sensor whose clock is `offset_s` ahead and `rate` times as fast.
    fn recorded(offset_s: f64, rate: f64) -> (Vec<BoardRow>, Vec<ForceRow>) {
        let protocol = Protocol { strokes: 12, ..Protocol::new(150.0, 3) };
        let samples = protocol.samples().unwrap();
        let at = |time_s: f64| -> f64 {
            let index = (time_s * f64::from(protocol.sample_hz())) as usize;
            f64::from(samples.get(index).copied().unwrap_or(0)) / f64::from(u16::MAX)
        };
        let rows = (protocol.duration_s() * 1e3) as u32;
        let time_s = |row: u32| f64::from(row) / 1e3;
        let board = (0..rows).map(|row| {
            let voltage_v_rms = 150.0 * at(time_s(row)).sqrt();
            BoardRow { time_s: time_s(row), voltage_v_rms, speed_mm_s: 50.0 }
        });
        let forces = (0..rows + 3000).map(|row| {
            let board_s = time_s(row) - 1.5;
            let friction_n = 0.25 + if board_s >= 0.0 { 0.1 * at(board_s) } else { 0.0 };
            ForceRow { time_s: offset_s + rate * board_s, normal_force_n: 0.5, friction_n }
        });
        (board.collect(), forces.collect())
    }

    #[test]
    fn clocks_that_began_at_other_times_are_aligned() {
        for offset_s in [0.0, 1234.5678, -7.25] {
            let (board, forces) = recorded(offset_s, 1.0);
            let rows = align(&board, &forces, false).unwrap();
            let wrong = rows.iter().filter(|row| (row.voltage_v_rms > 0.0) != (row.friction_n > 0.2501)).count();
            assert!(wrong * 25 < rows.len(), "{offset_s}: {wrong} of {}", rows.len());
        }
    }

    #[test]
    fn clocks_that_drift_by_more_than_a_millisecond_are_refused() {
        let (board, forces) = recorded(5.0, 1.0 + 2e-4);
        assert!(refused(&board, &forces).contains("drift apart by "), "{}", refused(&board, &forces));
        let (board, forces) = recorded(5.0, 1.0 + 1e-5);
        assert!(align(&board, &forces, false).is_ok());
    }

    #[test]
    fn forces_that_say_nothing_about_the_drive_are_refused() {
        let (board, mut forces) = recorded(5.0, 1.0);
        for (index, force) in forces.iter_mut().enumerate() {
            force.friction_n = 0.25 + 0.01 * ((index * 7919) % 101) as f64 / 101.0;
        }
        assert!(refused(&board, &forces).starts_with("friction does not follow the drive"));
        let few: Vec<ForceRow> = forces.iter().step_by(10).copied().collect();
        assert!(refused(&board, &few).contains("fewer than 250"));
        assert!(refused(&board, &forces[..2000]).starts_with("the forces last 2.0 s"));
    }
}
