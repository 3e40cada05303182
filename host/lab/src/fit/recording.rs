//! Divides rows into strokes, and drops rows without steady sliding.

use frixel_scene::brief;
use serde::Serialize;

use super::copies;
use super::defects::{Defects, StrokeDefect};
use super::error::FitError;
use super::table::Row;
use super::turns::{STILL_MM_S, pieces};
use crate::statistics::median;

/// Time dropped at the beginning of a stroke, in seconds: the finger starts to slide.
const START_S: f64 = 0.15;
/// Time dropped at the end of a stroke, in seconds: the finger turns.
const END_S: f64 = 0.05;
/// Shortest stroke, in seconds: 0.2 s remain after both ends are dropped.
pub(crate) const STROKE_MIN_S: f64 = START_S + 0.2 + END_S;
/// Least number of rows that are left of a stroke.
const KEPT_ROWS: usize = 5;
/// Speeds at which the lag of friction was measured, in mm/s (arXiv 2505.11162).
const SPEEDS_MM_S: core::ops::RangeInclusive<f64> = 20.0..=100.0;
/// A gap in time of this many usual intervals, but at least [`GAP_S`], divides two strokes.
const GAP_INTERVALS: f64 = 10.0;
/// See [`GAP_INTERVALS`], in seconds.
const GAP_S: f64 = 0.05;
/// Number of blocks of rows that replace strokes where the data show no strokes.
const BLOCKS: usize = 24;
/// Least number of rows in such a block.
const BLOCK_ROWS: usize = 5;
/// Largest fraction of the rows without a time where others have one: they are left out.
const TIMELESS_PART: f64 = 0.1;

/// How the rows were divided into strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Division {
    /// By the column `stroke`.
    Column,
    /// By direction, standstill and gaps in time.
    Motion,
    /// Into blocks of consecutive rows, because neither strokes nor motion are known.
    Blocks,
    /// Not at all: the rows are means.
    Means,
}

/// One stroke: rows of steady sliding in one direction.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stroke {
    pub(super) name: String,
    /// Rows that are used; friction is positive.
    pub(super) rows: Vec<Row>,
}

impl Stroke {
    pub(super) fn median(&self, value: impl Fn(&Row) -> f64) -> f64 {
        median(self.rows.iter().map(value))
    }

    /// Whether too little is left of it without start and end.
    fn is_short(&self) -> bool {
        self.rows.len() < KEPT_ROWS || self.duration_s().is_some_and(|duration_s| duration_s < STROKE_MIN_S)
    }

    /// Time from the first to the last row; `None` without times.
    fn duration_s(&self) -> Option<f64> {
        Some(self.rows.last()?.time_s? - self.rows.first()?.time_s?)
    }
}

/// Rows divided into strokes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Recording {
    pub(super) strokes: Vec<Stroke>,
    pub(super) division: Division,
    pub(super) has_time: bool,
    pub(super) has_speed: bool,
}

