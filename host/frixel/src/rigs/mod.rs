//! Boards with a clock of their own on which a scene can play.
//!
//! - [`EmulatedRig`]: the firmware in an emulator, on the emulator's clock.
//! - [`Server`]: a virtual board behind a pseudo-terminal, paced by the wall clock, for use by other programs.
//!
//! The emulated and the virtual board need pseudo-terminals, which Unix systems provide.

#[cfg(unix)]
mod emulated;
#[cfg(unix)]
mod pace;
#[cfg(unix)]
mod server;
#[cfg(unix)]
mod server_log;

#[cfg(unix)]
pub use emulated::EmulatedRig;
#[cfg(unix)]
pub(crate) use pace::Dropped;
#[cfg(unix)]
pub use server::Server;

use frixel_driver::Link;
use frixel_felt::recorder::Recorder;
use frixel_play::Recorded;

/// A link to a board that plays a scene, with the [`Recorder`] of that play, which is idle until the play starts.
pub(crate) trait RecordedLink: Link + Recorded<Recorder = Recorder> {}

impl<L: Link + Recorded<Recorder = Recorder>> RecordedLink for L {}
