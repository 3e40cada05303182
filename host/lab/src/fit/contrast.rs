//! From strokes to means: what the drive adds, compared with the friction just before and just after.
//!
//! Natural friction wanders: its noise grows towards low frequencies, and it follows the load. Comparing each time that
//! the drive is on with the times off around it cancels what is slower than the envelope.

use super::least_squares::{Measured, Observation};
use super::recording::{Recording, Stroke};
use super::table::Row;
use crate::statistics::mean;

/// Voltages within this factor of the lowest one of a level are one level.
pub(super) const LEVEL_WIDTH: f64 = 1.05;
/// Below this share of the highest voltage the drive is off.
const OFF_SHARE: f64 = 0.02;
/// A change of this share of a stroke's highest voltage is none of noise.
const REST_SHARE: f64 = 0.2;
/// Rows are dropped for this long after the voltage changed, in seconds: friction follows with a relaxation length of
/// 11.5 um (arXiv 2505.11162), 0.6 ms at 20 mm/s, and clocks may differ by 1 ms.
const SETTLING_S: f64 = 5e-3;
/// Rows are dropped for this long before the voltage changes, in seconds: a row may be the mean of a time that ends
/// after the change, and clocks may differ by 1 ms. Such a row has the friction of both voltages, and the voltage of
/// one.
const EDGE_S: f64 = 2e-3;
/// Least number of rows that are left of a segment without its edges. Where most segments of a recording have fewer,
/// the rows are too far apart to tell, and all are used.
const SETTLED_ROWS_MIN: usize = 2;

/// The voltages of a recording, as levels that differ by more than 5 %.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Levels {
    off_below_v_rms: f64,
    /// Lowest and highest voltage of each level, rising.
    levels: Vec<(f64, f64)>,
}

impl Levels {
    pub(super) fn of(recording: &Recording) -> Self {
        let mut voltages: Vec<f64> = recording.rows().map(|row| row.voltage_v_rms).collect();
        voltages.sort_by(f64::total_cmp);
        let off_below_v_rms = OFF_SHARE * voltages.last().copied().unwrap_or_default();
        let mut levels: Vec<(f64, f64)> = Vec::new();
        for voltage in voltages.into_iter().filter(|voltage| *voltage > off_below_v_rms) {
            match levels.last_mut() {
                Some((low, high)) if voltage <= *low * LEVEL_WIDTH => *high = voltage,
                _ => levels.push((voltage, voltage)),
            }
        }
        Self { off_below_v_rms, levels }
    }

    /// Number of a voltage's level; `None` while the drive is off.
    fn level(&self, voltage_v_rms: f64) -> Option<usize> {
        if voltage_v_rms <= self.off_below_v_rms {
            return None;
        }
        Some(self.levels.partition_point(|(_, high)| *high < voltage_v_rms))
    }

    /// How long the voltage rests, on average, before it changes by a fifth of the highest one of its stroke, while the
    /// drive is on: in rows, and in seconds if the rows have times.
    pub(super) fn rest(&self, recording: &Recording) -> (f64, Option<f64>) {
        let (mut rows, mut rests, mut duration_s) = (0.0, 0.0, Some(0.0));
        for stroke in &recording.strokes {
            let highest_v_rms = stroke.rows.iter().map(|row| row.voltage_v_rms).fold(0.0, f64::max);
            let mut rests_at_v_rms = f64::NEG_INFINITY;
            for (row, next) in stroke.rows.iter().zip(stroke.rows.iter().skip(1)) {
                if self.level(row.voltage_v_rms).is_none() {
                    continue;
                }
                if (row.voltage_v_rms - rests_at_v_rms).abs() > REST_SHARE * highest_v_rms {
                    rests_at_v_rms = row.voltage_v_rms;
                    rests += 1.0;
                }
                rows += 1.0;
                let interval_s = next.time_s.zip(row.time_s).map(|(next_s, time_s)| next_s - time_s);
                duration_s = duration_s.zip(interval_s).map(|(sum_s, interval_s)| sum_s + interval_s);
            }
        }
        (rows / rests, duration_s.map(|duration_s| duration_s / rests))
    }

    /// Lowest and highest voltage at which the drive is on, in volts rms.
    pub(super) fn range_v_rms(&self) -> Option<(f64, f64)> {
        Some((self.levels.first()?.0, self.levels.last()?.1))
    }
}

