//! The driver library against the simulated board over a line in virtual time, where everything is counted, and its
//! serial link over a pseudo-terminal.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
#![allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "the tests use pseudo-terminals in real time")]

mod calls;
#[cfg(unix)]
mod serial;
mod slow;
mod stream;
mod trouble;
mod uploads;
mod virtual_link;
