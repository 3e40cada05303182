//! The boards with a clock of their own that a scene can play on, each behind a
//! [`ByteStream`](frixel_driver::ByteStream) or a [`Link`] that records the play.
//!
//! - [`EmulatedStream`]: the firmware in an emulator, on the emulator's clock; `EmulatedRig` for scenarios.
//! - [`PicoStream`]: the image of the Pico in an emulator, whose clock waits for the host.
//! - `PortLink`: a board on a serial port.
//! - [`Server`]: a virtual board behind a pseudo-terminal, paced by the wall clock, for use by other programs.
//!
//! The emulated and the virtual board need pseudo-terminals, which Unix systems provide.

#[cfg(unix)]
mod emulated;
#[cfg(unix)]
mod emulated_rig;
mod event_log;
#[cfg(unix)]
mod held_ticks;
#[cfg(unix)]
mod pace;
#[cfg(unix)]
mod pico;
mod port;
#[cfg(unix)]
mod server;
#[cfg(unix)]
mod server_log;

#[cfg(unix)]
pub use emulated::EmulatedStream;
#[cfg(unix)]
pub(crate) use emulated_rig::EmulatedRig;
pub(crate) use event_log::{BoardEvent, EventKind, EventLog};
#[cfg(unix)]
pub(crate) use pace::Dropped;
#[cfg(unix)]
pub use pico::PicoStream;
pub(crate) use port::PortLink;
#[cfg(unix)]
pub use server::Server;

use frixel_driver::Link;
use frixel_felt::recorder::Recorder;
use frixel_play::Recorded;

/// A link to a board that plays a scene, with the [`Recorder`] of that play. It is idle until a play has its own.
pub(crate) trait RecordedLink: Link + Recorded<Recorder = Recorder> {}

impl<L: Link + Recorded<Recorder = Recorder>> RecordedLink for L {}