/// The means of one stroke.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StrokeMeans {
    pub(super) name: String,
    pub(super) observations: Vec<Observation>,
    /// Friction over load while the drive is off.
    pub(super) natural_coefficient: Option<f64>,
    /// The highest level of the stroke: strokes of one level are drawn from together.
    pub(super) top_level: Option<usize>,
}

/// Consecutive rows of one level.
struct Segment {
    level: Option<usize>,
    /// Time in seconds, or the number of the row where there is no time.
    centre: f64,
    voltage_v_rms: f64,
    load_n: f64,
    friction_n: f64,
    rows: f64,
}

/// Consecutive rows of a stroke at one level, with their places in it.
pub(super) struct Run<'r> {
    pub(super) level: Option<usize>,
    pub(super) rows: Vec<(usize, &'r Row)>,
    /// When the voltage changes after the last row; `None` at the end of the stroke and without times.
    change_s: Option<f64>,
}

impl<'r> Run<'r> {
    /// Time of the first row; `None` without times.
    pub(super) fn starts_s(&self) -> Option<f64> {
        self.rows.first()?.1.time_s
    }

    /// Time from the first to the last row; 0 without times.
    pub(super) fn lasts_s(&self) -> f64 {
        let last_s = self.rows.last().and_then(|(_, row)| row.time_s);
        last_s.zip(self.starts_s()).map_or(0.0, |(last_s, first_s)| last_s - first_s)
    }

    /// The rows without those near a change of the voltage; all of them without times.
    fn settled(&self) -> Vec<(usize, &'r Row)> {
        let start_s = self.starts_s();
        let has_settled = |row: &Row| {
            row.time_s.is_none_or(|time_s| {
                start_s.is_none_or(|start_s| time_s >= start_s + SETTLING_S)
                    && self.change_s.is_none_or(|change_s| time_s < change_s - EDGE_S)
            })
        };
        // The voltage changes after the last row and before the next one, wherever that is.
        let count = self.rows.len() - usize::from(self.change_s.is_some());
        self.rows.iter().take(count).filter(|(_, row)| has_settled(row)).copied().collect()
    }
}

/// The means of each stroke.
pub(super) fn stroke_means(recording: &Recording, levels: &Levels) -> Vec<StrokeMeans> {
    let runs: Vec<Vec<Run>> = recording.strokes.iter().map(|stroke| runs(stroke, levels)).collect();
    let settled = runs.iter().flatten().filter(|run| run.settled().len() >= SETTLED_ROWS_MIN).count();
    let has_edges = 2 * settled > runs.iter().map(Vec::len).sum::<usize>();
    let strokes = recording.strokes.iter().zip(&runs);
    strokes.map(|(stroke, runs)| means_of(&stroke.name, &segments(runs, has_edges))).collect()
}

fn means_of(name: &str, segments: &[Segment]) -> StrokeMeans {
    let natural = natural_friction(segments);
    let mut observations: Vec<Observation> = natural.into_iter().collect();
    let mut present: Vec<usize> = segments.iter().filter_map(|segment| segment.level).collect();
    present.sort_unstable();
    present.dedup();
    for level in &present {
        observations.extend(at_level(segments, *level, natural.is_some()));
    }
    StrokeMeans {
        name: name.to_owned(),
        observations,
        natural_coefficient: natural.and_then(|natural| match natural.measured {
            Measured::Friction(friction_n) => Some(friction_n / natural.normal_load_n),
            Measured::Attraction(_) => None,
        }),
        top_level: present.last().copied(),
    }
}

/// Divides a stroke into runs of one level.
pub(super) fn runs<'r>(stroke: &'r Stroke, levels: &Levels) -> Vec<Run<'r>> {
    let mut runs: Vec<Run> = Vec::new();
    for (index, row) in stroke.rows.iter().enumerate() {
        let level = levels.level(row.voltage_v_rms);
        match runs.last_mut() {
            Some(run) if run.level == level => run.rows.push((index, row)),
            before => {
                if let Some(before) = before {
                    before.change_s = row.time_s;
                }
                runs.push(Run { level, rows: vec![(index, row)], change_s: None });
            }
        }
    }
    runs
}

