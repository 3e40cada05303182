//! The tick: a finger's track and the board's inputs in, a DAC code out, 40,000 times a second.
//!
//! [`Ticker::tick`] runs the same steps in the same order in every tick while the output is enabled. It reads the
//! coefficients of a scene from an [`Active`]. Before each tick, the ticker takes at most one [`Order`] from the
//! session: a [`Track`] of the finger, a scene, a change of state. It reports a [`Status`]. It does not allocate, wait
//! or panic, does no I/O, and reads no clock: it counts ticks.
//!
//! ```
//! use frixel_control::{Active, Board, Drive, Sense, Ticker};
//! use frixel_layers::BitmapPool;
//!
//! let pool = BitmapPool::new();
//! let mut active = Active::new(); // no scene
//! let mut ticker = Ticker::new(&Board::SIMULATOR, &pool, &mut active);
//! assert_eq!(ticker.tick(&Sense::default()), Drive::default());
//! ```
//!
//! `examples/desktop.rs` fills an [`Active`] from a finger and a scene, and plays it.
//!
//! A board builds this crate for speed, and all others for size.
//!
//! The Cargo features `stream` and `sine-carrier` enable parts of scenes. The documentation of `frixel-session` lists
//! all features.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod active;
mod amplifier;
mod board;
mod carrier;
mod ceilings;
mod envelope;
mod finger;
mod io;
mod monitor;
mod order;
#[cfg_attr(not(feature = "stream"), path = "no_stream.rs")]
mod stream;
mod supervisor;
mod tick_count;
mod tick_meter;
mod ticker;
mod track;

pub use active::Active;
pub use amplifier::{AmplifierSpec, ReadyWhileDisabled, SwitchingTime};
pub use board::Board;
pub use carrier::CarrierTiming;
pub use ceilings::Ceilings;
pub use finger::stale_after_ticks;
pub use io::{Drive, Sense};
pub use order::{Counters, Order, Status};
#[cfg(feature = "stream")]
pub use stream::{STREAM_LEN, StreamBuffer, StreamIntake, StreamStart};
pub use tick_count::is_past;
pub use tick_meter::TickMeter;
pub use ticker::Ticker;
pub use track::{StandstillRamp, Track};
