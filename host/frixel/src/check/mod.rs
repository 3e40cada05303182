//! What a scene costs and what of it can be felt, before it is played.

mod board;
mod rehearsal;
mod text;

use frixel_hil_sim::{BoardMemory, RigConfig, TableRows};
use frixel_layers::Scene as WireScene;
use frixel_model::InverseTable;
use serde::Serialize;

pub use board::BoardImage;
pub use rehearsal::RehearsalError;

use frixel_scene::{Program, TargetRange, middle_mm};

/// The numbers of a scene; its fields are the keys of `--json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneCheck {
    /// Layers that are played.
    pub layers: usize,
    /// What goes over the line.
    pub wire: WireBytes,
    /// What it takes of the board's RAM.
    pub ram: RamBytes,
    /// The longest tick.
    pub tick: LongestTick,
    /// What this finger can be given.
    pub reach: ReachableFriction,
    /// What the scene asks for.
    pub asked: TargetRange,
    /// What the compiler rounded, converted and clamped, a sentence each.
    pub notes: Vec<String>,
    /// What it left out and why, a sentence each.
    pub left_out: Vec<String>,
    /// The smallest image that plays it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub board: Option<BoardImage>,
}

/// Bytes from host to board, to a board that holds no picture of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct WireBytes {
    /// The compiled scene: header, layers, points.
    pub scene_bytes: usize,
    /// Samples of its pictures.
    pub bitmap_bytes: usize,
    /// What is around them: frames, checks, the commands of the upload, the commit.
    pub framing_bytes: usize,
    /// All of them.
    pub total_bytes: usize,
}

/// Bytes of the board's RAM that depend on the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct RamBytes {
    /// Pictures in the pool.
    pub bitmap_pool_bytes: usize,
    /// The pool's size. While a scene replaces another one, the pictures of both lie in it.
    pub bitmap_pool_limit_bytes: u32,
    /// Coefficients of layers, points, waves and clicks.
    pub active_bytes: usize,
    /// Rows of the inverse table that the board computes.
    pub table_bytes: usize,
    /// Rows that it would compute for a scene that asks for all that can be reached.
    pub table_whole_bytes: usize,
    /// The table's room, which is the same for every scene: a cut saves time at a commit, and no RAM.
    pub table_room_bytes: usize,
}

/// The longest tick on a Cortex-M4F.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LongestTick {
    /// Processor cycles that it is estimated at.
    pub cycles: u32,
    /// Most that a tick may be estimated at.
    pub cycles_limit: u32,
    /// A place where it may take so many, mm from the screen's left edge.
    pub x_mm: f64,
    /// The same from the screen's top edge.
    pub y_mm: f64,
    /// The layers that may act there.
    pub layers: Vec<String>,
}

impl LongestTick {
    fn of(program: &Program, cycles_limit: u32) -> Self {
        let worst = program.worst_tick();
        let cell = worst.cell;
        let (x_mm, y_mm) = middle_mm(&cell);
        Self {
            cycles: worst.cycles(),
            cycles_limit,
            x_mm,
            y_mm,
            layers: program.titles_in(&cell).into_iter().map(str::to_owned).collect(),
        }
    }
}

/// What the drive can give to the scene's finger, at its load and on its coating.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReachableFriction {
    /// Friction at no voltage, in total, N.
    pub natural_n: f64,
    /// The most that the drive adds to that, N.
    pub electric_max_n: f64,
    /// The most in total, N.
    pub total_max_n: f64,
    /// The rms voltage at which that is, V.
    pub voltage_max_v_rms: f64,
}

impl SceneCheck {
    /// Gathers the numbers of a program that was compiled for the board of a simulation, which takes it once.
    pub fn of(program: &Program, rig: &RigConfig) -> Result<Self, RehearsalError> {
        let scene = program.scene_bytes();
        let bitmap_bytes = program.bitmaps.iter().map(|bitmap| bitmap.samples.len()).sum();
        let total_bytes = rehearsal::wire_bytes(program, rig)?;
        // The board has just read the same bytes.
        let taken = WireScene::parse(&scene).ok();
        let active_bytes = taken.as_ref().map_or(0, BoardMemory::bytes_filled);
        let table = taken.and_then(|scene| BoardMemory::table_rows(&scene, &rig.board).ok());
        let table_bytes = |rows: fn(&TableRows) -> usize| InverseTable::ROW_BYTES * table.as_ref().map_or(0, rows);
        let reach = &program.reach;
        Ok(Self {
            layers: program.records.len(),
            wire: WireBytes {
                scene_bytes: scene.len(),
                bitmap_bytes,
                framing_bytes: total_bytes.saturating_sub(scene.len() + bitmap_bytes),
                total_bytes,
            },
            ram: RamBytes {
                bitmap_pool_bytes: bitmap_bytes,
                bitmap_pool_limit_bytes: rig.board.limits.bitmap_pool_bytes,
                active_bytes,
                table_bytes: table_bytes(|table| table.filled),
                table_whole_bytes: table_bytes(|table| table.whole),
                table_room_bytes: size_of::<InverseTable>(),
            },
            tick: LongestTick::of(program, rig.board.limits.tick_cycles_max),
            reach: ReachableFriction {
                natural_n: reach.natural_friction_n,
                electric_max_n: reach.electric_friction_max_n,
                total_max_n: reach.friction_max_n(),
                voltage_max_v_rms: reach.voltage_max_v_rms,
            },
            asked: TargetRange::of(program),
            notes: program.notes.clone(),
            left_out: program.optimisations.iter().map(ToString::to_string).collect(),
            board: None,
        })
    }

    /// Adds the smallest image that plays the program.
    #[must_use]
    pub fn with_board(self, program: &Program) -> Self {
        Self { board: Some(BoardImage::of(program)), ..self }
    }

    /// One JSON object on one line.
    pub fn to_json(&self) -> String {
        // Plain numbers and texts always have a JSON form.
        serde_json::to_string(self).unwrap_or_default()
    }
}
