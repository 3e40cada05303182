//! The plan of a sweep, a TOML file.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use frixel_hil_sim::TouchConfig;
use frixel_scene::{FileKind, Lines, Nearest, brief, check_toml};
use serde::{Deserialize, Serialize};
use thiserror::Error;
use toml::de::DeTable;

use super::parameter::Value;
use crate::GeneratedStroke;
use crate::score::TrialPlan;

/// Most cells of a plan.
const CELLS_MAX: usize = 1_000_000;

/// Most parts of a parameter's path.
const PATH_PARTS_MAX: usize = 64;

/// Defines the cells: every combination of the values of the lists.
///
/// ```
/// use frixel_lab::sweep::Plan;
///
/// let plan = Plan::parse(
///     "scenes = [\"bars.toml\"]\npeople = 40\n[parameters]\n\"layer.1.high_n\" = { from = 0.01, to = 0.03, count = 3
/// }\n",
///     "plan.toml",
/// )?;
/// assert_eq!((plan.people, plan.parameters["layer.1.high_n"].values().len()), (40, 3));
/// # Ok::<(), frixel_lab::sweep::PlanError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Scene files.
    pub scenes: Vec<String>,
    /// Files of screens, or names of bundled ones, in place of the scenes' own.
    #[serde(default)]
    pub screens: Vec<String>,
    /// Files of touch sources, or names of bundled ones.
    #[serde(default = "slowest_touch")]
    pub touch: Vec<String>,
    /// Number of simulated people, from the first one.
    pub people: u64,
    /// Kind of their strokes.
    #[serde(default)]
    pub stroke: GeneratedStroke,
    /// Strokes of each person.
    #[serde(default = "strokes")]
    pub strokes: u64,
    /// Repetitions of each stroke.
    #[serde(default = "seeds")]
    pub seeds: u64,
    /// Duration of a stroke, s.
    #[serde(default = "seconds")]
    pub seconds: f64,
    /// Median speed of the strokes, mm/s. Without it, each person has their own.
    pub median_speed_mm_per_s: Option<f64>,
    /// Whether the world has no noise, load changes, losses and offsets.
    #[serde(default)]
    pub ideal: bool,
    /// Values of fields of the scenes, by the path of the field: `drive.voltage_max_v_rms`, `layer.2.high_n`.
    #[serde(default)]
    pub parameters: BTreeMap<String, Values>,
    /// Where the fields stand in the file.
    #[serde(skip)]
    pub(super) places: Places,
}

/// Required fields of a plan.
const REQUIRED: [&str; 2] = ["scenes", "people"];
/// Optional fields of a plan.
const OPTIONAL: [&str; 9] =
    ["screens", "touch", "stroke", "strokes", "seeds", "seconds", "median_speed_mm_per_s", "ideal", "parameters"];

/// The names of all fields of a plan.
fn fields() -> impl Iterator<Item = &'static str> {
    REQUIRED.into_iter().chain(OPTIONAL)
}

/// Refuses a plan with an unknown field, without a needed one, or with values that are neither a list nor a range.
fn check_names(plan: &toml::Table, places: &Places) -> Result<(), PlanError> {
    if let Some(unknown) = plan.keys().find(|key| !fields().any(|field| field == key.as_str())) {
        let (place, nearest) = (places.of_field(unknown), Nearest::new(unknown, fields()));
        return Err(PlanError(format!("{place}: the plan has no field `{}`: {nearest}", brief(unknown))));
    }
    if let Some(needed) = REQUIRED.iter().find(|field| !plan.contains_key(**field)) {
        return Err(PlanError(format!("{}: the plan lacks `{needed}`", places.file)));
    }
    let parameters = plan.get("parameters").and_then(toml::Value::as_table);
    for (path, values) in parameters.into_iter().flatten() {
        if let Err(error) = Values::deserialize(values.clone()) {
            return Err(places.refuse_parameter(path, error.message()));
        }
    }
    Ok(())
}

fn slowest_touch() -> Vec<String> {
    vec![TouchConfig::REALISTIC_NAME.to_owned()]
}

fn strokes() -> u64 {
    TrialPlan::STROKES
}

fn seeds() -> u64 {
    TrialPlan::SEEDS
}

fn seconds() -> f64 {
    TrialPlan::SECONDS
}

/// The values of a field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "give a list of values, or { from, to, count }")]
pub enum Values {
    /// These values.
    List(Vec<Value>),
    /// Numbers at equal distances.
    #[serde(untagged)]
    Range(Range),
}

/// Numbers at equal distances.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// The first one.
    pub from: f64,
    /// The last one.
    pub to: f64,
    /// Number of values, at least 2.
    pub count: u32,
}

impl Values {
    /// How many there are.
    fn len(&self) -> usize {
        match self {
            Self::List(values) => values.len(),
            Self::Range(range) => range.count as usize,
        }
    }

    /// The values.
    pub fn values(&self) -> Vec<Value> {
        (0..self.len()).filter_map(|number| self.value(number)).collect()
    }

