//! A check as text.

use frixel_model::InverseTable;

use super::feel::Line;
use super::{RamBytes, SceneCheck, feel};
use crate::judge::listed_briefly;
use frixel_scene::{Origin, OutOfReach, TargetRange};

impl SceneCheck {
    /// The check as lines of text, each ending in a line feed: verdicts, the newtons behind them, and whether the
    /// scene fits the board. With `with_costs`, every number of bytes and cycles follows.
    pub fn summary(&self, with_costs: bool) -> String {
        feel::text(&self.lines(with_costs))
    }

    /// The lines of [`Self::summary`].
    pub fn lines(&self, with_costs: bool) -> Vec<Line> {
        let mut lines = feel::lines(&self.judgement);
        lines.extend(self.warnings.iter().map(|warning| ("warning", warning.clone())));
        lines.extend(self.notes.iter().map(|note| ("note", note.clone())));
        lines.extend(self.left_out.iter().map(|left_out| ("optimised away", left_out.clone())));
        lines.extend(out_of_reach(&self.targets).map(|text| ("out of reach", text)));
        lines.extend(self.newtons());
        lines.push(self.fits());
        if with_costs {
            lines.extend(self.costs());
        }
        if let Some(board) = &self.board {
            let features = if board.features.is_empty() { "none".to_owned() } else { board.features.join(", ") };
            lines.extend([("features", features), ("build", board.command.clone())]);
        }
        lines
    }

    /// The finger, the friction in reach on it, and the scene's targets.
    fn newtons(&self) -> [Line; 3] {
        let Self { finger, reach, targets, .. } = self;
        let suffix = Origin::newtons_suffix_of(finger.origin);
        // A limit is rounded down, and what is below it never above.
        let total_max_n = rounded_down(reach.total_max_n);
        let reachable = format!(
            "{:.4} to {total_max_n:.4} N in total, up to {:.4} N above natural (at {:.1} V rms){suffix}",
            reach.natural_n.min(total_max_n),
            rounded_down(reach.electric_max_n),
            reach.voltage_max_v_rms
        );
        // The limit is printed rounded down: round a target within reach down as well, so that it is not above.
        let most_n = if targets.above.screen_percent <= 0.0 { rounded_down(targets.most_n) } else { targets.most_n };
        let targets = format!("{:.4} to {most_n:.4} N in total{suffix}", targets.least_n.min(most_n));
        [("finger", format!("{}, {}", finger.title, finger.origin)), ("reachable", reachable), ("targets", targets)]
    }

    /// Whether the board has the cycles and the memory, and which part of them the scene takes.
    fn fits(&self) -> Line {
        let Self { tick, ram, wire, .. } = self;
        let is_within =
            tick.cycles <= tick.cycles_limit && ram.bitmap_pool_bytes as u64 <= u64::from(ram.bitmap_pool_limit_bytes);
        let cycles_percent = 100.0 * f64::from(tick.cycles) / f64::from(tick.cycles_limit);
        let pictures = match ram.bitmap_pool_bytes {
            0 => "no pictures".to_owned(),
            bytes => format!("{} of {} of pictures", kilobytes(bytes), kilobytes(ram.bitmap_pool_limit_bytes as usize)),
        };
        let text = format!(
            "{cycles_percent:.0} % of the cycles that a tick may take, {pictures}, {} to send",
            kilobytes(wire.total_bytes)
        );
        (if is_within { "fits" } else { "does not fit" }, text)
    }

    fn costs(&self) -> [Line; 5] {
        let Self { wire, ram, tick, .. } = self;
        let layers = if tick.layers.is_empty() { String::new() } else { format!(": {}", listed_briefly(&tick.layers)) };
        [
            ("layers", self.layers.to_string()),
            (
                "wire",
                format!(
                    "{} bytes: scene {}, pictures {}, framing {}",
                    wire.total_bytes, wire.scene_bytes, wire.bitmap_bytes, wire.framing_bytes
                ),
            ),
            (
                "ram",
                format!(
                    "pictures {} of {} bytes, layers {} bytes",
                    ram.bitmap_pool_bytes, ram.bitmap_pool_limit_bytes, ram.active_bytes
                ),
            ),
            ("table", table(ram)),
            (
                "tick",
                format!(
                    "about {} of {} cycles at most, near x {} mm, y {} mm{layers}",
                    tick.cycles, tick.cycles_limit, tick.x_mm, tick.y_mm
                ),
            ),
        ]
    }
}

/// A number of bytes in kB.
fn kilobytes(bytes: usize) -> String {
    format!("{:.1} kB", 1e-3 * bytes as f64)
}

/// A limit in newtons, rounded down to four decimal places.
fn rounded_down(limit_n: f64) -> f64 {
    (1e4 * limit_n).floor() / 1e4
}

/// The computed part of the inverse table.
fn table(ram: &RamBytes) -> String {
    let RamBytes { table_bytes, table_whole_bytes, table_room_bytes, .. } = *ram;
    let cut = match table_whole_bytes.saturating_sub(table_bytes) / InverseTable::ROW_BYTES {
        0 => "nothing is cut".to_owned(),
        1 => "1 row is cut".to_owned(),
        rows => format!("{rows} rows are cut"),
    };
    format!("{table_bytes} of {table_whole_bytes} bytes computed, {cut}; {table_room_bytes} bytes are reserved")
}

/// Targets out of reach, which are clamped, with their layers.
fn out_of_reach(targets: &TargetRange) -> Option<String> {
    let part = |outside: &OutOfReach, what: &str| {
        let OutOfReach { screen_percent, layers } = outside;
        let percent = if *screen_percent < 0.1 { "less than 0.1".to_owned() } else { format!("{screen_percent:.1}") };
        (*screen_percent > 0.0).then(|| format!("{percent} % of the screen {what}, by {}", listed_briefly(layers)))
    };
    let parts = [part(&targets.above, "above"), part(&targets.below, "below natural")];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| format!("{}; clamped", parts.join("; ")))
}
