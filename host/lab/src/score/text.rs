//! A score as text, JSON and CSV.

use std::cmp::Ordering;
use std::fmt::Write;

use frixel_felt::check::feel::texture_text;
use frixel_felt::judge::{FLAT_WEBER_STEPS, weber_steps_text};
use frixel_scene::{LayerTitle, fold_copies};

use super::metric::{METRICS, Metric};
use super::{GoalBound, LayerBorder, LayerScore, LevelScore, MetricScore, Score, Verdicts};

/// Most lines about layers: the whole summary fits a terminal of 40 lines.
const LAYER_LINES_MAX: usize = 10;
/// Most lines about levels.
const LEVEL_LINES_MAX: usize = 4;
/// Most characters of a line's first column.
const NAME_WIDTH: usize = 30;

impl Score {
    /// The score in words: the [verdict](Self::verdict), then a line for each layer with its copies and for each pair
    /// of neighbouring levels. If there are many, only the least noticeable ones have a line. With `with_fidelity`,
    /// every number of [`Self::metrics`] follows, with the goals that are set for a display.
    pub fn summary(&self, with_fidelity: bool) -> String {
        let mut text = format!("  {}\n", self.verdict);
        let mut line = |name: &str, value: &str| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {name:<NAME_WIDTH$} {value}");
        };
        line("simulated", &self.simulated);
        line("touch source", &self.touch_source.to_string());
        let mut layers: Vec<(&LayerScore, usize)> = self.layer_rows().collect();
        let more = keep_least(&mut layers, LAYER_LINES_MAX, |(one, _), (other, _)| one.cmp_felt(other));
        for (layer, copies) in layers {
            let least = if copies > 1 { format!(", the least of {copies} copies") } else { String::new() };
            line(layer.layer.as_str(), &format!("{}{least}", layer_text(layer)));
        }
        if more > 0 {
            line(&format!("and {more} more layers"), "noticed more surely: score-layers.csv");
        }
        let mut levels: Vec<&LevelScore> = self.levels.iter().collect();
        let more = keep_least(&mut levels, LEVEL_LINES_MAX, |one, other| one.cmp_felt(other));
        for level in levels {
            line("levels", &level_text(level));
        }
        if more > 0 {
            line(&format!("and {more} more pairs of levels"), "told apart more surely: --json");
        }
        for metric in self.metrics.iter().filter(|_| with_fidelity) {
            line(metric.title, &value_text(metric));
        }
        text
    }

    /// A row for each layer: that of its least noticeable copy, with the number of copies.
    pub fn layer_rows(&self) -> impl Iterator<Item = (&LayerScore, usize)> {
        let tables = self.layers.chunk_by(|one, other| one.layer.number().table == other.layer.number().table);
        tables.filter_map(|copies| Some((LayerScore::least(copies)?, copies.len())))
    }

    /// The subject of the verdict.
    pub(super) fn simulated_words(&self) -> String {
        let plural = |count: usize, one: &str| format!("{count} {one}{}", if count == 1 { "" } else { "s" });
        let fingers = plural(self.simulated_fingers, "simulated finger");
        format!("a verdict on {fingers} in {}; people were not asked", plural(self.plays.len(), "play"))
    }

    /// The score as one JSON object on one line.
    pub fn to_json(&self) -> String {
        // Numbers and strings always serialise.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// A row for each layer.
    pub fn layers_csv(&self) -> String {
        let mut text = "layer,simulated_fingers,felt,maybe,not_felt,unknown,contrast_weber_steps,border_with,\
                        border_weber_steps,texture_mn,texture_hz,texture_threshold_mn\n"
            .to_owned();
        for LayerScore { layer, simulated_fingers, contrast_weber_steps, texture, border } in &self.layers {
            let Verdicts { touched, felt, maybe, not_felt, unknown } = simulated_fingers;
            let with = border.as_ref().map_or(String::new(), |border| quoted(side(border)));
            let step = border.as_ref().map(|border| border.weber_steps);
            let newtons = texture.map(|texture| 1e3 * texture.amplitude_n);
            let threshold = texture.and_then(|texture| texture.threshold_n).map(|threshold_n| 1e3 * threshold_n);
            let [step, newtons, hertz, threshold] =
                [step, newtons, texture.map(|texture| texture.frequency_hz), threshold]
                    .map(|value| value.map_or(String::new(), |value| value.to_string()));
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{},{touched},{felt},{maybe},{not_felt},{unknown},{contrast_weber_steps},{with},{step},\
                 {newtons},{hertz},{threshold}",
                quoted(layer.as_str())
            );
        }
        text
    }

    /// A row for each play, with the numbers in the units of the table.
    pub fn to_csv(&self) -> String {
        let keys: Vec<&str> = METRICS.iter().map(|metric| metric.key).collect();
        let mut text = format!("simulated_person,stroke,seed,{}\n", keys.join(","));
        for play in &self.plays {
            let value = |metric: &Metric| {
                let value = play.fidelity.and_then(|fidelity| metric.of(&fidelity));
                value.map_or(String::new(), |value| value.to_string())
            };
            let values: Vec<String> = METRICS.iter().map(value).collect();
            // Writing to a string cannot fail.
            let person = play.person.map_or(String::new(), |person| person.to_string());
            let _ = writeln!(text, "{person},{},{},{}", play.stroke, play.seed, values.join(","));
        }
        text
    }
}

