//! The part of the flash that holds the stores: behind the first MiB, which belongs to the image.
//!
//! Unlike that of the NUCLEO, the flash has one bank, and the ROM's functions wait: an erasure takes 45 ms, and 400 ms
//! at most (data sheet of the W25Q16JV, "AC Electrical Characteristics", unread), a word some 0.1 ms and at most 4. The
//! main loop waits as long. The stores are written only while the board is disarmed, and the tick, all of which is in
//! RAM, goes on. A write that power cuts leaves any bits, which the stores' checksums find.

use core::ptr;

use frixel_drivers::rp2::STORES_OFFSET;
use frixel_session::store::{Flash, Operation, WORD_LEN};

use crate::rom::{FlashFunctions, PAGE_LEN, SECTOR_LEN};
use crate::tick::SHARED;
use crate::unique_number::unique_number;
use crate::watchdog;

/// Where the processor sees the flash.
const FLASH: u32 = 0x1000_0000;
/// Pages of the stores.
pub const PAGES: u32 = 64;
const LEN: u32 = PAGES * StoreFlash::PAGE_LEN;

/// The flash behind the image.
pub struct StoreFlash {
    functions: FlashFunctions,
    /// The last operation has not left what it should.
    failed: bool,
    /// Tick at the last operation.
    fed_at_tick: u32,
}

impl StoreFlash {
    /// Takes the flash. `None` if the ROM does not have the functions.
    pub fn new() -> Option<Self> {
        FlashFunctions::find().map(|functions| Self { functions, failed: false, fed_at_tick: 0 })
    }

    /// A number that no other board has.
    pub fn unique_number(&self) -> [u8; 8] {
        unique_number(&self.functions)
    }
}

impl Flash for StoreFlash {
    const PAGE_LEN: u32 = SECTOR_LEN;

    fn read(&self, offset: u32, bytes: &mut [u8]) -> bool {
        let end = offset.checked_add(bytes.len() as u32);
        if end.is_none_or(|end| end > LEN) {
            return false;
        }
        for (address, byte) in (FLASH + STORES_OFFSET + offset..).zip(bytes) {
            // SAFETY: the address lies in the stores, as checked above, and any byte there is valid.
            *byte = unsafe { ptr::with_exposed_provenance::<u8>(address as usize).read_volatile() };
        }
        true
    }

    fn begin_erase(&mut self, page: u32) {
        if page >= PAGES {
            return;
        }
        self.feed_watchdog();
        self.functions.erase(STORES_OFFSET + page * SECTOR_LEN);
        self.failed = !(0..SECTOR_LEN).step_by(WORD_LEN).all(|place| self.holds(page * SECTOR_LEN + place, [0xff; 8]));
    }

    fn begin_write(&mut self, offset: u32, word: [u8; WORD_LEN]) {
        if offset > LEN - WORD_LEN as u32 || !offset.is_multiple_of(WORD_LEN as u32) {
            return;
        }
        let mut page = [0xff; PAGE_LEN];
        let place = offset as usize % PAGE_LEN;
        if let Some(bytes) = page.get_mut(place..place + WORD_LEN) {
            bytes.copy_from_slice(&word);
        }
        self.feed_watchdog();
        self.functions.program(STORES_OFFSET + offset - place as u32, &page);
        self.failed = !self.holds(offset, word);
    }

    fn operation(&mut self) -> Operation {
        if core::mem::take(&mut self.failed) { Operation::Failed } else { Operation::Done }
    }
}

impl StoreFlash {
    /// Leaves time for an operation, unless the tick has stood still since the last one: then the watchdog goes on to
    /// count, however many operations a store takes.
    fn feed_watchdog(&mut self) {
        let now_tick = SHARED.count();
        if now_tick != self.fed_at_tick {
            self.fed_at_tick = now_tick;
            watchdog::feed();
        }
    }

    fn holds(&self, offset: u32, word: [u8; WORD_LEN]) -> bool {
        let mut read = [0; WORD_LEN];
        self.read(offset, &mut read) && read == word
    }
}
