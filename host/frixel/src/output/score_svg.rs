//! The picture of a score.

use frixel_lab::score::{Human, LayerScore, MetricScore, Score, Verdicts};

use super::{DrawingError, svg};
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel};

/// Least height of the row of a layer, in pixels.
const ROW_HEIGHT: u32 = 30;

/// Draws the metrics that have a threshold of perception, each over its threshold, and the share of simulated fingers
/// that notice each layer.
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
    let mut chart = Chart::new(vec![panel, layers(score)], 1);
    title.clone_into(&mut chart.title);
    let source = score.touch_source;
    chart.caption = vec![
        format!("This is {}. The touch source has {source}.", score.simulated),
        format!("Verdict: {}.", score.verdict),
    ];
    svg(&chart)
}

/// The share of the simulated fingers that notice each layer.
fn layers(score: &Score) -> Panel {
    let rows: Vec<&LayerScore> = score.layer_rows().map(|(layer, _)| layer).collect();
    let axis = Axis::linear("share of the simulated fingers that notice the layer", 0.0..1.0);
    let mut panel = Panel::new("", axis, Axis::linear("", (rows.len() as f64).max(1.0)..0.0).with_labels(0.0));
    panel.height = panel.height.max(ROW_HEIGHT * rows.len() as u32);
    let (disc, line) = (Look::mark(PALETTE[0], Mark::Disc), Look::line(PALETTE[0], Line::Thick));
    let mut shares = Vec::new();
    for (number, layer) in rows.into_iter().enumerate() {
        let y = number as f64 + 0.6;
        let Verdicts { touched, felt, maybe, .. } = layer.simulated_fingers;
        let share = |fingers: usize| fingers as f64 / touched.max(1) as f64;
        shares.push((share(felt), y));
        if maybe > 0 {
            panel.add("", line, vec![(share(felt), y), (share(felt + maybe), y)]);
        }
        panel.notes.push((0.005, y - 0.35, layer.layer.to_string()));
    }
    panel.add("felt; line: maybe", disc, shares);
    panel
}
