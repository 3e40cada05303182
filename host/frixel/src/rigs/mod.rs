//! The boards that a scene can play on, each behind a [`Link`](frixel_driver::Link) that records the play.
//!
//! - [`SimLink`]: a simulated board in this process, in virtual time.
//! - [`EmulatedLink`]: the firmware in an emulator, on the emulator's clock.
//! - `PortLink`: a board on a serial port.
//! - [`Server`]: a virtual board behind a pseudo-terminal, paced by the wall clock, for use by other programs.
//!
//! The emulated and the virtual board need pseudo-terminals, which Unix systems provide.

#[cfg(unix)]
mod emulated;
mod event_log;
#[cfg(unix)]
mod pace;
mod port;
mod recorded;
#[cfg(unix)]
mod server;
#[cfg(unix)]
mod server_log;
mod sim_link;

#[cfg(unix)]
pub use emulated::EmulatedLink;
pub(crate) use event_log::{BoardEvent, EventKind, EventLog};
#[cfg(unix)]
pub(crate) use pace::Dropped;
pub(crate) use port::PortLink;
pub(crate) use recorded::RecordedLink;
#[cfg(unix)]
pub use server::{Server, ServerError};
pub use sim_link::SimLink;