/// Keeps the least of more rows than there are lines for, in their order, and returns how many are left out.
fn keep_least<T>(rows: &mut Vec<T>, lines_max: usize, cmp: impl FnMut(&T, &T) -> Ordering) -> usize {
    let more = rows.len().saturating_sub(lines_max);
    if more > 0 {
        rows.sort_by(cmp);
        rows.truncate(lines_max);
    }
    more
}

fn value_text(metric: &MetricScore) -> String {
    let MetricScore { mean, interval, unit, human, goal, .. } = metric;
    let interval = interval.map_or(String::new(), |[low, high]| format!(" ({low:.2} to {high:.2})"));
    let human = human.map_or(String::new(), |human| format!("; {:.1}: {}", human.value, human.meaning));
    let goal = goal.map_or(String::new(), |goal| {
        let (word, limit) = match goal {
            GoalBound::AtMost(limit) => ("at most", limit),
            GoalBound::AtLeast(limit) => ("at least", limit),
        };
        format!("; goal: {word} {limit}, {}", if goal.is_met_by(*mean) { "met" } else { "missed" })
    });
    let space = if unit.is_empty() { "" } else { " " };
    format!("{mean:.2}{interval}{space}{unit}{human}{goal}")
}

/// A text as a cell of a CSV file.
pub(crate) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

fn side(border: &LayerBorder) -> &str {
    border.from.as_ref().map_or("the bare screen", LayerTitle::as_str)
}

/// How many fingers notice a layer, and of what size it is for the one in the middle.
fn layer_text(layer: &LayerScore) -> String {
    let LayerScore { simulated_fingers, contrast_weber_steps, texture, border, .. } = layer;
    let is_flat = contrast_weber_steps.abs() < FLAT_WEBER_STEPS && (border.is_some() || texture.is_some());
    let contrast = (!is_flat).then(|| format!("contrast {} Weber steps", weber_steps_text(*contrast_weber_steps)));
    let unit = if is_flat { " Weber steps" } else { "" };
    let border = border
        .iter()
        .map(|border| format!("step onto it from {} {}{unit}", side(border), weber_steps_text(border.weber_steps)));
    let texture = texture.iter().map(|texture| format!("texture {}", texture_text(texture)));
    let sizes: Vec<String> = contrast.into_iter().chain(border).chain(texture).collect();
    format!("felt by {}; {}", counts(simulated_fingers), sizes.join(", "))
}

fn level_text(level: &LevelScore) -> String {
    let titles = |titles: &[LayerTitle]| fold_copies(&titles.iter().collect::<Vec<_>>()).join(", ");
    let LevelScore { lower, higher, simulated_fingers, weber_steps } = level;
    let steps = weber_steps_text(*weber_steps);
    let [lower, higher] = [titles(lower), titles(higher)];
    format!("{lower} and {higher}: told apart by {}; {steps} Weber steps", counts(simulated_fingers))
}

/// Number of noticing fingers, of the ones that touched it.
fn counts(verdicts: &Verdicts) -> String {
    let Verdicts { touched, felt, maybe, unknown, .. } = verdicts;
    let maybe = (*maybe > 0).then(|| format!(", maybe by {maybe}"));
    let unknown = (*unknown > 0).then(|| format!(", unknown for {unknown}"));
    format!("{felt} of {touched}{}{}", maybe.unwrap_or_default(), unknown.unwrap_or_default())
}
