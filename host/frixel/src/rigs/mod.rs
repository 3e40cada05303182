//! Boards that are not there: the simulated one behind a [`Link`](frixel_driver::Link) of its own, in virtual time, the
//! one behind a pseudo-terminal, paced by the wall clock, and the emulated one behind a pseudo-terminal, on a clock of its
//! own.

mod emulated;
mod recorder;
mod server;
mod server_log;
mod sim_link;
mod streamed;

pub use emulated::{EmulatedLink, EmulatedRecorder};
pub use recorder::Recorder;
pub use server::{Server, ServerError};
pub use sim_link::SimLink;