impl Recording {
    /// Divides rows into strokes, leaves out the ones named in `without` and the ones with defects, and drops starts
    /// and turns.
    pub(super) fn new(rows: Vec<Row>, without: &[String], defects: &mut Defects) -> Result<Self, FitError> {
        let has_time = rows.iter().all(|row| row.time_s.is_some());
        let has_speed = rows.iter().any(|row| row.speed_mm_s.is_some());
        check_time(&rows)?;
        if let Some([[first, last], [of_first, of_last]]) = copies::find(&rows) {
            return Err(FitError::Refused(format!(
                "rows {first} to {last} repeat rows {of_first} to {of_last}: delete the copy, or record the missing \
                 part again"
            )));
        }
        let (division, strokes) = divided(rows, has_time)?;
        let strokes = left(strokes, without)?;
        defects.strokes = strokes.len();
        let trimmed = strokes.into_iter().map(|stroke| (stroke.name.clone(), trimmed(stroke, division)));
        let strokes =
            trimmed.filter_map(|(name, stroke)| stroke.map_err(|defect| defects.push(&name, defect)).ok()).collect();
        Ok(Self { strokes, division, has_time, has_speed })
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = &Row> + Clone {
        self.strokes.iter().flat_map(|stroke| &stroke.rows)
    }
}

/// Leaves out the rows whose time is unknown, unless that is unknown of all; returns their number. Fails if they are
/// many.
pub(super) fn with_times(mut rows: Vec<Row>) -> Result<(Vec<Row>, usize), FitError> {
    let (count, is_timeless) = (rows.len(), |row: &&Row| row.time_s.is_none());
    let unknown = rows.iter().filter(is_timeless).count();
    let Some(first) = rows.iter().find(is_timeless).filter(|_| unknown < count) else { return Ok((rows, 0)) };
    if unknown as f64 > TIMELESS_PART * count as f64 {
        return Err(FitError::Refused(format!(
            "{unknown} of {count} rows have no time, the first of them row {}, too many to leave out: give each its \
             time in column time_s, or leave the column out",
            first.number
        )));
    }
    rows.retain(|row| row.time_s.is_some());
    Ok((rows, unknown))
}

fn divided(rows: Vec<Row>, has_time: bool) -> Result<(Division, Vec<Stroke>), FitError> {
    if rows.iter().any(|row| row.stroke.is_some()) {
        let strokes = by(rows, |before, row| before.stroke != row.stroke);
        let strokes = strokes.into_iter().filter(|stroke| stroke.rows.iter().all(|row| row.stroke.is_some()));
        let strokes: Vec<Vec<Stroke>> = strokes.map(|stroke| turned(stroke, has_time)).collect::<Result<_, _>>()?;
        return Ok((Division::Column, strokes.concat()));
    }
    let count = rows.len();
    let gap_s = if has_time { GAP_S.max(GAP_INTERVALS * usual_interval_s(rows.iter())) } else { f64::INFINITY };
    let is_still = |row: &Row| row.speed_mm_s.is_some_and(|speed| speed.abs() < STILL_MM_S);
    let is_next = |before: &Row, row: &Row| {
        let paused = row.time_s.zip(before.time_s).is_some_and(|(now_s, then_s)| now_s - then_s > gap_s);
        paused || (is_still(before) && !is_still(row))
    };
    let strokes = by(rows.clone(), is_next).into_iter().flat_map(|stroke| pieces(stroke.rows)).zip(1..);
    let strokes = strokes.map(|(rows, number)| Stroke { name: number.to_string(), rows });
    let strokes: Vec<Stroke> = strokes.filter(|stroke| !stroke.is_short()).collect();
    if strokes.len() > 2 {
        return Ok((Division::Motion, strokes));
    }
    let needed = BLOCKS * BLOCK_ROWS;
    if count < needed {
        let (rows, are) = if count == 1 { ("row", "is") } else { ("rows", "are") };
        return Err(FitError::TooFew(format!(
            "{count} {rows} without a column stroke {are} too few: record at least {needed} rows, or number the strokes in \
             a column stroke"
        )));
    }
    let blocks = rows.chunks(count.div_ceil(BLOCKS)).enumerate();
    let blocks = blocks.map(|(index, rows)| Stroke { name: (index + 1).to_string(), rows: rows.to_vec() });
    Ok((Division::Blocks, blocks.collect()))
}

/// Divides a stroke of the column where the finger turns. Fails without times: rows around a turn are not steady
/// sliding.
fn turned(stroke: Stroke, has_time: bool) -> Result<Vec<Stroke>, FitError> {
    let name = stroke.name;
    let pieces = pieces(stroke.rows).into_iter().map(|rows| Stroke { name: name.clone(), rows });
    let mut pieces: Vec<Stroke> = pieces.collect();
    if let Some(row) = pieces.get(1).and_then(|piece| piece.rows.first()).filter(|_| !has_time) {
        return Err(FitError::Refused(format!(
            "row {}: the finger turns within stroke {}, where friction or speed changes its sign: add a column time_s, \
             so that rows around the turn are left out, or give each direction its own stroke",
            row.number,
            brief(&name)
        )));
    }
    // What is short lies around a turn.
    let longest = pieces.iter().map(|piece| piece.rows.len()).max();
    let is_all_short = pieces.iter().all(Stroke::is_short);
    pieces.retain(|piece| if is_all_short { Some(piece.rows.len()) == longest } else { !piece.is_short() });
    Ok(pieces)
}

/// Divides rows where `is_next` finds that a row begins the next stroke.
fn by(rows: Vec<Row>, is_next: impl Fn(&Row, &Row) -> bool) -> Vec<Stroke> {
    let mut strokes: Vec<Stroke> = Vec::new();
    for row in rows {
        match strokes.last_mut() {
            Some(stroke) if stroke.rows.last().is_some_and(|before| !is_next(before, &row)) => stroke.rows.push(row),
            _ => {
                let name = row.stroke.clone().unwrap_or_else(|| (strokes.len() + 1).to_string());
                strokes.push(Stroke { name, rows: vec![row] });
            }
        }
    }
    strokes
}

/// Median time from one row to the next; not-a-number without times.
pub(super) fn usual_interval_s<'r>(rows: impl Iterator<Item = &'r Row> + Clone) -> f64 {
    let times = rows.filter_map(|row| row.time_s);
    median(times.clone().zip(times.skip(1)).map(|(one, other)| (other - one).abs()))
}

