//! Costs and predicted perception of a scene.
//!
//! The input is a program, the limits of the board that it was compiled for, and the board's costs for it
//! ([`BoardCosts`]). The output is [`SceneCheck`], as text for people or as JSON.

mod board;
pub mod feel;
mod text;

use frixel_hil_sim::{RigConfig, active_bytes_filled, table_rows};
use frixel_layers::Scene as WireScene;
use frixel_model::InverseTable;
use frixel_scene::{Program, TargetRange, middle_mm};
use frixel_wire::hello::{BoardKind, BoardLimits};
use serde::Serialize;

use crate::judge::Judgement;
pub use board::BoardImage;

/// Costs of a program on a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardCosts {
    /// Bytes sent by the host, without the hello, until a board without pictures has accepted the program.
    pub wire_total_bytes: usize,
    /// Bytes of the program's coefficients in the board's RAM.
    pub active_bytes: usize,
    /// Rows of the inverse table computed for the program.
    pub table_rows: usize,
    /// Rows computed for a program that targets the whole reachable range.
    pub table_rows_whole: usize,
}

impl BoardCosts {
    /// Costs on the board of `rig` of a program that it accepted after `wire_total_bytes` on its line.
    pub fn of(program: &Program, rig: &RigConfig, wire_total_bytes: u64) -> Self {
        let scene = program.scene_bytes();
        // This cannot fail: the board has parsed the same bytes.
        let taken = WireScene::parse(&scene).ok();
        let active_bytes = taken.as_ref().map_or(0, active_bytes_filled);
        let table = taken.and_then(|scene| table_rows(&scene, &rig.board).ok());
        let (table_rows, table_rows_whole) = table.map_or((0, 0), |rows| (rows.filled, rows.whole));
        Self { wire_total_bytes: wire_total_bytes as usize, active_bytes, table_rows, table_rows_whole }
    }
}

/// The costs and limits of a scene; the field names are the keys of `--json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneCheck {
    /// Number of played layers.
    pub layers: usize,
    /// Bytes of the upload.
    pub wire: WireBytes,
    /// Bytes of the board's RAM.
    pub ram: RamBytes,
    /// The longest tick.
    pub tick: LongestTick,
    /// The finger for which friction is computed.
    pub finger: CheckedFinger,
    /// Friction that the drive can reach on this finger.
    pub reach: ReachableFriction,
    /// Target friction of the scene.
    pub targets: TargetRange,
    /// Reasons to doubt the computed friction, one sentence each.
    pub warnings: Vec<String>,
    /// Predicted perception.
    pub judgement: Judgement,
    /// Values rounded, converted or clamped by the compiler, one sentence each.
    pub notes: Vec<String>,
    /// Parts of the scene omitted by the compiler with the reasons, one sentence each.
    pub left_out: Vec<String>,
    /// The smallest firmware image that plays the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub board: Option<BoardImage>,
}

/// Bytes sent from host to board if the board holds no picture of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct WireBytes {
    /// The compiled scene: header, layers, points.
    pub scene_bytes: usize,
    /// Samples of the scene's pictures.
    pub bitmap_bytes: usize,
    /// Overhead: framing, checksums, the commands of the upload and the commit.
    pub framing_bytes: usize,
    /// Sum of the other fields.
    pub total_bytes: usize,
}

/// Bytes of the board's RAM that depend on the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct RamBytes {
    /// Bytes of the scene's pictures in the bitmap pool.
    pub bitmap_pool_bytes: usize,
    /// Size of the bitmap pool. While one scene replaces another, the pool holds the pictures of both.
    pub bitmap_pool_limit_bytes: u32,
    /// Coefficients of layers, points, waves and clicks.
    pub active_bytes: usize,
    /// Rows of the inverse table that the board computes for this scene.
    pub table_bytes: usize,
    /// Rows that the board would compute for a scene that targets the whole reachable range.
    pub table_whole_bytes: usize,
    /// Memory reserved for the table, equal for every scene: computing fewer rows shortens a commit, but saves no RAM.
    pub table_room_bytes: usize,
}

