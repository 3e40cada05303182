//! The [`Link`], which carries bytes to a board and back.

use std::time::Duration;

use super::error::LinkClosed;
use super::keep_alive::sequence_of_ping;

/// A connection to one board, with its own clock.
///
/// [`Device`](crate::Device) runs the protocol over it. [`PollingLink`](crate::PollingLink) implements it over any byte
/// stream; with the feature `native`, `SerialLink` is a serial port. The clock may be virtual: a simulated board can
/// then pass a deadline of a second at once.
pub trait Link {
    /// Queues one frame for sending, without waiting for the line to take it.
    ///
    /// Returns the number of bytes written since the link was opened, keep-alive frames included. Frames are sent in
    /// the order of this count.
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed>;

    /// Appends the bytes that have arrived to `buffer`. Returns as soon as there are any, or without any after `wait`.
    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed>;

    /// Time on the link's clock: wall time for a serial port, virtual time for a simulated board.
    fn now(&self) -> Duration;

    /// Pings the board from now on whenever nothing was written for `period`, by the rules of
    /// [`KeepAlive`](crate::KeepAlive). Replaces the previous period.
    ///
    /// A ping reports to the board that the application is running, so a link must not send it for an application that
    /// hangs: sending ends [`KEEP_ALIVE_TIMEOUT`](crate::KEEP_ALIVE_TIMEOUT) after the last [`Self::write`] or
    /// [`Self::read`], and resumes with the next of these calls. A link that sends only inside these calls needs no
    /// timeout.
    fn keep_alive(&mut self, period: Duration);

    /// Sets the frames that the link sends when it is dropped, as far as that is possible without waiting. The default
    /// implementation sends nothing, which suits a link whose board ends with it.
    fn set_shutdown_frames(&mut self, frames: Vec<u8>) {
        drop(frames);
    }

    /// Frames and bytes written since the link was opened, keep-alive frames included.
    fn written(&self) -> Written;

    /// The link's name in messages: the path of a serial port.
    fn name(&self) -> &str;
}

/// Frames and bytes that were written to a link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Number of frames.
    pub frames: u64,
    /// Number of bytes, encoding and checksums included.
    pub bytes: u64,
    /// Sequence number of the last frame, if [`KeepAlive`](crate::KeepAlive) made it.
    pub last_ping: Option<u16>,
}

impl Written {
    /// Counts one frame.
    pub fn add(&mut self, frame: &[u8]) {
        self.frames += 1;
        self.bytes += frame.len() as u64;
        self.last_ping = sequence_of_ping(frame);
    }
}
