//! The state that a serial link shares with its two threads, and the work of those threads.

use std::io::{self, Read, Write};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serialport::SerialPort;

use crate::keep_alive::KeepAlive;
use crate::link::Written;

/// Largest number of stored received bytes: 20 s of telemetry at 1 kHz. Further bytes are dropped.
const RECEIVE_BUFFER_MAX_LEN: usize = 1 << 20;

/// The shared state, and signals for its changes.
pub(super) struct Shared {
    state: Mutex<State>,
    /// Signals that bytes have arrived, or that the link has closed.
    pub(super) arrived: Condvar,
    /// Signals that bytes were queued, the next ping may be due earlier, or the link is closing.
    pub(super) queued: Condvar,
    /// Signals that a thread has ended and closed its side of the port.
    pub(super) ended: Condvar,
}

pub(super) struct State {
    pub(super) receive_buffer: Vec<u8>,
    transmit_queue: Vec<u8>,
    pub(super) written: Written,
    opened: Instant,
    pub(super) pings: KeepAlive,
    /// Reason why the link has closed.
    pub(super) closed: Option<String>,
    /// Whether the link is being dropped.
    pub(super) closing: bool,
    pub(super) threads: u8,
}

impl Shared {
    pub(super) fn new(opened: Instant) -> Self {
        let mut pings = KeepAlive::default();
        // The writing thread pings outside of calls.
        pings.leave_call(Duration::ZERO);
        Self {
            state: Mutex::new(State {
                receive_buffer: Vec::new(),
                transmit_queue: Vec::new(),
                written: Written::default(),
                opened,
                pings,
                closed: None,
                closing: false,
                threads: 0,
            }),
            arrived: Condvar::new(),
            queued: Condvar::new(),
            ended: Condvar::new(),
        }
    }

    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn read_from(&self, mut port: Box<dyn SerialPort>) {
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
                    let now = state.opened.elapsed();
                    if state.pings.hear(bytes.get(..len).unwrap_or_default(), now) {
                        // The next ping may be due earlier.
                        self.queued.notify_one();
                    }
                    let room = RECEIVE_BUFFER_MAX_LEN - state.receive_buffer.len();
                    state.receive_buffer.extend(bytes.iter().take(len.min(room)));
                    self.arrived.notify_one();
                }
                Err(error) if is_temporary(&error) => {}
                Err(error) => return self.close(state, error.to_string()),
            }
        }
    }

    pub(super) fn write_to(&self, mut port: Box<dyn SerialPort>) {
        while let Some(bytes) = self.next_to_write() {
            if let Err(error) = port.write_all(&bytes) {
                return self.close(self.lock(), format!("it accepts no more bytes: {error}"));
            }
        }
    }

    /// Waits for bytes to write, pings included. Returns `None` when the link closes and everything is
    /// written.
    fn next_to_write(&self) -> Option<Vec<u8>> {
        let mut state = self.lock();
        loop {
            if state.closed.is_some() {
                return None;
            }
            if !state.transmit_queue.is_empty() {
                return Some(std::mem::take(&mut state.transmit_queue));
            }
            if state.closing {
                return None;
            }
            state = match state.ping_due_in() {
                Some(Duration::ZERO) => {
                    state.queue_ping();
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

    pub(super) fn thread_ended(&self) {
        self.lock().threads -= 1;
        self.ended.notify_one();
    }
}

impl State {
    pub(super) fn queue(&mut self, frame: &[u8]) {
        self.transmit_queue.extend_from_slice(frame);
        self.written.add(frame);
        self.pings.wrote(self.opened.elapsed());
    }

    fn queue_ping(&mut self) {
        let ping = self.pings.next_ping(self.opened.elapsed());
        self.queue(&ping);
    }

    /// Time until the next ping; `None` if there is none.
    fn ping_due_in(&self) -> Option<Duration> {
        let now = self.opened.elapsed();
        self.pings.due_at(now).map(|due_at| due_at.saturating_sub(now))
    }
}

fn is_temporary(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), Interrupted | TimedOut | WouldBlock)
}
