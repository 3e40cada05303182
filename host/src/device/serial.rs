//! A serial port as a [`Link`].
//!
//! Two threads stand behind it. One reads. The other writes, one frame after the other, and sends the keep-alive frame when there was nothing
//! to write for its period. No call waits for the operating system to take bytes: a port whose other end has stopped reading can block a write
//! for ever, and then only the writing thread stands still.

use std::io::{self, Read, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serialport::{ClearBuffer, SerialPort};

use super::error::{LinkClosed, PortError};
use super::link::{Link, Written};
use super::ports::why_not_opened;

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
/// Bytes kept for a caller who does not read: 20 seconds of telemetry at 1 kHz. What comes on top is lost.
const INBOX_MAX_LEN: usize = 1 << 20;

/// A serial port. Exclusive: a second program that opens it is told that it is in use.
///
/// When the cable is pulled the link closes, and every later call says so. The port closes when the link is dropped.
pub struct SerialLink {
    path: String,
    opened: Instant,
    shared: Arc<Shared>,
    farewell: Vec<u8>,
}

struct Shared {
    state: Mutex<State>,
    /// Bytes arrived, or the link closed.
    arrived: Condvar,
    /// There is something to write, or the keep-alive changed, or the link is closing.
    queued: Condvar,
    /// A thread has ended and let go of the port.
    ended: Condvar,
}

struct State {
    inbox: Vec<u8>,
    outbox: Vec<u8>,
    written: Written,
    last_write: Instant,
    keep_alive: Option<(Vec<u8>, Duration)>,
    /// Why no more bytes come or go.
    closed: Option<String>,
    /// The link is being dropped.
    closing: bool,
    threads: u8,
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
        self.shared.queued.notify_one();
        Ok(state.written.bytes)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let state = self.shared.lock();
        let (mut state, _) = self
            .shared
            .arrived
            .wait_timeout_while(state, wait, |state| state.inbox.is_empty() && state.closed.is_none())
            .unwrap_or_else(PoisonError::into_inner);
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
        self.shared.lock().keep_alive = Some((frame, period));
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

impl Shared {
    fn new(opened: Instant) -> Self {
        Self {
            state: Mutex::new(State {
                inbox: Vec::new(),
                outbox: Vec::new(),
                written: Written::default(),
                last_write: opened,
                keep_alive: None,
                closed: None,
                closing: false,
                threads: 0,
            }),
            arrived: Condvar::new(),
            queued: Condvar::new(),
            ended: Condvar::new(),
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn read_from(&self, mut port: Box<dyn SerialPort>) {
        let mut bytes = [0; 1024];
        loop {
            let outcome = port.read(&mut bytes);
            let mut state = self.lock();
            if state.closing || state.closed.is_some() {
                return;
            }
            match outcome {
                Ok(0) => return self.close(state, "the other end hung up".into()),
                Ok(len) => {
                    let room = INBOX_MAX_LEN - state.inbox.len();
                    state.inbox.extend(bytes.iter().take(len.min(room)));
                    self.arrived.notify_one();
                }
                Err(error) if is_passing(&error) => {}
                Err(error) => return self.close(state, error.to_string()),
            }
        }
    }

    fn write_to(&self, mut port: Box<dyn SerialPort>) {
        while let Some(bytes) = self.next_to_write() {
            if let Err(error) = port.write_all(&bytes) {
                return self.close(self.lock(), format!("it takes no more bytes: {error}"));
            }
        }
    }

    /// Waits for bytes to write, those of the keep-alive among them. `None` when all is written and the link closes.
    fn next_to_write(&self) -> Option<Vec<u8>> {
        let mut state = self.lock();
        loop {
            if state.closed.is_some() {
                return None;
            }
            if !state.outbox.is_empty() {
                return Some(std::mem::take(&mut state.outbox));
            }
            if state.closing {
                return None;
            }
            state = match state.keep_alive_due_in() {
                Some(Duration::ZERO) => {
                    state.queue_keep_alive();
                    state
                }
                Some(wait) => {
                    let woken = self.queued.wait_timeout(state, wait);
                    woken.unwrap_or_else(PoisonError::into_inner).0
                }
                None => self.queued.wait(state).unwrap_or_else(PoisonError::into_inner),
            };
        }
    }

    fn close(&self, mut state: MutexGuard<'_, State>, reason: String) {
        state.closed.get_or_insert(reason);
        self.arrived.notify_one();
        self.queued.notify_one();
    }

    fn thread_ended(&self) {
        self.lock().threads -= 1;
        self.ended.notify_one();
    }
}

impl State {
    fn queue(&mut self, frame: &[u8]) {
        self.outbox.extend_from_slice(frame);
        self.written.add(frame);
        self.last_write = Instant::now();
    }

    fn queue_keep_alive(&mut self) {
        if let Some((frame, period)) = self.keep_alive.take() {
            self.queue(&frame);
            self.keep_alive = Some((frame, period));
        }
    }

    fn keep_alive_due_in(&self) -> Option<Duration> {
        let (_, period) = self.keep_alive.as_ref()?;
        Some(period.saturating_sub(self.last_write.elapsed()))
    }
}

fn is_passing(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), Interrupted | TimedOut | WouldBlock)
}
