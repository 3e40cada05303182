//! The byte stream to a board outside of the page: `remote_board.js` moves its bytes.
//!
//! Reading suspends the whole module until bytes arrive or the time is over (JSPI). Meanwhile no other export of the
//! instance may be called. To break off the call under way, `remote_board.js` closes the stream to it: its next read or
//! write fails, and the stream is open again for the call that follows.

use std::time::Duration;

use frixel_driver::{ByteStream, LinkClosed};
use frixel_play::Recorded;
use frixel_wire::message::Telemetry;

/// Bytes that one read takes at most.
const READ_MAX: usize = 4_096;
/// Returned by `link_write` and `link_read` if the stream is closed, or closed to the call under way.
const CLOSED: i32 = -1;

/// The stream that `remote_board.js` has connected this instance to.
pub(crate) struct LinkStream {
    buffer: Box<[u8; READ_MAX]>,
    telemetry: Vec<Telemetry>,
}

impl LinkStream {
    pub(crate) fn new() -> Self {
        Self { buffer: Box::new([0; READ_MAX]), telemetry: Vec::new() }
    }
}

fn closed() -> LinkClosed {
    LinkClosed { port: "the port".to_owned(), reason: "the other end closed it".to_owned() }
}

impl ByteStream for LinkStream {
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed> {
        if imports::link_write(bytes.as_ptr(), bytes.len()) == CLOSED { Err(closed()) } else { Ok(()) }
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let wait_ms = 1e3 * wait.as_secs_f64();
        let found = imports::link_read(self.buffer.as_mut_ptr(), READ_MAX, wait_ms);
        if found == CLOSED {
            return Err(closed());
        }
        buffer.extend(self.buffer.iter().take(found as usize));
        Ok(())
    }

    fn now(&self) -> Duration {
        Duration::from_secs_f64(imports::link_now_ms().max(0.0) * 1e-3)
    }

    fn name(&self) -> &'static str {
        "the port"
    }
}

impl Recorded for LinkStream {
    type Recorder = Vec<Telemetry>;

    fn recorder_mut(&mut self) -> &mut Vec<Telemetry> {
        &mut self.telemetry
    }

    fn record(&mut self, telemetry: &[Telemetry]) {
        self.telemetry.extend(telemetry);
    }
}

#[cfg(target_family = "wasm")]
#[allow(unsafe_code, reason = "imports need a declaration; each is safe to call with a buffer of this module")]
mod imports {
    #[link(wasm_import_module = "link")]
    unsafe extern "C" {
        /// Sends bytes; -1 when the stream is closed, else 0.
        pub(super) safe fn link_write(bytes: *const u8, len: usize) -> i32;
        /// Suspends until bytes have arrived, at most `wait_ms`, and returns how many of them it has put into the
        /// buffer; -1 when the stream is closed. While the page gives no sign of life, it stays suspended.
        pub(super) safe fn link_read(buffer: *mut u8, len: usize, wait_ms: f64) -> i32;
        /// Time since a fixed moment, ms; of a long time in which the page gave no sign of life, only a part.
        pub(super) safe fn link_now_ms() -> f64;
    }
}

/// Outside of a page there is no stream.
#[cfg(not(target_family = "wasm"))]
mod imports {
    pub(super) fn link_write(_bytes: *const u8, _len: usize) -> i32 {
        super::CLOSED
    }

    pub(super) fn link_read(_buffer: *mut u8, _len: usize, _wait_ms: f64) -> i32 {
        super::CLOSED
    }

    pub(super) fn link_now_ms() -> f64 {
        0.0
    }
}
