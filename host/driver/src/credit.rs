//! Credit: how much the host may send before the board has said that it got what was sent before.

/// Counts bytes on the way to the board.
///
/// Positions count the bytes that the host wrote since the link was opened. The board counts what it received since the hello; the two counts
/// drift apart by what the line loses or adds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Credit {
    window: u64,
    /// Position up to which bytes have reached the board or are lost.
    settled: u64,
    /// Position of the host's count less that of the board's, with both at the same place on the line.
    offset: i64,
    /// Bytes that the board received since the hello.
    received: u64,
}

/// The board's count went backwards, which only a restart does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CountRestarted;

impl Credit {
    /// The board answered a hello and counts from zero; the host has written `written` bytes.
    pub(super) fn new(window: u16, written: u64) -> Self {
        Self { window: window.into(), settled: written, offset: written as i64, received: 0 }
    }

    /// Takes the board's count, modulo 2^32.
    pub(super) fn received(&mut self, received_bytes: u32, written: u64) -> Result<(), CountRestarted> {
        let step = received_bytes.wrapping_sub(self.received as u32);
        if step > u32::MAX / 2 {
            return Err(CountRestarted);
        }
        self.received += u64::from(step);
        self.settle(written);
        Ok(())
    }

    /// Takes the answer to a request, whose count [`Self::received`] was given just before.
    ///
    /// The line keeps the order, so everything before the end of the request is off the line. If nothing was written after it, the board's
    /// count stands for exactly that position; otherwise it may run ahead of it, and only a loss is certain.
    pub(super) fn answered(&mut self, request_end: u64, written: u64) {
        let offset = request_end as i64 - self.received as i64;
        if request_end == written || offset > self.offset {
            self.offset = offset;
        }
        self.settle(written);
    }

    fn settle(&mut self, written: u64) {
        let position = (self.received as i64 + self.offset).max(0) as u64;
        self.settled = self.settled.max(position.min(written));
    }

    /// Position up to which bytes have reached the board or are lost.
    pub(super) fn settled(&self) -> u64 {
        self.settled
    }

    /// Whether `len` more bytes keep what is on the way within the window, with `reserve` bytes left over. A window too small for that takes
    /// one frame at a time.
    pub(super) fn allows(&self, len: usize, reserve: usize, written: u64) -> bool {
        let under_way = written.saturating_sub(self.settled);
        let reserve = if under_way == 0 { 0 } else { reserve as u64 };
        under_way + len as u64 + reserve <= self.window
    }
}

#[cfg(test)]
mod tests;
