//! The engine of the studio, frixel's page: compiler, driver and simulator as one WebAssembly module.
//!
//! The module's exports take and return plain numbers. Larger values cross in two buffers, one for each direction (see
//! [`exports`]). No glue code is generated: `web/engine` has the JavaScript files that use the exports, and
//! `web/engine/README.md` describes their use in a page.
//!
//! A page loads the module several times, and each instance does one of these things:
//!
//! - it checks scenes and draws their maps (`check`, `map`), which needs no state;
//! - it is the simulated board (`simulator`): firmware and world in virtual time, with its host in the same instance;
//! - it is the host of a board at the other end of a byte stream (`host` over `link_stream`). Reading such a stream
//!   suspends the module until bytes arrive, which needs a browser with JSPI.
//!
//! The simulator's host and the host of a real board are the same code; only the
//! [`ByteStream`](frixel_driver::ByteStream) differs.
#![deny(unsafe_code)]

mod additions;
mod answer;
mod check;
pub mod exports;
mod felt;
mod host;
mod host_error;
mod layer_text;
mod layers;
mod link_stream;
mod map;
mod place;
mod pointer;
mod pointer_stream;
mod program;
mod request;
mod seeded;
mod simulator;
mod touched;
mod used_files;

pub use check::{check, compile};
pub use host_error::HostError;
pub use program::ProgramError;
pub use request::{Numbers, Request, RequestError};
pub use seeded::seeded_hash;
pub use used_files::used_files;
