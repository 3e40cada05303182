//! Means of strokes: the friction added by the drive, compared with the friction just before and just after.
//!
//! Natural friction wanders: its noise grows towards low frequencies, and it follows the load. Comparing each phase
//! with the drive on with the phases around it cancels everything slower than the envelope.

use super::least_squares::{Measured, Observation};
use super::recording::{Recording, Stroke};
use super::table::Row;
use crate::statistics::{mean, median};

/// Voltages within this factor of the lowest one of a level are one level.
pub(super) const LEVEL_WIDTH: f64 = 1.05;
/// Fraction of the highest voltage below which the drive counts as off.
const OFF_SHARE: f64 = 0.02;
/// Smallest change of the voltage that is not noise, as a fraction of a stroke's highest voltage.
const REST_SHARE: f64 = 0.2;
/// Least number of rows that are left of a phase without its edges.
const SETTLED_ROWS_MIN: usize = 2;

/// Rows next to each switch of the drive that are left out, because their friction is in transition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edges {
    /// After a switch.
    pub(super) after: Edge,
    /// Before a switch.
    pub(super) before: Edge,
}

/// How far an edge reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    /// In seconds, where rows have times.
    pub(super) duration_s: f64,
    /// As a share of the usual phase, where rows have no times.
    pub(super) share: f64,
}

impl Edges {
    /// The edges that every fit leaves out.
    ///
    /// Friction follows the voltage with a relaxation length of 11.5 um (arXiv 2505.11162), 0.6 ms at 20 mm/s. Clocks
    /// may differ by 1 ms. A row may be a mean over a time that ends after the switch, with the friction of both
    /// voltages and the voltage of one.
    pub(super) const USED: Self =
        Self { after: Edge { duration_s: 5e-3, share: 0.25 }, before: Edge { duration_s: 2e-3, share: 0.1 } };
}

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

    /// Mean time for which the voltage rests while the drive is on, in rows, and in seconds if the rows have times. A
    /// change counts from a fifth of the stroke's highest voltage.
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

/// A phase of the drive: consecutive rows of a stroke at one level, with their places in it.
pub(super) struct Run<'r> {
    pub(super) level: Option<usize>,
    pub(super) rows: Vec<(usize, &'r Row)>,
    /// Time at which the voltage changes after the last row; `None` at the end of the stroke and without times.
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

    /// The rows without edges, which reach over `rows` after and before a switch where rows have no times.
    fn settled(&self, edges: &Edges, rows: (usize, usize)) -> Vec<(usize, &'r Row)> {
        let Some(start_s) = self.starts_s() else {
            return self.rows.iter().take(self.rows.len().saturating_sub(rows.1)).skip(rows.0).copied().collect();
        };
        let has_settled = |row: &Row| {
            row.time_s.is_none_or(|time_s| {
                time_s >= start_s + edges.after.duration_s
                    && self.change_s.is_none_or(|change_s| time_s < change_s - edges.before.duration_s)
            })
        };
        // The voltage changes after the last row and before the next one, wherever that is.
        let count = self.rows.len() - usize::from(self.change_s.is_some());
        self.rows.iter().take(count).filter(|(_, row)| has_settled(row)).copied().collect()
    }
}

/// The phases of the drive in each stroke of a recording.
pub(super) struct Phases<'r> {
    pub(super) strokes: Vec<(&'r Stroke, Vec<Run<'r>>)>,
    /// Median number of rows from one switch to the next.
    usual_rows: f64,
}

impl<'r> Phases<'r> {
    pub(super) fn of(recording: &'r Recording, levels: &Levels) -> Self {
        let strokes: Vec<_> = recording.strokes.iter().map(|stroke| (stroke, runs(stroke, levels))).collect();
        let usual_rows = median(switched(&strokes).map(|run| run.rows.len() as f64));
        Self { strokes, usual_rows }
    }

    pub(super) fn rows(&self) -> impl Iterator<Item = &'r Row> + Clone {
        self.strokes.iter().flat_map(|(stroke, _)| &stroke.rows)
    }

    /// Median number of rows from one switch to the next, if most phases are too short to leave their edges out.
    pub(super) fn unresolved_rows(&self) -> Option<f64> {
        let settled = switched(&self.strokes).map(|run| self.settled(run, &Edges::USED).len());
        let (count, short) =
            settled.fold((0, 0), |(count, short), rows| (count + 1, short + usize::from(rows < SETTLED_ROWS_MIN)));
        (2 * short > count).then_some(self.usual_rows)
    }

    /// The means of each stroke, without edges.
    pub(super) fn means(&self, edges: &Edges) -> Vec<StrokeMeans> {
        let means = |(stroke, runs): &(&Stroke, Vec<Run<'r>>)| {
            let is_switched = runs.len() > 1;
            let used = runs.iter().map(|run| {
                let rows = if is_switched { self.settled(run, edges) } else { run.rows.clone() };
                (run.level, rows)
            });
            let least = if is_switched { SETTLED_ROWS_MIN } else { 1 };
            let segments: Vec<_> =
                used.filter(|(_, rows)| rows.len() >= least).map(|(level, rows)| segment(level, &rows)).collect();
            means_of(&stroke.name, &segments)
        };
        self.strokes.iter().map(means).collect()
    }

    fn settled(&self, run: &Run<'r>, edges: &Edges) -> Vec<(usize, &'r Row)> {
        let rows = |edge: Edge| (edge.share * self.usual_rows).ceil() as usize;
        run.settled(edges, (rows(edges.after), rows(edges.before)))
    }
}

/// The phases of strokes in which the drive is switched.
fn switched<'s, 'r>(strokes: &'s [(&Stroke, Vec<Run<'r>>)]) -> impl Iterator<Item = &'s Run<'r>> {
    strokes.iter().filter(|(_, runs)| runs.len() > 1).flat_map(|(_, runs)| runs)
}

fn means_of(name: &str, segments: &[Segment]) -> StrokeMeans {
    let off: Vec<&Segment> = segments.iter().filter(|segment| segment.level.is_none()).collect();
    let natural = observation(&off, None);
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
fn runs<'r>(stroke: &'r Stroke, levels: &Levels) -> Vec<Run<'r>> {
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

/// Mean of a quantity over segments, weighted by their numbers of rows.
fn weighted<'s>(segments: impl Iterator<Item = (&'s Segment, f64)>) -> f64 {
    let (sum, rows) =
        segments.fold((0.0, 0.0), |(sum, rows), (segment, value)| (sum + segment.rows * value, rows + segment.rows));
    sum / rows
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
