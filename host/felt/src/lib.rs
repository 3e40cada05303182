//! Predicts the perception of a scene, and evaluates recorded plays.
//!
//! The input is a compiled [`Program`](frixel_scene::Program) and, for a play, observations of every tick. The crate
//! opens no file and reads no clock, and it compiles for `wasm32-unknown-unknown`.
//!
//! - [`FrictionMap`]: the target friction of a program over its screen.
//! - [`check`]: costs and predicted perception of a program, as printed by `frixel check`.
//! - [`judge`]: predicted perception of each element, with sources.
//! - [`recorder`]: records a board and its finger, and compares them with the reference.
//! - [`metrics`]: the size of the errors.
//! - [`fidelity`]: how faithfully friction was felt, in numbers that a person notices.
//! - [`GoesOn`]: how long work is interrupted, here and in the crates above.
#![forbid(unsafe_code)]

pub mod check;
pub mod fidelity;
mod goes_on;
pub mod judge;
pub mod metrics;
mod percentile;
mod preview;
pub mod recorder;
mod spectrum;
#[cfg(test)]
mod tests;

pub use goes_on::{GoesOn, TO_THE_END, break_if};
pub use percentile::percentiles;
pub use preview::{FrictionMap, MapGrid, Preview, ReachSide};
pub use spectrum::band_rms;
