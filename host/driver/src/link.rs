//! What carries bytes to a board and back.

use std::time::Duration;

use super::error::LinkClosed;

/// How long a link sends its keep-alive frame for an application that does not call it. After this the board hears nothing more, and puts its
/// output to zero when its host timeout is over.
pub const LEASH: Duration = Duration::from_secs(1);

/// A line to one board, with its own clock.
///
/// [`super::Device`] runs the protocol over it. A serial port is a [`super::SerialLink`]; a simulated board is a link whose clock is virtual,
/// so that a deadline of a second passes in no time.
pub trait Link {
    /// Hands one frame to the line, without waiting for the line to take it.
    ///
    /// Returns the bytes written since the link was opened, this frame and every keep-alive frame before it included.
    /// The order of this count is the order on the line.
    fn write(&mut self, frame: &[u8]) -> Result<u64, LinkClosed>;

    /// Appends what has arrived to `buffer`. Returns as soon as anything has, or with nothing when `wait` is over.
    fn read(&mut self, buffer: &mut Vec<u8>, wait: Duration) -> Result<(), LinkClosed>;

    /// Time on the link's clock: wall time for a serial port, virtual time for a simulated board.
    fn now(&self) -> Duration;

    /// From now on, sends `frame` by itself whenever nothing was written for `period`. Takes the place of the call before.
    ///
    /// It vouches for the application, so that it must not outlive it: [`LEASH`] after the last [`Self::write`] or [`Self::read`] it ends, until the next
    /// of these. A link whose clock stands still between two calls needs no leash.
    fn keep_alive(&mut self, frame: Vec<u8>, period: Duration);

    /// Sets what is sent when the link is dropped, as far as that goes without waiting. A link whose board ends with it has nothing to send.
    fn farewell(&mut self, frames: Vec<u8>) {
        drop(frames);
    }

    /// What was written since the link was opened, keep-alive frames included.
    fn written(&self) -> Written;

    /// What a person calls the line: the path of the port.
    fn name(&self) -> &str;
}

/// Count of what was handed to a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Frames.
    pub frames: u64,
    /// Bytes, all of them: encoding, checksums and zero bytes too.
    pub bytes: u64,
}

impl Written {
    /// Adds one frame.
    pub fn add(&mut self, frame: &[u8]) {
        self.frames += 1;
        self.bytes += frame.len() as u64;
    }
}