    fn value(&self, number: usize) -> Option<Value> {
        match self {
            Self::List(values) => values.get(number).cloned(),
            Self::Range(Range { from, to, count }) => {
                // Weighted, so that both ends are exact.
                let part = number as f64 / f64::from(count.saturating_sub(1)).max(1.0);
                Some(Value::Number(from * (1.0 - part) + to * part))
            }
        }
    }
}

/// The first item of a list that is there a second time.
fn repeated<T: Debug>(items: &[T]) -> Option<&T> {
    let mut seen = BTreeSet::new();
    items.iter().find(|item| !seen.insert(format!("{item:?}")))
}

/// Where the fields of a plan stand in its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Places {
    file: String,
    /// Line and column of each field, and of each parameter behind `parameters.`.
    fields: BTreeMap<String, (usize, usize)>,
}

impl Places {
    fn of(text: &str, file: &str) -> Self {
        let plan = DeTable::parse(text).map(toml::Spanned::into_inner).unwrap_or_default();
        let mut fields = BTreeMap::new();
        let lines = Lines::of(text);
        let mut add = |key: String, offset| _ = fields.insert(key, lines.line_and_column(text, offset));
        for (field, value) in &plan {
            add(field.get_ref().to_string(), field.span().start);
            for (path, _) in value.get_ref().as_table().into_iter().flatten() {
                add(format!("{}.{}", field.get_ref(), path.get_ref()), path.span().start);
            }
        }
        Self { file: file.to_owned(), fields }
    }

    /// The place of a field: file, line and column.
    fn of_field(&self, field: &str) -> String {
        match self.fields.get(field) {
            Some((line, column)) => format!("{}:{line}:{column}", self.file),
            None => self.file.clone(),
        }
    }

    /// The place of a parameter.
    pub(super) fn of_parameter(&self, path: &str) -> String {
        self.of_field(&format!("parameters.{path}"))
    }

    /// The error of a parameter.
    pub(super) fn refuse_parameter(&self, path: &str, reason: &str) -> PlanError {
        PlanError(format!("{}: parameter \"{}\": {reason}", self.of_parameter(path), brief(path)))
    }
}

/// Why a plan is invalid, in a sentence that names the file and the field.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct PlanError(pub(super) String);

impl Plan {
    /// Reads the text or the bytes of a plan. Messages call the file `name`.
    pub fn parse(text: impl AsRef<[u8]>, name: &str) -> Result<Self, PlanError> {
        let text = FileKind::Plan.text(text.as_ref(), name).map_err(|error| PlanError(error.to_string()))?;
        let refused = |kind: &str, error: &toml::de::Error| {
            let (line, column) = Lines::of(text).line_and_column(text, error.span().map_or(0, |span| span.start));
            PlanError(format!("{name}:{line}:{column}: {kind}{}", brief(error.message())))
        };
        check_toml(text).map_err(|mistake| PlanError(format!("{name}: {mistake}")))?;
        let table: toml::Table = toml::from_str(text).map_err(|error| refused("this is not TOML: ", &error))?;
        let places = Places::of(text, name);
        check_names(&table, &places)?;
        let plan: Self = toml::from_str(text).map_err(|error| refused("", &error))?;
        let plan = Self { places, ..plan };
        plan.check()?;
        Ok(plan)
    }

    fn check(&self) -> Result<(), PlanError> {
        let refuse_at = |place: String, field: &str, found: String, expected: &str| {
            Err(PlanError(format!("{place}: {} is {}: give {expected}", brief(field), brief(&found))))
        };
        let refuse =
            |field: &str, found: String, expected: &str| refuse_at(self.places.of_field(field), field, found, expected);
        if self.scenes.is_empty() {
            return refuse("scenes", "empty".to_owned(), "the name of one scene file or more");
        }
        if self.touch.is_empty() {
            return refuse("touch", "empty".to_owned(), "100, 200, 500, or the file of a touch source");
        }
        let lists = [("scenes", &self.scenes), ("screens", &self.screens), ("touch", &self.touch)];
        if let Some((field, name)) = lists.iter().find_map(|(field, names)| Some((field, repeated(names)?))) {
            return refuse(field, format!("a list with {name:?} twice"), "each once, since people would count twice");
        }
        if !(1..=CELLS_MAX as u64).contains(&self.people) {
            return refuse("people", self.people.to_string(), &format!("a number from 1 to {CELLS_MAX}"));
        }
        for (field, count) in [("strokes", self.strokes), ("seeds", self.seeds)] {
            if !(1..=TrialPlan::COUNT_MAX).contains(&count) {
                return refuse(field, count.to_string(), &format!("a number from 1 to {}", TrialPlan::COUNT_MAX));
            }
        }
        for (field, what, found, range) in [
            ("seconds", "duration", Some(self.seconds), TrialPlan::SWEEP_SECONDS),
            ("median_speed_mm_per_s", "speed", self.median_speed_mm_per_s, TrialPlan::MEDIAN_SPEEDS_MM_PER_S),
        ] {
            if let Some(found) = found.filter(|found| !range.contains(found)) {
                let expected = format!("a {what} from {} to {}", range.start(), range.end());
                return refuse(field, found.to_string(), &expected);
            }
        }
        let refuse = |path: &str, found: String, expected: &str| {
            refuse_at(self.places.of_parameter(path), path, found, expected)
        };
        for (path, values) in &self.parameters {
            let parts = path.split('.').count();
            if parts > PATH_PARTS_MAX {
                return refuse(path, format!("a path of {parts} parts"), "the path of a field, of at most 64 parts");
            }
            match values {
                Values::List(values) if repeated(values).is_some() => {
                    return refuse(path, "a list with a value twice".to_owned(), "each value once");
                }
                Values::List(values) if values.is_empty() => {
                    return refuse(path, "empty".to_owned(), "a list of values, or { from, to, count }");
                }
                Values::Range(range) if range.from.to_bits() == range.to.to_bits() => {
                    return refuse(path, "a range between equal numbers".to_owned(), "two numbers that differ");
                }
                Values::Range(range) if !(2..=1000).contains(&range.count) => {
                    return refuse(path, format!("a range of {}", range.count), "a count from 2 to 1000");
                }
                _ => {}
            }
        }
        match self.cells() {
            found if found > CELLS_MAX => Err(PlanError(format!(
                "{}: the plan has {found} combinations, and a sweep at most {CELLS_MAX}: split it into several plans",
                self.places.file
            ))),
            _ => Ok(()),
        }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        let sizes = self.parameters.values().map(Values::len);
        let sizes = sizes.chain([self.scenes.len(), self.screens.len().max(1), self.touch.len()]);
        sizes.fold(self.people as usize, usize::saturating_mul)
    }

