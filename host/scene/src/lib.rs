//! Scenes: a TOML file that a person writes, checked and compiled to the program that a board plays.
//!
//! `docs/scene.md` is the reference of the file. [`Scene::parse`] reads it, [`compile`] checks what needs the board or
//! other layers, and makes a [`Program`]. Both tell every mistake at once, each with line and column.
//!
//! - [`mod@reference`]: the friction that a program means, in `f64`, independently of the firmware.
//! - [`recorder`]: what a board did and what its finger felt, compared with that.
//! - [`metrics`]: the size of the errors.
#![forbid(unsafe_code)]

mod compile;
mod compile_error;
mod cover;
mod excess;
mod fields;
mod file;
mod grammar;
mod kinds;
mod layer;
mod layer_map;
mod leave_out;
mod left_out;
mod log;
mod lower;
pub mod metrics;
mod mistake;
mod nearest;
mod outside;
mod picture;
mod pictures;
mod pool;
mod preview;
mod program;
mod reach;
pub mod recorder;
pub mod reference;
mod resample;
mod schema;
mod source;
mod tables;
#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "the tests read the bundled scenes")]
mod tests;
mod tick_cost;

pub use compile::compile;
pub use compile_error::{CompileError, Located};
pub use file::Scene;
pub use layer_map::{LayerError, LayerMap};
pub use left_out::LeftOut;
pub use mistake::Mistake;
pub use nearest::Nearest;
pub use outside::{Asked, Outside};
pub use pictures::{PictureUnavailable, Pictures};
pub use preview::{FrictionMap, MapGrid, Preview, ReachSide};
pub use program::{Bitmap, Program};
pub use reach::{ROUNDING, Reach, carrier};
pub use schema::json_schema;
pub use tick_cost::middle_mm;
