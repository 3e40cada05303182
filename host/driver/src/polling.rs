//! A [`Link`] over any byte stream, without a thread.

use std::time::Duration;

use super::error::LinkClosed;
use super::keep_alive::KeepAlive;
use super::link::{Link, Written};

/// A byte stream to one board, and the clock of its deadlines.
///
/// For example a TCP connection, a browser's serial port, or a simulated line with a virtual clock.
pub trait ByteStream {
    /// Queues bytes for sending, without waiting for the other end to take them.
    fn write(&mut self, bytes: &[u8]) -> Result<(), LinkClosed>;

    /// Appends the bytes that have arrived to `buffer`. Returns as soon as there are any, or without any once `wait`
    /// has passed on [`Self::now`].
    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed>;

    /// Time since a fixed moment. It never decreases.
    fn now(&self) -> Duration;

    /// The stream's name in messages.
    fn name(&self) -> &str;
}

/// A [`Link`] that pings only while it is being read.
///
/// An application over such a link must call [`Device::wait`](crate::Device::wait) or
/// [`Device::keep_alive`](crate::Device::keep_alive) often enough for the board's host timeout. Pings end when the
/// application stops calling, so the link needs no [`KEEP_ALIVE_TIMEOUT`](crate::KEEP_ALIVE_TIMEOUT).
///
/// ```
/// use std::time::Duration;
/// use frixel_driver::{ByteStream, Device, DeviceError, LinkClosed, PollingLink};
///
/// /// A line without a board. Each wait passes at once, on the line's own clock.
/// struct DeadLine(Duration);
///
/// impl ByteStream for DeadLine {
///     fn write(&mut self, _: &[u8]) -> Result<(), LinkClosed> {
///         Ok(())
///     }
///     fn read(&mut self, _: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
///         self.0 += wait;
///         Ok(())
///     }
///     fn now(&self) -> Duration {
///         self.0
///     }
///     fn name(&self) -> &str {
///         "a dead line"
///     }
/// }
///
/// let error = Device::connect(PollingLink::new(DeadLine(Duration::ZERO))).err();
/// assert!(matches!(error, Some(DeviceError::NoHello { .. })));
/// ```
pub struct PollingLink<S: ByteStream> {
    stream: S,
    written: Written,
    pings: KeepAlive,
    shutdown_frames: Vec<u8>,
}

impl<S: ByteStream> PollingLink<S> {
    /// Creates a link over `stream`, without pings.
    pub fn new(stream: S) -> Self {
        let mut pings = KeepAlive::default();
        pings.wrote(stream.now());
        Self { stream, written: Written::default(), pings, shutdown_frames: Vec::new() }
    }

    /// The underlying stream.
    pub fn stream_mut(&mut self) -> &mut S {
        &mut self.stream
    }

    fn send(&mut self, frame: &[u8]) -> Result<(), LinkClosed> {
        self.stream.write(frame)?;
        self.written.add(frame);
        self.pings.wrote(self.stream.now());
        Ok(())
    }

    /// Sends a ping if one is due, and returns the time at which to send the next one.
    fn keep_board_alive(&mut self) -> Result<Option<Duration>, LinkClosed> {
        let now = self.stream.now();
        if self.pings.due_at(now).is_some_and(|due| due <= now) {
            let ping = self.pings.next_ping(now);
            self.send(&ping)?;
        }
        Ok(self.pings.due_at(now))
    }
}

impl<S: ByteStream> Link for PollingLink<S> {
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed> {
        self.send(frame)?;
        Ok(self.written.bytes)
    }

    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed> {
        let deadline = self.stream.now() + wait;
        let len_before = buffer.len();
        loop {
            let next_ping = self.keep_board_alive()?;
            let wake_at = next_ping.map_or(deadline, |next_ping| next_ping.min(deadline));
            let heard = buffer.len();
            self.stream.read(buffer, wake_at.saturating_sub(self.stream.now()))?;
            self.pings.hear(buffer.get(heard..).unwrap_or_default(), self.stream.now());
            if buffer.len() > len_before || self.stream.now() >= deadline {
                return Ok(());
            }
        }
    }

    fn now(&self) -> Duration {
        self.stream.now()
    }

    fn keep_alive(&mut self, period: Duration) {
        self.pings.set_period(period);
    }

    fn set_shutdown_frames(&mut self, frames: Vec<u8>) {
        self.shutdown_frames = frames;
    }

    fn written(&self) -> Written {
        self.written
    }

    fn name(&self) -> &str {
        self.stream.name()
    }
}

impl<S: ByteStream> Drop for PollingLink<S> {
    fn drop(&mut self) {
        if !self.shutdown_frames.is_empty() {
            // No caller is left to report an error to; the board's host timeout sets the output to zero.
            let _ = self.stream.write(&self.shutdown_frames);
        }
    }
}