/// The means of runs, without their edges if there are rows enough; a run that is nothing but edges is left out.
fn segments(runs: &[Run], has_edges: bool) -> Vec<Segment> {
    let used = runs.iter().map(|run| (run.level, if has_edges { run.settled() } else { run.rows.clone() }));
    let least = if has_edges { SETTLED_ROWS_MIN } else { 1 };
    used.filter(|(_, rows)| rows.len() >= least).map(|(level, rows)| segment(level, &rows)).collect()
}

fn segment(level: Option<usize>, used: &[(usize, &Row)]) -> Segment {
    let over = |value: &dyn Fn(usize, &Row) -> f64| mean(used.iter().map(|(index, row)| value(*index, row)));
    Segment {
        level,
        centre: over(&|index, row| row.time_s.unwrap_or(index as f64)),
        voltage_v_rms: over(&|_, row| row.voltage_v_rms),
        load_n: over(&|_, row| row.normal_force_n),
        friction_n: over(&|_, row| row.friction_n),
        rows: used.len() as f64,
    }
}

/// The mean of a quantity over segments, each counted by its rows.
fn weighted<'s>(segments: impl Iterator<Item = (&'s Segment, f64)>) -> f64 {
    let (sum, rows) =
        segments.fold((0.0, 0.0), |(sum, rows), (segment, value)| (sum + segment.rows * value, rows + segment.rows));
    sum / rows
}

fn natural_friction(segments: &[Segment]) -> Option<Observation> {
    observation(&segments.iter().filter(|segment| segment.level.is_none()).collect::<Vec<_>>(), None)
}

/// The mean of segments: their friction, or else the attractions that are given.
fn observation(segments: &[&Segment], attractions_n: Option<&[f64]>) -> Option<Observation> {
    let over = |value: &dyn Fn(&Segment) -> f64| weighted(segments.iter().map(|segment| (*segment, value(segment))));
    let rows: f64 = segments.iter().map(|segment| segment.rows).sum();
    let measured = match attractions_n {
        None => Measured::Friction(over(&|segment| segment.friction_n)),
        Some(attractions_n) => {
            Measured::Attraction(weighted(segments.iter().copied().zip(attractions_n.iter().copied())))
        }
    };
    let is_off = segments.first()?.level.is_none();
    Some(Observation {
        voltage_v_rms: if is_off { 0.0 } else { over(&|segment| segment.voltage_v_rms) },
        normal_load_n: over(&|segment| segment.load_n),
        measured,
        weight: rows.sqrt(),
    })
}

fn at_level(segments: &[Segment], level: usize, has_natural: bool) -> Option<Observation> {
    let at_level = || segments.iter().enumerate().filter(|(_, segment)| segment.level == Some(level));
    if !has_natural {
        return observation(&at_level().map(|(_, segment)| segment).collect::<Vec<_>>(), None);
    }
    let compared = |both_sides: bool| -> Vec<(&Segment, f64)> {
        at_level()
            .filter_map(|(index, segment)| {
                let coefficient = coefficient_at(segments, index, both_sides)?;
                Some((segment, segment.friction_n / coefficient - segment.load_n))
            })
            .collect()
    };
    let mut pairs = compared(true);
    if pairs.is_empty() {
        pairs = compared(false);
    }
    let (chosen, attractions_n): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
    observation(&chosen, Some(&attractions_n))
}

/// Friction over load while the drive is off, interpolated from the nearest segments before and after to the centre of
/// segment `index`; from one of them alone if `both_sides` is false.
fn coefficient_at(segments: &[Segment], index: usize, both_sides: bool) -> Option<f64> {
    let centre = segments.get(index)?.centre;
    let is_off = |segment: &&Segment| segment.level.is_none();
    let before = segments.get(..index)?.iter().rev().find(is_off);
    let after = segments.get(index..)?.iter().find(is_off);
    let coefficient = |segment: &Segment| segment.friction_n / segment.load_n;
    match (before, after) {
        (Some(before), Some(after)) => {
            let part = (centre - before.centre) / (after.centre - before.centre);
            Some(coefficient(before) + part * (coefficient(after) - coefficient(before)))
        }
        (Some(one), None) | (None, Some(one)) if !both_sides => Some(coefficient(one)),
        _ => None,
    }
}
