//! A serial port as a [`Link`].
//!
//! The link has two threads. One thread reads. The other writes the queued frames in order, and sends the pings that
//! are due if the application has made a call within the keep-alive timeout. No call waits for the operating system to
//! accept bytes: a port whose other end does not read can block a write for ever, and then only the writing thread is
//! blocked.

mod shared;

use std::sync::{Arc, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serialport::ClearBuffer;

use super::port_error::PortError;
use super::ports::why_not_opened;
use crate::error::LinkClosed;
use crate::link::{Link, Written};
use shared::{Shared, State};

/// Default line rate, in bits a second. Pseudo-terminals and native USB ignore it.
pub const DEFAULT_BAUD: u32 = 2_000_000;

/// Time to wait for a port in use. A pseudo-terminal stays exclusive until its server notices that the previous client
/// has gone.
const BUSY_PATIENCE: Duration = Duration::from_millis(700);
/// Time between two attempts to open a port that is in use.
const BUSY_RETRY_AFTER: Duration = Duration::from_millis(20);
/// Interval at which the reading thread checks whether the link is being dropped.
const READ_POLL: Duration = Duration::from_millis(20);
/// Time without progress of a write after which the link closes.
const WRITE_TIMEOUT: Duration = Duration::from_millis(500);
/// Time to wait in a drop for the last frames to be written and the port to close.
const DROP_WAIT: Duration = Duration::from_millis(50);

/// A serial port, opened for exclusive use: a second program that opens it gets [`PortError::Busy`].
///
/// When the cable is pulled, the link closes, and every later call returns [`LinkClosed`]. The port closes when the
/// link is dropped.
pub struct SerialLink {
    path: String,
    opened: Instant,
    shared: Arc<Shared>,
    shutdown_frames: Vec<u8>,
}

impl SerialLink {
    /// Opens the port at `path` with `baud` bits a second, and discards the bytes that the port received before. Waits
    /// up to 0.7 s for a port that is in use.
    pub fn open(path: &str, baud: u32) -> Result<Self, PortError> {
        let started = Instant::now();
        loop {
            match Self::open_once(path, baud) {
                Err(PortError::Busy { .. }) if started.elapsed() < BUSY_PATIENCE => thread::sleep(BUSY_RETRY_AFTER),
                outcome => return outcome,
            }
        }
    }

    fn open_once(path: &str, baud: u32) -> Result<Self, PortError> {
        let not_opened = |error| why_not_opened(path, error);
        let builder = serialport::new(path, baud).timeout(READ_POLL);
        // Windows opens every serial port for exclusive use.
        #[cfg(unix)]
        let builder = builder.exclusive(true);
        let mut reader = builder.open().map_err(not_opened)?;
        reader.set_timeout(READ_POLL).map_err(not_opened)?;
        let mut writer = reader.try_clone().map_err(not_opened)?;
        writer.set_timeout(WRITE_TIMEOUT).map_err(not_opened)?;
        reader.clear(ClearBuffer::Input).map_err(not_opened)?;

        let opened = Instant::now();
        let link =
            Self { path: path.into(), opened, shared: Arc::new(Shared::new(opened)), shutdown_frames: Vec::new() };
        link.spawn("frixel-read", move |shared| shared.read_from(reader))?;
        link.spawn("frixel-write", move |shared| shared.write_to(writer))?;
        Ok(link)
    }

    fn spawn(&self, name: &str, run: impl FnOnce(&Shared) + Send + 'static) -> Result<(), PortError> {
        let shared = Arc::clone(&self.shared);
        self.shared.lock().threads += 1;
        let spawned = thread::Builder::new().name(name.into()).spawn(move || {
            run(&shared);
            shared.thread_ended();
        });
        match spawned {
            Ok(_) => Ok(()),
            Err(error) => {
                self.shared.thread_ended();
                Err(PortError::NotOpened {
                    port: self.path.clone(),
                    reason: format!("no thread could be started: {error}"),
                })
            }
        }
    }

    fn check_open(&self, state: &State) -> Result<(), LinkClosed> {
        match &state.closed {
            None => Ok(()),
            Some(reason) => Err(LinkClosed { port: self.path.clone(), reason: reason.clone() }),
        }
    }
}

impl Link for SerialLink {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        let mut state = self.shared.lock();
        self.check_open(&state)?;
        state.queue(frame);
        state.pings.leave_call(self.now());
        self.shared.queued.notify_one();
        Ok(state.written.bytes)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let mut state = self.shared.lock();
        state.pings.enter_call();
        // Wake the writing thread, which may have stopped pinging.
        self.shared.queued.notify_one();
        let (mut state, _) = self
            .shared
            .arrived
            .wait_timeout_while(state, wait, |state| state.receive_buffer.is_empty() && state.closed.is_none())
            .unwrap_or_else(PoisonError::into_inner);
        state.pings.leave_call(self.now());
        // Bytes that arrived before the link closed are still delivered.
        if state.receive_buffer.is_empty() {
            self.check_open(&state)?;
        }
        buffer.append(&mut state.receive_buffer);
        Ok(())
    }

    fn now(&self) -> Duration {
        self.opened.elapsed()
    }

    fn keep_alive(&mut self, period: Duration) {
        self.shared.lock().pings.set_period(period);
        self.shared.queued.notify_one();
    }

    fn set_shutdown_frames(&mut self, frames: Vec<u8>) {
        self.shutdown_frames = frames;
    }

    fn written(&self) -> Written {
        self.shared.lock().written
    }

    fn name(&self) -> &str {
        &self.path
    }
}

impl Drop for SerialLink {
    fn drop(&mut self) {
        let mut state = self.shared.lock();
        if !self.shutdown_frames.is_empty() {
            state.queue(&self.shutdown_frames);
        }
        state.closing = true;
        self.shared.queued.notify_one();
        // A thread blocked in the operating system ends later, and then closes the port.
        let _ = self.shared.ended.wait_timeout_while(state, DROP_WAIT, |state| state.threads > 0);
    }
}
