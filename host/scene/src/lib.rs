//! Scenes: TOML files written by people, checked and compiled to the program that a board plays.
//!
//! `docs/design/scenes.md` explains the file format, and `scene-reference.md` beside it lists every key.
//! [`Scene::parse`] reads a file. [`compile`] checks it against the board's limits and returns a [`Program`]. Both
//! report all mistakes at once, each with line and column.
//!
//! The input is the text of a scene file, the bytes of the files that it names ([`Files`]), and the limits of a board.
//! The output is the bytes that a board plays, with information for the scene's designer.
//!
//! ```
//! # fn run(limits: &frixel_wire::hello::BoardLimits) -> Result<(), frixel_scene::CompileError> {
//! use std::collections::BTreeMap;
//! use frixel_scene::{Scene, TargetRange, compile};
//!
//! let text = "version = 1\nscreen = { width_mm = 120, height_mm = 80, coating = { thickness_um = 10, permittivity = 1 } }\n\
//!     finger = { radius_mm = 8, stiffness_pa_per_m = 1.8e7, friction_coefficient = 0.5, normal_load_n = 0.5, \
//!     skin_gap_um = 0 }\n\
//!     [[layer]]\nkind = \"constant\"\nfriction_n = 0.26\n";
//! let scene = Scene::parse(text, "flat.toml", &BTreeMap::new())?;
//! let program = compile(&scene, limits, 40_000)?;
//! println!("{} bytes, up to {} N", program.scene_bytes().len(), TargetRange::of(&program).most_n);
//! # Ok(())
//! # }
//! ```
//!
//! The crate opens no file and reads no clock, and it compiles for `wasm32-unknown-unknown`.
//!
//! - [`TargetRange`]: the target friction of a program over its screen.
//! - [`Scenario`]: events during the play of a scene, and the expected outcome.
//! - [`mod@reference`]: the reference friction of a program, in `f64`, independent of the firmware.
#![forbid(unsafe_code)]

mod compile;
mod compile_error;
mod cover;
mod defaults;
mod diagnostic;
mod digits;
mod excess;
mod fields;
mod file;
mod file_kind;
mod files;
mod finger;
mod grammar;
mod include;
mod kinds;
mod layer;
mod layer_map;
mod layer_tables;
mod live_change;
mod log;
mod lower;
mod mistake;
mod nearest;
mod optimisation;
mod optimise;
mod picture;
mod played_finger;
mod pool;
mod printable;
mod profile;
mod program;
mod reach;
pub mod reference;
mod resample;
mod scenario;
mod scene_profiles;
mod schema;
mod screen;
mod source;
mod springs;
mod stack;
mod tables;
mod target_range;
#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "the tests read the bundled scenes")]
mod tests;
mod tick_cost;
mod titles;
mod toml_text;
mod touch_source;
mod touched_layers;
mod voltage;
mod warning;

pub use compile::{compile, compile_draft};
pub use compile_error::CompileError;
pub use diagnostic::{Diagnostic, DiagnosticKind};
pub use fields::has_unit;
pub use file::Scene;
pub use file_kind::{FileKind, PARQUET, WrongKind};
pub use files::{FileUnavailable, Files, SharedFile, SharedFiles};
pub use finger::{Elasticity, Evidence, Experiment, FingerProfile, MeasuredLaw, Origin};
pub use grammar::stem;
pub use kinds::{layer_kinds, without_place};
pub use layer_map::{LayerError, LayerMap};
pub use layer_tables::LayerTable;
pub use live_change::{Clamped, LayerSetting};
pub use mistake::TILDE_ADVICE;
pub use nearest::Nearest;
pub use picture::check_picture;
pub use played_finger::PlayedFinger;
pub use printable::{Shown, brief, printable, printable_lines};
pub use profile::{NamedProfile, Profile, ProfileError};
pub use program::{Bitmap, Program};
pub use reach::{ROUNDING, Reach};
pub use scenario::{
    Action, Cause, Condition, Expectation, LineDamage, Scenario, ScenarioCommand, ScenarioFault, StraightStroke,
};
pub use scene_profiles::ProfileSource;
pub use schema::json_schema;
pub use screen::{Screen, Slab};
pub use source::Lines;
pub use target_range::{OutOfReach, TargetRange};
pub use tick_cost::middle_mm;
pub use titles::{LayerNumber, LayerTitle, fold_copies};
pub use toml_text::{TEXT_MAX_BYTES, check_toml};
pub use touch_source::TouchSource;
pub use touched_layers::{LayerMiddle, TouchedLayers};
