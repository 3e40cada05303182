//! The costs of a scene as text.

use std::fmt::Write;

use frixel_model::InverseTable;

use super::{RamBytes, SceneCheck, feel};
use frixel_scene::{Origin, OutOfReach};

impl SceneCheck {
    /// The costs as a few lines of text, each ending in a line feed.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        let mut line = |name: &str, value: String| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {name:<16} {value}");
        };
        let Self { wire, ram, tick, finger, reach, targets, .. } = self;
        line("layers", self.layers.to_string());
        line(
            "wire",
            format!(
                "{} bytes: scene {}, pictures {}, framing {}",
                wire.total_bytes, wire.scene_bytes, wire.bitmap_bytes, wire.framing_bytes
            ),
        );
        line(
            "ram",
            format!(
                "pictures {} of {} bytes, layers {} bytes",
                ram.bitmap_pool_bytes, ram.bitmap_pool_limit_bytes, ram.active_bytes
            ),
        );
        line("table", table(ram));
        line(
            "tick",
            format!(
                "about {} of {} cycles at most, near x {} mm, y {} mm{}",
                tick.cycles,
                tick.cycles_limit,
                tick.x_mm,
                tick.y_mm,
                if tick.layers.is_empty() { String::new() } else { format!(": {}", tick.layers.join(", ")) }
            ),
        );
        line("finger", format!("{}, {}", finger.title, finger.origin));
        let suffix = Origin::newtons_suffix_of(finger.origin);
        // A limit is rounded down, and what is below it never above.
        let total_max_n = rounded_down(reach.total_max_n);
        line(
            "reachable",
            format!(
                "{:.4} to {:.4} N in total, up to {:.4} N above natural (at {:.1} V rms){suffix}",
                reach.natural_n.min(total_max_n),
                total_max_n,
                rounded_down(reach.electric_max_n),
                reach.voltage_max_v_rms
            ),
        );
        // The limit is printed rounded down: round a target within reach down as well, so that it is not above.
        let most_n = if targets.above.screen_percent <= 0.0 { rounded_down(targets.most_n) } else { targets.most_n };
        line("targets", format!("{:.4} to {most_n:.4} N in total{suffix}", targets.least_n.min(most_n)));
        line("out of reach", out_of_reach(&targets.above, &targets.below));
        for warning in &self.warnings {
            line("warning", warning.clone());
        }
        for (name, text) in feel::lines(&self.judgement) {
            line(name, text);
        }
        for note in &self.notes {
            line("note", note.clone());
        }
        for left_out in &self.left_out {
            line("optimised away", left_out.clone());
        }
        if let Some(board) = &self.board {
            let features = if board.features.is_empty() { "none".to_owned() } else { board.features.join(", ") };
            line("features", features);
            line("build", board.command.clone());
        }
        text
    }
}

/// A limit in newtons with four digits after the point, which is itself within the limit.
fn rounded_down(limit_n: f64) -> f64 {
    (1e4 * limit_n).floor() / 1e4
}

/// The part of the inverse table that the board computes.
fn table(ram: &RamBytes) -> String {
    let RamBytes { table_bytes, table_whole_bytes, table_room_bytes, .. } = *ram;
    let cut = match table_whole_bytes.saturating_sub(table_bytes) / InverseTable::ROW_BYTES {
        0 => "nothing is cut".to_owned(),
        1 => "1 row is cut".to_owned(),
        rows => format!("{rows} rows are cut"),
    };
    format!("{table_bytes} of {table_whole_bytes} bytes computed, {cut}; {table_room_bytes} bytes are reserved")
}

fn out_of_reach(above: &OutOfReach, below: &OutOfReach) -> String {
    let part = |outside: &OutOfReach, what: &str| {
        let OutOfReach { screen_percent, layers } = outside;
        let percent = if *screen_percent < 0.1 { "less than 0.1".to_owned() } else { format!("{screen_percent:.1}") };
        (*screen_percent > 0.0).then(|| format!("{percent} % of the screen {what}, by {}", layers.join(", ")))
    };
    let parts: Vec<String> = [part(above, "above"), part(below, "below natural")].into_iter().flatten().collect();
    if parts.is_empty() { "nothing".to_owned() } else { format!("{}; clamped", parts.join("; ")) }
}
