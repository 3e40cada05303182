//! A serial port as a [`Link`].
//!
//! Two threads stand behind it. One reads. The other writes, one frame after the other, and sends the keep-alive frame when there was nothing
//! to write for its period and the application has not been away for longer than the leash. No call waits for the operating system to take bytes: a port whose other end has stopped reading can block a write
//! for ever, and then only the writing thread stands still.

mod shared;

use std::sync::{Arc, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serialport::ClearBuffer;

use super::error::{LinkClosed, PortError};
use super::link::{Link, Written};
use super::ports::why_not_opened;
use shared::{Shared, State};

/// Line rate in bits a second, unless a board says otherwise. Pseudo-terminals and native USB ignore it.
pub const DEFAULT_BAUD: u32 = 2_000_000;

/// How long a port may still belong to a program that has just ended: a pseudo-terminal stays exclusive until its server sees that the client is gone.
const BUSY_PATIENCE: Duration = Duration::from_millis(700);
/// Time between two tries to open a port that is in use.
const BUSY_RETRY_AFTER: Duration = Duration::from_millis(20);
/// How often the reading thread looks whether it is to end.
const READ_POLL: Duration = Duration::from_millis(20);
/// How long the operating system may refuse bytes before the link counts as broken.
const WRITE_TIMEOUT: Duration = Duration::from_millis(500);
/// How long a drop waits for the last frames to go out and the port to close.
const DROP_WAIT: Duration = Duration::from_millis(50);

/// A serial port. Exclusive: a second program that opens it is told that it is in use.
///
/// When the cable is pulled the link closes, and every later call says so. The port closes when the link is dropped.
pub struct SerialLink {
    path: String,
    opened: Instant,
    shared: Arc<Shared>,
    farewell: Vec<u8>,
}

impl SerialLink {
    /// Opens the port at `path` with `baud` bits a second, and throws away what had arrived there before. Takes at most 0.7 s when the port is in
    /// use.
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
        let mut reader = serialport::new(path, baud).timeout(READ_POLL).exclusive(true).open().map_err(not_opened)?;
        reader.set_timeout(READ_POLL).map_err(not_opened)?;
        let mut writer = reader.try_clone().map_err(not_opened)?;
        writer.set_timeout(WRITE_TIMEOUT).map_err(not_opened)?;
        reader.clear(ClearBuffer::Input).map_err(not_opened)?;

        let opened = Instant::now();
        let link = Self { path: path.into(), opened, shared: Arc::new(Shared::new(opened)), farewell: Vec::new() };
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
        state.leave_call(Instant::now());
        self.shared.queued.notify_one();
        Ok(state.written.bytes)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let mut state = self.shared.lock();
        state.enter_call();
        // The keep-alive may have been at the end of its leash.
        self.shared.queued.notify_one();
        let (mut state, _) = self
            .shared
            .arrived
            .wait_timeout_while(state, wait, |state| state.inbox.is_empty() && state.closed.is_none())
            .unwrap_or_else(PoisonError::into_inner);
        state.leave_call(Instant::now());
        // What came before the cable was pulled still counts.
        if state.inbox.is_empty() {
            self.check_open(&state)?;
        }
        buffer.append(&mut state.inbox);
        Ok(())
    }

    fn now(&self) -> Duration {
        self.opened.elapsed()
    }

    fn keep_alive(&mut self, frame: Vec<u8>, period: Duration) {
        self.shared.lock().keep_alive(frame, period);
        self.shared.queued.notify_one();
    }

    fn farewell(&mut self, frames: Vec<u8>) {
        self.farewell = frames;
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
        if !self.farewell.is_empty() {
            state.queue(&self.farewell);
        }
        state.closing = true;
        self.shared.queued.notify_one();
        // A thread that the operating system does not let go ends by itself later, and the port closes then.
        let _ = self.shared.ended.wait_timeout_while(state, DROP_WAIT, |state| state.threads > 0);
    }
}
