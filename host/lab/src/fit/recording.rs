//! Divides rows into strokes, and drops what is no steady sliding.

use super::error::FitError;
use super::faults::{Fault, Faults};
use super::table::Row;
use crate::statistics::median;

/// What is dropped at the beginning of a stroke, in seconds: the finger starts to slide.
const START_S: f64 = 0.15;
/// What is dropped at the end of a stroke, in seconds: the finger turns.
const END_S: f64 = 0.05;
/// Least duration of a stroke, in seconds, of which 0.2 s are left.
const SHORTEST_S: f64 = START_S + 0.2 + END_S;
/// Least number of rows that are left of a stroke.
const KEPT_ROWS: usize = 5;
/// Speeds at which the lag of friction was measured, in mm/s (arXiv 2505.11162).
const SPEEDS_MM_S: core::ops::RangeInclusive<f64> = 20.0..=100.0;
/// A finger slower than this, in mm/s, turns or stands still.
const STILL_MM_S: f64 = 5.0;
/// A gap in time of this many usual intervals, but at least [`GAP_S`], divides two strokes.
const GAP_INTERVALS: f64 = 10.0;
/// See [`GAP_INTERVALS`], in seconds.
const GAP_S: f64 = 0.05;
/// Number of blocks of rows that stand in for strokes where nothing says where strokes begin.
const BLOCKS: usize = 24;
/// Least number of rows in such a block.
const BLOCK_ROWS: usize = 5;

/// How the rows were divided into strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// Divides rows into strokes, leaves out those that are named in `without` and those with faults, and drops starts
    /// and turns.
    pub(super) fn new(rows: Vec<Row>, without: &[String], faults: &mut Faults) -> Result<Self, FitError> {
        let has_time = rows.iter().all(|row| row.time_s.is_some());
        let has_speed = rows.iter().all(|row| row.speed_mm_s.is_some());
        check_time(&rows)?;
        let (division, strokes) = divided(rows, has_time)?;
        let strokes = left(strokes, without)?;
        let trimmed = strokes.into_iter().map(|stroke| (stroke.name.clone(), trimmed(stroke, division)));
        let strokes =
            trimmed.filter_map(|(name, stroke)| stroke.map_err(|fault| faults.push(&name, fault)).ok()).collect();
        Ok(Self { strokes, division, has_time, has_speed })
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = &Row> + Clone {
        self.strokes.iter().flat_map(|stroke| &stroke.rows)
    }
}

fn divided(rows: Vec<Row>, has_time: bool) -> Result<(Division, Vec<Stroke>), FitError> {
    let count = rows.len();
    if rows.first().is_some_and(|row| row.stroke.is_some()) {
        return Ok((Division::Column, by(rows, |before, row| before.stroke != row.stroke)));
    }
    let gap_s = if has_time { GAP_S.max(GAP_INTERVALS * usual_interval_s(rows.iter())) } else { f64::INFINITY };
    let is_still = |row: &Row| row.speed_mm_s.is_some_and(|speed| speed.abs() < STILL_MM_S);
    let is_next = |before: &Row, row: &Row| {
        let turned = before.friction_n * row.friction_n < 0.0
            || before.speed_mm_s.zip(row.speed_mm_s).is_some_and(|(one, other)| one * other < 0.0);
        let paused = row.time_s.zip(before.time_s).is_some_and(|(now_s, then_s)| now_s - then_s > gap_s);
        turned || paused || (is_still(before) && !is_still(row))
    };
    let mut strokes = by(rows.clone(), is_next);
    // What is short lies around a turn, where speed and friction change sign more than once.
    strokes.retain(|stroke| {
        stroke.rows.len() >= KEPT_ROWS && stroke.duration_s().is_none_or(|duration_s| duration_s >= SHORTEST_S)
    });
    if strokes.len() > 2 {
        return Ok((Division::Motion, strokes));
    }
    let needed = BLOCKS * BLOCK_ROWS;
    if count < needed {
        return Err(FitError::TooFewRows { found: count, needed });
    }
    let blocks = rows.chunks(count.div_ceil(BLOCKS)).enumerate();
    let blocks = blocks.map(|(index, rows)| Stroke { name: (index + 1).to_string(), rows: rows.to_vec() });
    Ok((Division::Blocks, blocks.collect()))
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
            return Err(FitError::TimeBackwards { row: row.number, found: now_s, before: then_s });
        }
    }
    Ok(())
}

fn left(strokes: Vec<Stroke>, without: &[String]) -> Result<Vec<Stroke>, FitError> {
    if let Some(stroke) = without.iter().find(|name| !strokes.iter().any(|stroke| stroke.name == **name)) {
        let name = |stroke: Option<&Stroke>| stroke.map(|stroke| stroke.name.clone()).unwrap_or_default();
        let (first, last) = (name(strokes.first()), name(strokes.last()));
        return Err(FitError::NoSuchStroke { stroke: stroke.clone(), first, last });
    }
    Ok(strokes.into_iter().filter(|stroke| !without.contains(&stroke.name)).collect())
}

/// Drops start, turn, and rows of a wrong speed; gives friction a positive sign.
fn trimmed(mut stroke: Stroke, division: Division) -> Result<Stroke, Fault> {
    // A block of rows neither begins nor ends with a turn.
    if division != Division::Blocks
        && let (Some(first_s), Some(duration_s)) = (stroke.rows.first().and_then(|row| row.time_s), stroke.duration_s())
    {
        if duration_s < SHORTEST_S {
            return Err(Fault::Short { found: format!("{duration_s:.3} s") });
        }
        let kept_s = first_s + START_S..=first_s + duration_s - END_S;
        stroke.rows.retain(|row| row.time_s.is_some_and(|time_s| kept_s.contains(&time_s)));
    }
    let count = stroke.rows.len();
    if count < KEPT_ROWS {
        return Err(Fault::Short { found: format!("{count} rows of steady sliding") });
    }
    if stroke.rows.iter().all(|row| row.speed_mm_s.is_some()) {
        let speed_mm_s = stroke.median(|row| row.speed_mm_s.unwrap_or_default().abs());
        if speed_mm_s < STILL_MM_S {
            return Err(Fault::NoSlip { found: format!("its speed is {speed_mm_s:.1} mm/s") });
        }
        if !SPEEDS_MM_S.contains(&speed_mm_s) {
            return Err(Fault::Speed { speed_mm_s });
        }
        stroke.rows.retain(|row| row.speed_mm_s.is_some_and(|speed| SPEEDS_MM_S.contains(&speed.abs())));
    }
    let sign = if stroke.median(|row| row.friction_n) < 0.0 { -1.0 } else { 1.0 };
    for row in &mut stroke.rows {
        row.friction_n *= sign;
    }
    Ok(stroke)
}
