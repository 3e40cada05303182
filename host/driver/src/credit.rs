//! Credit: the number of bytes that the host may have in flight to the board.

/// Counts the bytes on the way to the board.
///
/// Positions count the bytes that the host has written since the link was opened. The board counts the bytes that it
/// has received since the hello. The two counts differ by the bytes that the line loses or adds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Credit {
    window: u64,
    /// Position up to which bytes have reached the board or are lost.
    settled: u64,
    /// The host's count minus the board's, at the same place on the line.
    offset: i64,
    /// Bytes that the board received since the hello.
    received: u64,
}

/// The board's count decreased, which only a restart of the board or another host's hello can cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CountRestarted;

impl Credit {
    /// Starts after a hello: the board counts from zero, and the host has written `written` bytes.
    pub(super) fn new(window: u16, written: u64) -> Self {
        Self { window: window.into(), settled: written, offset: written as i64, received: 0 }
    }

    /// Updates the board's count, which it sends modulo 2^32.
    pub(super) fn received(&mut self, received_bytes: u32, written: u64) -> Result<(), CountRestarted> {
        let step = received_bytes.wrapping_sub(self.received as u32);
        if step > u32::MAX / 2 {
            return Err(CountRestarted);
        }
        self.received += u64::from(step);
        self.settle(written);
        Ok(())
    }

    /// Corrects the credit with the answer to a request that ended at position `request_end`. The caller passes the
    /// count in the answer to [`Self::received`] first.
    ///
    /// The line keeps the order, so everything before the end of the request has left the line. If nothing was written
    /// after the request, the board's count corresponds to exactly that position. Otherwise the count may include later
    /// bytes, and only a loss is certain.
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

    /// Whether the window has room for `len` bytes and `reserve` bytes beyond them. A window too small for both takes
    /// one frame at a time.
    pub(super) fn allows(&self, len: usize, reserve: usize, written: u64) -> bool {
        let under_way = written.saturating_sub(self.settled);
        let reserve = if under_way == 0 { 0 } else { reserve as u64 };
        under_way + len as u64 + reserve <= self.window
    }
}

#[cfg(test)]
mod tests;