    /// The place of a cell in the lists. People vary fastest, and scenes slowest.
    pub(super) fn place(&self, number: usize) -> Place {
        let mut left = number;
        let mut within = |len: usize| {
            let place = left % len.max(1);
            left /= len.max(1);
            place
        };
        let person = within(self.people as usize) as u64 + 1;
        let touch = within(self.touch.len());
        let screen = within(self.screens.len().max(1));
        let value = |(path, values): (&String, &Values)| Some((path.clone(), values.value(within(values.len()))?));
        let parameters = self.parameters.iter().rev().filter_map(value).collect();
        Place { scene: left, parameters, screen, touch, person }
    }

    /// The numbers of cells that have each scene, screen and touch source, each value of a list, and both ends of a
    /// range: one of them changes at a time, and the others are the first ones.
    pub(super) fn samples(&self) -> Vec<usize> {
        let mut numbers = vec![0];
        let mut stride = self.people as usize;
        let mut sample = |len: usize, step: usize| {
            numbers.extend((step..len).step_by(step).map(|place| place * stride));
            stride *= len;
        };
        sample(self.touch.len(), 1);
        sample(self.screens.len().max(1), 1);
        for values in self.parameters.values().rev() {
            let step = match values {
                Values::List(_) => 1,
                Values::Range(_) => values.len().saturating_sub(1).max(1),
            };
            sample(values.len(), step);
        }
        let of_scene = |scene: usize| numbers.iter().map(move |number| scene * stride + number);
        (0..self.scenes.len()).flat_map(of_scene).collect()
    }
}

/// The place of a cell in the lists of its plan.
pub(super) struct Place {
    pub(super) scene: usize,
    pub(super) parameters: BTreeMap<String, Value>,
    pub(super) screen: usize,
    pub(super) touch: usize,
    pub(super) person: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path of 5,000 parts, and tables as deep, ended the process.
    #[test]
    fn a_plan_without_end_is_one_short_sentence() {
        let plan = |rest: &str| Plan::parse(format!("scenes = [\"a.toml\"]\npeople = 1\n{rest}"), "plan.toml");
        let path = |parts: usize| vec!["a"; parts].join(".");
        assert!(plan(&format!("[parameters]\n\"{}\" = [1]\n", path(64))).is_ok());
        for (rest, says) in [
            (format!("[parameters]\n\"{}\" = [1]\n", path(5_000)), "is a path of 5000 parts: give the path of a field"),
            (format!("[parameters]\n{} = [1]\n", path(1_000_000)), "parts of a name, and at most 64 are read"),
            (format!("[parameters]\na = {}\n", "[".repeat(100_000)), "parts of a name, and at most 64 are read"),
            (format!("#{}\n", "#".repeat(5 << 20)), "bytes in this text, and at most 4194304 are read"),
            (format!("{} = 1\n", "a".repeat(100_000)), "the plan has no field"),
        ] {
            let error = plan(&rest).unwrap_err().to_string();
            assert!(error.contains(says) && error.len() < 1_000, "{says}: {error}");
        }
    }

    /// The names are those of the fields that serde reads.
    #[test]
    fn the_fields_are_those_of_a_plan() {
        let error = toml::from_str::<Plan>("x = 1").unwrap_err().to_string();
        let (_, expected) = error.split_once("expected one of ").unwrap();
        let mut read: Vec<&str> =
            expected.lines().next().unwrap().split(", ").map(|name| name.trim_matches('`')).collect();
        let mut named: Vec<&str> = fields().collect();
        read.sort_unstable();
        named.sort_unstable();
        assert_eq!(named, read);
    }
}
