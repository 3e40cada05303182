//! A score as text, JSON, CSV and a picture.

use std::fmt::Write;

use super::metric::{Human, METRICS, Metric};
use super::{MetricScore, Score};
use crate::chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};
use crate::output::DrawingError;

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
        let mut text = format!("person,stroke,seed,{}\n", keys.join(","));
        for play in &self.plays {
            let value =
                |metric: &Metric| play.fidelity.map_or(String::new(), |fidelity| metric.of(&fidelity).to_string());
            let values: Vec<String> = METRICS.iter().map(value).collect();
            // Writing to a string cannot fail.
            let person = play.person.map_or(String::new(), |person| person.to_string());
            let _ = writeln!(text, "{person},{},{},{}", play.stroke, play.seed, values.join(","));
        }
        text
    }
}

/// Draws a picture of the numbers that a person notices, each over the value from which it is noticed.
pub fn draw_score_svg(title: &str, score: &Score) -> Result<String, DrawingError> {
    let noticed: Vec<(&MetricScore, Human)> =
        score.metrics.iter().filter_map(|metric| metric.human.map(|human| (metric, human))).collect();
    let rows = noticed.len() as f64;
    let axis = Axis::log("mean over the value from which a person notices it", 0.01..100.0);
    let mut panel = Panel::new("", axis, Axis::linear("", rows..0.0).with_labels(0.0));
    let line = Look { colour: PALETTE[6], line: Line::Dashed, mark: Mark::None };
    panel.add("noticed", line, vec![(1.0, 0.0), (1.0, rows)]);
    let (mean, interval) = (Look::mark(PALETTE[0], Mark::Disc), Look::line(PALETTE[0], Line::Thick));
    let mut means = Vec::new();
    for (number, (metric, human)) in noticed.into_iter().enumerate() {
        let y = number as f64 + 0.6;
        let part = |value: f64| (value / human.value).clamp(0.01, 100.0);
        means.push((part(metric.mean), y));
        if let Some([low, high]) = metric.interval {
            panel.add("", interval, vec![(part(low), y), (part(high), y)]);
        }
        let MetricScore { title, unit, mean, .. } = metric;
        panel.notes.push((
            0.011,
            y - 0.35,
            format!("{title}: {mean:.2} {unit}; {:.1}: {}", human.value, human.meaning),
        ));
    }
    panel.add("mean over the plays, simulated", mean, means);
    let mut chart = Chart::new(vec![panel], 1);
    title.clone_into(&mut chart.title);
    chart.svg().map_err(DrawingError::new)
}

fn value_text(metric: &MetricScore) -> String {
    let MetricScore { mean, interval, unit, human, .. } = metric;
    let interval = interval.map_or(String::new(), |[low, high]| format!(" ({low:.2} to {high:.2})"));
    let human = human.map_or(String::new(), |human| format!("; {:.1}: {}", human.value, human.meaning));
    let space = if unit.is_empty() { "" } else { " " };
    format!("{mean:.2}{interval}{space}{unit}{human}")
}