/// The longest tick on the core of the program's board.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LongestTick {
    /// Estimated processor cycles.
    pub cycles: u32,
    /// Largest estimate that a board accepts.
    pub cycles_limit: u32,
    /// A position of the finger with the longest tick, mm from the screen's left edge.
    pub x_mm: f64,
    /// The same position, mm from the screen's top edge.
    pub y_mm: f64,
    /// Layers that may act at this position.
    pub layers: Vec<String>,
}

impl LongestTick {
    fn of(program: &Program, limits: &BoardLimits) -> Self {
        let worst = program.worst_tick(limits.core);
        let cell = worst.cell;
        let (x_mm, y_mm) = middle_mm(&cell);
        Self {
            cycles: worst.cycles(limits.core),
            cycles_limit: limits.tick_cycles_max,
            x_mm,
            y_mm,
            layers: program.titles_in(&cell).into_iter().map(ToString::to_string).collect(),
        }
    }
}

/// The finger that a scene is compiled for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CheckedFinger {
    /// Title of the finger.
    pub title: String,
    /// `assumed`, `perceptual`, `measured` or `empirical`, on the screen that the scene is compiled for.
    pub origin: &'static str,
}

/// Friction that the drive can reach on the scene's finger, at its load and on its coating.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReachableFriction {
    /// Total friction at zero voltage, N.
    pub natural_n: f64,
    /// Largest friction that the drive can add to that, N.
    pub electric_max_n: f64,
    /// Largest total friction, N.
    pub total_max_n: f64,
    /// Rms voltage at the largest friction, V.
    pub voltage_max_v_rms: f64,
}

impl SceneCheck {
    /// Computes the costs of a program for a board with these limits and `costs`.
    pub fn of(program: &Program, limits: &BoardLimits, costs: &BoardCosts, judgement: Judgement) -> Self {
        let scene_bytes = program.scene_bytes().len();
        let bitmap_bytes = program.bitmaps.iter().map(|bitmap| bitmap.samples.len()).sum();
        let total_bytes = costs.wire_total_bytes;
        let reach = &program.reach;
        Self {
            layers: program.records.len(),
            wire: WireBytes {
                scene_bytes,
                bitmap_bytes,
                framing_bytes: total_bytes.saturating_sub(scene_bytes + bitmap_bytes),
                total_bytes,
            },
            ram: RamBytes {
                bitmap_pool_bytes: bitmap_bytes,
                bitmap_pool_limit_bytes: limits.bitmap_pool_bytes,
                active_bytes: costs.active_bytes,
                table_bytes: InverseTable::ROW_BYTES * costs.table_rows,
                table_whole_bytes: InverseTable::ROW_BYTES * costs.table_rows_whole,
                table_room_bytes: size_of::<InverseTable>(),
            },
            tick: LongestTick::of(program, limits),
            finger: CheckedFinger { title: program.finger.title.clone(), origin: program.finger.origin.word() },
            reach: ReachableFriction {
                natural_n: reach.natural_friction_n,
                electric_max_n: reach.electric_friction_max_n,
                total_max_n: reach.friction_max_n(),
                voltage_max_v_rms: reach.voltage_max_v_rms,
            },
            targets: TargetRange::of(program),
            warnings: program.warnings().collect(),
            judgement,
            notes: program.notes().collect(),
            left_out: program.optimisations().collect(),
            board: None,
        }
    }

    /// Adds the smallest firmware image of a kind of board that plays the program.
    #[must_use]
    pub fn with_board(self, program: &Program, kind: BoardKind) -> Self {
        Self { board: Some(BoardImage::of(program, kind)), ..self }
    }

    /// The costs as one JSON object on one line.
    pub fn to_json(&self) -> String {
        // Numbers and strings always serialise.
        serde_json::to_string(self).unwrap_or_default()
    }
}
