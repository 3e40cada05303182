//! A flash that takes its time, and that a reset interrupts.

use frixel_session::store::{Flash, Operation, WORD_LEN};

/// Looks at an operation until it is done.
const BUSY_LOOKS: u32 = 2;
/// What an erasure or a write that was interrupted leaves.
const TORN: u8 = 0x5a;

/// The memory, of so many pages, erased at first.
pub struct SimulatedFlash<const PAGES: usize, const PAGE_LEN: usize> {
    bytes: Vec<u8>,
    busy: u32,
    /// First byte and length of what the operation under way changes.
    under_way: (usize, usize),
}

impl<const PAGES: usize, const PAGE_LEN: usize> SimulatedFlash<PAGES, PAGE_LEN> {
    pub(crate) fn new() -> Self {
        Self { bytes: vec![0xff; PAGES * PAGE_LEN], busy: 0, under_way: (0, 0) }
    }

    /// The board resets: an operation that is under way leaves neither the old nor the new.
    pub(crate) fn reset(&mut self) {
        if self.busy > 0 {
            let (start, len) = self.under_way;
            self.bytes[start + len / 2..start + len].fill(TORN);
        }
        self.busy = 0;
    }

    pub(crate) fn erase_all(&mut self) {
        self.bytes.fill(0xff);
    }

    /// What it holds now.
    #[cfg(unix)]
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    fn begin(&mut self, start: usize, len: usize) {
        assert_eq!(self.busy, 0, "an operation is under way");
        self.busy = BUSY_LOOKS;
        self.under_way = (start, len);
    }
}

impl<const PAGES: usize, const PAGE_LEN: usize> Flash for SimulatedFlash<PAGES, PAGE_LEN> {
    const PAGE_LEN: u32 = PAGE_LEN as u32;

    fn read(&self, offset: u32, bytes: &mut [u8]) -> bool {
        let start = offset as usize;
        self.bytes.get(start..start + bytes.len()).is_some_and(|found| {
            bytes.copy_from_slice(found);
            self.busy == 0
        })
    }

    fn begin_erase(&mut self, page: u32) {
        let start = page as usize * PAGE_LEN;
        self.begin(start, PAGE_LEN);
        self.bytes[start..start + PAGE_LEN].fill(0xff);
    }

    fn begin_write(&mut self, offset: u32, word: [u8; WORD_LEN]) {
        let start = offset as usize;
        self.begin(start, WORD_LEN);
        let place = &mut self.bytes[start..start + WORD_LEN];
        assert!(place.iter().all(|byte| *byte == 0xff), "a word is written twice");
        place.copy_from_slice(&word);
    }

    fn operation(&mut self) -> Operation {
        self.busy = self.busy.saturating_sub(1);
        if self.busy > 0 { Operation::Busy } else { Operation::Done }
    }
}
