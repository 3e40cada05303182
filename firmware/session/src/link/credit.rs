//! Credit: the number of bytes that the host may have in flight (`PROTOCOL.md`, section 9).

/// Counts the bytes sent by the host, and checks whether they are within its credit.
///
/// All counts are modulo 2^32 and restart with a hello. Bytes beyond the credit are not counted: the host treats them
/// as lost on the line, and the next answer corrects its count.
pub(crate) struct Credit {
    window: u32,
    /// Bytes received within the credit: the count reported to the host.
    received: u32,
    /// The count in the newest report that was queued.
    reported: u32,
    /// The largest count that may have reached the host.
    granted_from: u32,
}

impl Credit {
    pub(crate) const fn new(window: u16) -> Self {
        Self { window: window as u32, received: 0, reported: 0, granted_from: 0 }
    }

    /// Resets the counts, as a hello request does on both sides.
    pub(crate) fn restart(&mut self) {
        (self.received, self.reported, self.granted_from) = (0, 0, 0);
    }

    /// Takes `count` bytes off the line. Returns whether all of them are within the credit.
    pub(crate) fn take(&mut self, count: usize) -> bool {
        let under_way = self.received.wrapping_sub(self.granted_from);
        let counted = self.window.saturating_sub(under_way).min(count as u32);
        self.received = self.received.wrapping_add(counted);
        counted as usize == count
    }

    /// The count for a report.
    pub(crate) fn received(&self) -> u32 {
        self.received
    }

    /// Records that a report with the current count was queued.
    pub(crate) fn reported(&mut self) {
        self.reported = self.received;
    }

    /// Records that bytes were sent, so that every queued report may be on its way to the host. The excess credit is at
    /// most the size of the transmit queue; while nothing is sent, no credit is granted.
    pub(crate) fn grant_reported(&mut self) {
        self.granted_from = self.reported;
    }
}
