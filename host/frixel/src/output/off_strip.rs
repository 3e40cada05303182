//! The strip of `felt.svg` that says why the output is off while a finger is on the screen.

use frixel_felt::recorder::FeltRow;
use frixel_wire::fault::Flags;

use super::trace::Span;
use frixel_chart::{Line, Look, PALETTE, Panel, Strip, StripCell};

/// Below this voltage the output counts as off, V rms: on the example finger it adds some micronewtons.
const OFF_BELOW_V_RMS: f64 = 1.0;
/// Opacity of the samples in the legend, as in the strip.
const OPACITY: f64 = 0.3;

/// The flags that switch the output off, the strongest reason first, and what they mean on a screen with a finger.
const REASONS: [(Flags, &str); 5] = [
    (Flags::HOST_SILENT, "the host is silent"),
    (Flags::TOUCH_STALE, "the touch reports are too old"),
    (Flags::NO_FINGER, "the board knows of no finger: touch reports are late or lost"),
    (Flags::STILL, "the finger stands still"),
    (Flags::STREAM_DRY, "the stream has no samples"),
];

/// Why the output is off at a row, as an index for [`REASONS`]; `None` where it is on, where there is no finger, and
/// where the scene has no friction.
pub(super) fn reason(row: &FeltRow) -> Option<usize> {
    let is_off = row.x_mm.is_some() && row.voltage_v_rms.is_some_and(|voltage_v_rms| voltage_v_rms < OFF_BELOW_V_RMS);
    let flags = row.flags.filter(|_| is_off)?;
    REASONS.iter().position(|(flag, _)| flags.contains(*flag))
}

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
    for (reason, (_, meaning)) in REASONS.iter().enumerate() {
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