/// Fails if time goes backwards; where a stroke begins, its clock may begin anew.
fn check_time(rows: &[Row]) -> Result<(), FitError> {
    for (before, row) in rows.iter().zip(rows.iter().skip(1)) {
        if let (Some(then_s), Some(now_s)) = (before.time_s, row.time_s)
            && now_s < then_s
            && before.stroke == row.stroke
        {
            return Err(FitError::Refused(format!(
                "row {}, column time_s: {now_s} s follows {then_s} s, so time goes backwards: sort the rows by time, \
                 or number the strokes in a column stroke if each has a clock of its own",
                row.number
            )));
        }
    }
    Ok(())
}

fn left(strokes: Vec<Stroke>, without: &[String]) -> Result<Vec<Stroke>, FitError> {
    if let Some(stroke) = without.iter().find(|name| !strokes.iter().any(|stroke| stroke.name == **name)) {
        let [first, last] = [strokes.first(), strokes.last()].map(|end| end.map_or("", |stroke| &stroke.name));
        return Err(FitError::Refused(format!(
            "--without {}: there is no such stroke; the column stroke has {} to {}",
            brief(stroke),
            brief(first),
            brief(last)
        )));
    }
    Ok(strokes.into_iter().filter(|stroke| !without.contains(&stroke.name)).collect())
}

