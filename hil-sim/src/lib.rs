//! A simulator of amplifier, screen and finger, in virtual time.
//!
//! - [`World`]: everything outside the board's pins. Each tick it returns a [`Sense`](frixel_control::Sense), takes a
//!   [`Drive`], and returns the friction that the finger [felt](Felt).
//! - [`Stroke`]: the place of the finger over time.
//! - [`Rig`]: a board and its world on one thread.
//! - [`BoardRig`]: the common interface of rigs for scenarios: a board with a serial line, and faults of both.
//! - [`chips`]: models of the chips on a board, for their drivers to run against.
//! - [`emulated`]: emulated boards, and their comparison with the in-process board.
//! - [`looped_board`]: a board with the self-test's wires, optionally with one defect.
//! - [`Line`]: one direction of a serial line at its line rate; [`LineNoise`]: damage to its bytes.
//!
//! The simulator does not use wall time, and all random numbers come from a seed: the same run gives the same bytes on
//! every platform. For that reason, mathematical functions come from `libm` by name; `+ - * /` and the square root of
//! `f64` are correctly rounded everywhere.
#![forbid(unsafe_code)]

mod amplifier;
mod board_rig;
pub mod chips;
#[cfg(unix)]
#[allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "an emulator is a process with files")]
pub mod emulated;
mod error;
mod fingertip;
mod line;
mod line_noise;
pub mod looped_board;
mod person;
#[cfg(unix)]
#[allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "a pseudo-terminal is a file")]
mod pseudo_terminal;
mod random;
mod rig;
mod stroke;
mod touch;
mod world;

pub use amplifier::AmplifierConfig;
pub use board_rig::{BoardRig, BoardView, RigError, RigFault, RigTick};
pub use error::{OutOfRange, WorldError};
pub use fingertip::{FingertipConfig, RELAXATION_LENGTH_M, SlipStep, example_finger, one_minus_exp};
pub use frixel_control::{Board, Drive, Status};
pub use frixel_session::{active_bytes_filled, table_rows};
pub use line::Line;
pub use line_noise::{LineNoise, NoiseConfig};
pub use person::Person;
#[cfg(unix)]
pub use pseudo_terminal::PseudoTerminal;
pub use rig::{BoardMemory, Journal, Rig, RigConfig};
pub use stroke::{FingerState, HUMAN_STROKE_MAX_S, HUMAN_TEST_SEEDS, Point, Stroke, StrokeError, StrokeRow};
pub use touch::TouchConfig;
pub use world::{Felt, OwnFinger, ReferenceFriction, World, WorldConfig, WorldFault, WorldOptions};
