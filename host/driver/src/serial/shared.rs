//! What the two threads behind a serial port do, and what they share with the link.

use std::io::{self, Read, Write};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use serialport::SerialPort;

use super::super::link::{LEASH, Written};

/// Bytes kept for a caller who does not read: 20 seconds of telemetry at 1 kHz. What comes on top is lost.
const INBOX_MAX_LEN: usize = 1 << 20;

/// The port's buffers, and the two threads' work on them.
pub(super) struct Shared {
    state: Mutex<State>,
    /// Bytes arrived, or the link closed.
    pub(super) arrived: Condvar,
    /// There is something to write, or the keep-alive changed, or the link is closing.
    pub(super) queued: Condvar,
    /// A thread has ended and let go of the port.
    pub(super) ended: Condvar,
}

pub(super) struct State {
    pub(super) inbox: Vec<u8>,
    outbox: Vec<u8>,
    pub(super) written: Written,
    last_write: Instant,
    keep_alive: Option<(Vec<u8>, Duration)>,
    /// When the application last came out of a call; `None` while it is in one that waits.
    last_call: Option<Instant>,
    /// Why no more bytes come or go.
    pub(super) closed: Option<String>,
    /// The link is being dropped.
    pub(super) closing: bool,
    pub(super) threads: u8,
}

impl Shared {
    pub(super) fn new(opened: Instant) -> Self {
        Self {
            state: Mutex::new(State {
                inbox: Vec::new(),
                outbox: Vec::new(),
                written: Written::default(),
                last_write: opened,
                keep_alive: None,
                last_call: Some(opened),
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
                    let room = INBOX_MAX_LEN - state.inbox.len();
                    state.inbox.extend(bytes.iter().take(len.min(room)));
                    self.arrived.notify_one();
                }
                Err(error) if is_passing(&error) => {}
                Err(error) => return self.close(state, error.to_string()),
            }
        }
    }

    pub(super) fn write_to(&self, mut port: Box<dyn SerialPort>) {
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
            state = match state.keep_alive_due_in(Instant::now()) {
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

    pub(super) fn thread_ended(&self) {
        self.lock().threads -= 1;
        self.ended.notify_one();
    }
}

impl State {
    pub(super) fn queue(&mut self, frame: &[u8]) {
        self.outbox.extend_from_slice(frame);
        self.written.add(frame);
        self.last_write = Instant::now();
    }

    pub(super) fn keep_alive(&mut self, frame: Vec<u8>, period: Duration) {
        self.keep_alive = Some((frame, period));
    }

    /// The application is in a call that waits.
    pub(super) fn enter_call(&mut self) {
        self.last_call = None;
    }

    /// The application is in no call from now on.
    pub(super) fn leave_call(&mut self, now: Instant) {
        self.last_call = Some(now);
    }

    fn queue_keep_alive(&mut self) {
        if let Some((frame, period)) = self.keep_alive.take() {
            self.queue(&frame);
            self.keep_alive = Some((frame, period));
        }
    }

    /// Time until the keep-alive frame is to be sent; `None` when it is not, until the application calls again.
    fn keep_alive_due_in(&self, now: Instant) -> Option<Duration> {
        let (_, period) = self.keep_alive.as_ref()?;
        let on_leash = self.last_call.is_none_or(|last_call| now.saturating_duration_since(last_call) < LEASH);
        on_leash.then(|| period.saturating_sub(now.saturating_duration_since(self.last_write)))
    }
}

fn is_passing(error: &io::Error) -> bool {
    use io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    matches!(error.kind(), Interrupted | TimedOut | WouldBlock)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: Duration = Duration::from_millis(5);

    /// A link that wrote and was called last at the time that is given with it.
    fn pinging() -> (Shared, Instant) {
        let opened = Instant::now();
        let shared = Shared::new(opened);
        shared.lock().keep_alive(vec![0], PERIOD);
        (shared, opened)
    }

    #[test]
    fn the_keep_alive_ends_a_leash_after_the_last_call() {
        let (shared, opened) = pinging();
        let state = shared.lock();
        assert_eq!(state.keep_alive_due_in(opened), Some(PERIOD));
        assert_eq!(state.keep_alive_due_in(opened + LEASH.saturating_sub(PERIOD)), Some(Duration::ZERO));
        for late in [LEASH, LEASH + PERIOD, 1000 * LEASH] {
            assert_eq!(state.keep_alive_due_in(opened + late), None, "{late:?} after the last call");
        }
    }

    #[test]
    fn a_call_that_waits_is_no_silence_and_the_next_one_begins_anew() {
        let (shared, opened) = pinging();
        let mut state = shared.lock();
        state.enter_call();
        assert_eq!(state.keep_alive_due_in(opened + 1000 * LEASH), Some(Duration::ZERO));
        state.leave_call(opened + 1000 * LEASH);
        assert_eq!(state.keep_alive_due_in(opened + (1001 * LEASH).saturating_sub(PERIOD)), Some(Duration::ZERO));
        assert_eq!(state.keep_alive_due_in(opened + 1001 * LEASH), None);
    }
}
