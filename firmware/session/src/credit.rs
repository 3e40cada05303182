//! Credit: how many bytes the host may have under way (`PROTOCOL.md`, section 9).

/// Counts the bytes that the host sends, and tells those within its credit from those beyond it.
///
/// All counts are modulo 2^32 and start anew with a hello. What is beyond the credit is not counted: to the host, it is
/// lost on the line, and the next answer puts its own count right.
pub(crate) struct Credit {
    window: u32,
    /// Bytes received within the credit: what reports tell the host.
    received: u32,
    /// The count in the newest report that was queued.
    reported: u32,
    /// The largest count that the host can have been told.
    granted_from: u32,
}

impl Credit {
    pub(crate) const fn new(window: u16) -> Self {
        Self { window: window as u32, received: 0, reported: 0, granted_from: 0 }
    }

    /// A hello request sets the counts of both sides to zero.
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

    /// A report with the count of now was queued.
    pub(crate) fn reported(&mut self) {
        self.reported = self.received;
    }

    /// The line takes bytes: every report that is queued may be on its way to the host. That is generous by no more than
    /// the transmit queue holds; while the line takes nothing, no credit is granted.
    pub(crate) fn grant_reported(&mut self) {
        self.granted_from = self.reported;
    }
}
