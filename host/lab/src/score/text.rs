//! A score as text, JSON and CSV.

use std::fmt::Write;

use super::metric::{METRICS, Metric};
use super::{Goal, MetricScore, Score};

impl Score {
    /// The score as a table, a line for each number.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        for metric in &self.metrics {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {:<30} {}", metric.title, value_text(metric));
        }
        text
    }

    /// The score as one JSON object on one line.
    pub fn to_json(&self) -> String {
        // Numbers and strings always serialise.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// A row for each play, with the numbers in the units of the table.
    pub fn to_csv(&self) -> String {
        let keys: Vec<&str> = METRICS.iter().map(Metric::key).collect();
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

fn value_text(metric: &MetricScore) -> String {
    let MetricScore { mean, interval, unit, human, goal, .. } = metric;
    let interval = interval.map_or(String::new(), |[low, high]| format!(" ({low:.2} to {high:.2})"));
    let human = human.map_or(String::new(), |human| format!("; {:.1}: {}", human.value, human.meaning));
    let goal = goal.map_or(String::new(), |goal| {
        let (word, limit) = match goal {
            Goal::AtMost(limit) => ("at most", limit),
            Goal::AtLeast(limit) => ("at least", limit),
        };
        format!("; goal: {word} {limit}, {}", if goal.is_met_by(*mean) { "met" } else { "missed" })
    });
    let space = if unit.is_empty() { "" } else { " " };
    format!("{mean:.2}{interval}{space}{unit}{human}{goal}")
}
