//! The picture of a score.

use frixel_lab::score::{Human, MetricScore, Score};

use super::{DrawingError, svg};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};

/// Draws a picture of the numbers that a person notices, each over the value from which it is noticed.
pub(crate) fn draw_score_svg(title: &str, score: &Score) -> Result<String, DrawingError> {
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
    svg(&chart)
}
