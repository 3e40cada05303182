//! The strip of `felt.svg` that shows why the output is off while a finger is on the screen.

use super::span::{OFF_REASONS, Span};
use frixel_chart::{Line, Look, PALETTE, Panel, Strip, StripCell};

/// Opacity of the samples in the legend, as in the strip.
const OPACITY: f64 = 0.3;

/// Adds the strip to a panel, and its reasons to the legend; nothing if the output is never off.
pub(super) fn add_to(panel: &mut Panel, spans: &[Span]) {
    let mut cells: Vec<(usize, StripCell)> = Vec::new();
    let mut last = None;
    for span in spans {
        let off = span.off();
        match (off, cells.last_mut()) {
            (Some(reason), Some((_, cell))) if last == Some(reason) => cell.x.end = span.end_s,
            (Some(reason), _) => {
                let cell = StripCell { x: span.start_s..span.end_s, text: String::new(), colour: Some(colour(reason)) };
                cells.push((reason, cell));
            }
            (None, _) => {}
        }
        last = off;
    }
    for (reason, (_, meaning)) in OFF_REASONS.iter().enumerate() {
        if cells.iter().any(|(other, _)| *other == reason) {
            let look = Look::line(colour(reason), Line::Filled(OPACITY));
            panel.add(&format!("output off: {meaning}"), look, Vec::new());
        }
    }
    if !cells.is_empty() {
        let cells = cells.into_iter().map(|(_, cell)| cell).collect();
        panel.add_strip(Strip { label: "output off".to_owned(), cells });
    }
}

fn colour(reason: usize) -> frixel_chart::RGBColor {
    PALETTE.get((reason + 2) % PALETTE.len()).copied().unwrap_or_default()
}
