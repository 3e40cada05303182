//! What a person feels of a scene: before it is played, and of a play that was recorded.
//!
//! The input is a compiled [`Program`](frixel_scene::Program), and of a play the observations of every tick. The crate
//! opens no file and reads no clock, and it compiles for `wasm32-unknown-unknown`.
//!
//! - [`FrictionMap`]: the target friction of a program over its screen.
//! - [`check`]: what a program costs and what will be felt of it, as `frixel check` prints it.
//! - [`judge`]: what a person will feel of each element, with its sources.
//! - [`recorder`]: records what a board did and what its finger felt, and compares it with the reference.
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

pub use goes_on::{GoesOn, TO_THE_END};
pub use preview::{FrictionMap, MapGrid, Preview, ReachSide};
pub use spectrum::band_rms;