/// Drops start, turn, and rows of a wrong speed; gives friction a positive sign.
fn trimmed(mut stroke: Stroke, division: Division) -> Result<Stroke, StrokeDefect> {
    // A block of rows neither begins nor ends with a turn.
    if division != Division::Blocks
        && let (Some(first_s), Some(duration_s)) = (stroke.rows.first().and_then(|row| row.time_s), stroke.duration_s())
    {
        if duration_s < STROKE_MIN_S {
            return Err(StrokeDefect::Short { found: format!("{duration_s:.3} s") });
        }
        let kept_s = first_s + START_S..=first_s + duration_s - END_S;
        stroke.rows.retain(|row| row.time_s.is_some_and(|time_s| kept_s.contains(&time_s)));
    }
    let count = stroke.rows.len();
    if count < KEPT_ROWS {
        return Err(StrokeDefect::Short { found: format!("{count} rows of steady sliding") });
    }
    let speeds_mm_s = stroke.rows.iter().filter_map(|row| row.speed_mm_s).map(f64::abs);
    if speeds_mm_s.clone().next().is_some() {
        let speed_mm_s = median(speeds_mm_s);
        if speed_mm_s < STILL_MM_S {
            return Err(StrokeDefect::NoSlip { found: format!("its speed is {speed_mm_s:.1} mm/s") });
        }
        if !SPEEDS_MM_S.contains(&speed_mm_s) {
            return Err(StrokeDefect::Speed { speed_mm_s });
        }
        stroke.rows.retain(|row| row.speed_mm_s.is_none_or(|speed| SPEEDS_MM_S.contains(&speed.abs())));
    }
    let sign = if stroke.median(|row| row.friction_n) < 0.0 { -1.0 } else { 1.0 };
    for row in &mut stroke.rows {
        row.friction_n *= sign;
    }
    Ok(stroke)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::zero::taken_from;
    use super::{Defects, Recording, Row};

    /// Rows of a finger that slides one way, a thousand a second, from a time on.
    fn slide(rows: &mut Vec<Row>, count: usize, start_s: f64, sign: f64, speed_mm_s: Option<f64>) {
        for index in 0..count {
            // What differs from row to row, as noise does.
            let noise = ((rows.len() as f64 * 0.618_034).fract() - 0.5) * 0.02;
            rows.push(Row {
                number: rows.len() as u64 + 2,
                voltage_v_rms: if index / 25 % 2 == 0 { 0.0 } else { 150.0 },
                normal_force_n: 0.5 + noise,
                friction_n: sign * (0.25 - 3.0 * noise),
                time_s: Some(start_s + 1e-3 * index as f64),
                stroke: None,
                speed_mm_s,
                is_simulated: false,
            });
        }
    }

    fn named(rows: &[Row], name: impl Fn(usize) -> String) -> Vec<Row> {
        let name = |(index, row): (usize, &Row)| Row { stroke: Some(name(index)), ..row.clone() };
        rows.iter().enumerate().map(name).collect()
    }

    /// The numbers of the rows of each stroke.
    fn strokes(rows: Vec<Row>) -> Vec<Vec<u64>> {
        let recording = Recording::new(rows, &[], &mut Defects::default()).unwrap();
        recording.strokes.iter().map(|stroke| stroke.rows.iter().map(|row| row.number).collect()).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// A column that has one name for several directions gives the strokes of one that has a name for each.
        #[test]
        fn a_stroke_that_turns_is_that_of_its_pieces(
            pieces in prop::collection::vec((120_usize..900, 0.001_f64..0.4), 1..6),
            group in 1_usize..6,
            shows in 0_usize..3,
        ) {
            let (mut rows, mut piece_of, mut time_s, mut sign) = (Vec::new(), Vec::new(), 0.0, 1.0);
            for (piece, (count, pause_s)) in pieces.iter().enumerate() {
                let (friction, speed) = [(sign, None), (sign, Some(60.0 * sign)), (1.0, Some(60.0 * sign))][shows];
                slide(&mut rows, *count, time_s, friction, speed);
                piece_of.resize(rows.len(), piece);
                time_s += 1e-3 * *count as f64 + pause_s;
                sign = -sign;
            }
            let divided = strokes(named(&rows, |index| piece_of[index].to_string()));
            prop_assert_eq!(strokes(named(&rows, |index| (piece_of[index] / group).to_string())), divided);
        }

        /// The offset of an untared sensor is subtracted again.
        #[test]
        fn a_constant_of_the_sensor_changes_no_row_in_contact(
            load_n in -0.4_f64..2.0,
            friction_n in -0.4_f64..0.4,
            rest in 320_usize..600,
            lifts in 1_usize..4,
        ) {
            let mut rows = Vec::new();
            for lift in 0..lifts {
                let (first, start_s) = (rows.len(), 10.0 * lift as f64);
                slide(&mut rows, rest, start_s, 0.0, Some(0.0));
                for row in rows.iter_mut().skip(first) {
                    row.normal_force_n -= 0.5;
                }
                slide(&mut rows, 1400, start_s + 1e-3 * rest as f64, 1.0, Some(60.0));
            }
            let (tared, _) = taken_from(rows.clone());
            let untared = rows.into_iter().map(|row| Row {
                normal_force_n: row.normal_force_n + load_n,
                friction_n: row.friction_n + friction_n,
                ..row
            });
            let (found, zero) = taken_from(untared.collect());
            let zero = zero.unwrap();
            prop_assert!((zero.normal_force_n - load_n).abs() < 2e-3 && (zero.friction_n - friction_n).abs() < 2e-3);
            prop_assert_eq!(found.len(), 1400 * lifts);
            for (one, other) in found.iter().zip(&tared) {
                prop_assert!((one.normal_force_n - other.normal_force_n).abs() < 1e-9);
                prop_assert!((one.friction_n - other.friction_n).abs() < 1e-9);
            }
        }

        /// Sliding alone shows no zero, however its load wanders.
        #[test]
        fn a_finger_in_contact_is_no_zero(swing in 0.0_f64..0.3, period in 0.3_f64..20.0) {
            let mut rows = Vec::new();
            slide(&mut rows, 20_000, 0.0, 1.0, None);
            for row in &mut rows {
                let load = 1.0 + swing * libm::sin(core::f64::consts::TAU * row.time_s.unwrap() / period);
                (row.normal_force_n, row.friction_n) = (row.normal_force_n * load, row.friction_n * load);
            }
            prop_assert_eq!(taken_from(rows.clone()), (rows, None));
        }
    }
}
