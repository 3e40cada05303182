//! Plays programs on boards, for the command, the page and the experiments.
//!
//! The input is a compiled [`Program`](frixel_scene::Program), changes of its layers, and the samples of a stream. The
//! output is calls on a [`Device`](frixel_driver::Device) over any link, and calls to the
//! [`PlayListener`](frixel_felt::recorder::PlayListener) of that link, which records what is felt.
//!
//! - [`Player`]: plays a program, replaces it by another one, changes its layers, ends triggers, and streams samples.
//! - [`Control`]: carries out lines of text that change its layers and the program.
//! - [`LiveLayers`]: the settings of the layers while they play.
//! - [`Feed`]: the samples of a stream, sent as fast as the board plays them.
//! - [`connect`]: connects to a board in a simulated world by a [`RigStream`], a line on its clock.
//! - [`simulate`]: plays a program on the simulated board of this process under a simulated finger, in virtual time.
//! - [`judge`]: judges a program by simulated strokes.
//! - [`board_costs`]: memory, table and line bytes that a board needs for a program.
//! - [`Recorded`]: a link with a record of what the board plays, and [`Observed`], of its telemetry only.
//!
//! The crate opens no file, reads no clock and starts no thread: time is the link's clock. It compiles for
//! `wasm32-unknown-unknown`.
#![forbid(unsafe_code)]

mod control;
mod error;
mod feed;
mod judged;
mod live_layers;
mod observed;
mod player;
mod recorded;
mod rig_stream;
mod simulation;
mod trigger;
mod upload;

pub use control::{Control, Next};
pub use error::{PlayError, StopReason};
pub use feed::{Feed, FeedError};
pub use frixel_felt::{GoesOn, TO_THE_END, break_if};
pub use judged::{board_costs, judge};
pub use live_layers::{LayerChange, LiveError, LiveLayers};
pub use observed::Observed;
pub use player::{Player, Replaced, check_measured};
pub use recorded::Recorded;
pub use rig_stream::{RigLink, RigStream, connect, ticks_spanning};
pub use simulation::{SimPlayer, Simulated, Simulation, SimulationError, simulate, simulate_by};
pub use upload::{load, start};
