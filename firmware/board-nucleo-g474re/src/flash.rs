//! Bank 2 of the flash, which holds the stored limits. The image runs from bank 1. Operations on bank 2 do not stall it
//! unless bank 2 is read meanwhile (RM0440, "Embedded flash memory": "Read-while-write", "Flash program and erase
//! operations").

use core::ptr;
use core::sync::atomic::{AtomicBool, Ordering, compiler_fence};

use frixel_drivers::stm32g4;
use frixel_session::store::{Flash, Operation, WORD_LEN, WritableFlash};
use stm32_metapac::FLASH;

/// First byte of bank 2.
const START: u32 = 0x0804_0000;
/// Number of pages of bank 2.
const PAGES: u32 = 128;
const LEN: u32 = PAGES * BankTwo::PAGE_LEN;
/// Keys that unlock the control register, in this order.
const KEYS: [u32; 2] = [0x4567_0123, 0xcdef_89ab];

/// Whether a word that was read had an error that cannot be corrected.
static UNREADABLE: AtomicBool = AtomicBool::new(false);
/// Whether bank 2 is being read.
static READING: AtomicBool = AtomicBool::new(false);

/// Bank 2.
pub struct BankTwo {
    under_way: bool,
}

impl BankTwo {
    /// Takes bank 2. `None` when the option bytes configure a single bank, or swap the banks.
    pub fn new() -> Option<Self> {
        let options = FLASH.optr().read();
        (options.dbank() && !options.bfb2()).then_some(Self { under_way: false })
    }

    fn unlock(&mut self) {
        if FLASH.cr().read().lock() {
            for key in KEYS {
                FLASH.keyr().write_value(key);
            }
        }
        clear_flags();
        // The flash reports an operation error only with its interrupt enabled (RM0440, "FLASH_SR": OPERR). The
        // interrupt stays masked.
        FLASH.cr().modify(|w| w.set_errie(true));
        // Errata ES0430: the data cache may be corrupted while the other bank is written.
        FLASH.acr().modify(|w| w.set_dcen(false));
        self.under_way = true;
    }
}

impl Flash for BankTwo {
    const PAGE_LEN: u32 = 2048;

    fn read(&self, offset: u32, bytes: &mut [u8]) -> bool {
        let end = offset.checked_add(bytes.len() as u32);
        if self.under_way || end.is_none_or(|end| end > LEN) {
            return false;
        }
        UNREADABLE.store(false, Ordering::Relaxed);
        READING.store(true, Ordering::Relaxed);
        compiler_fence(Ordering::SeqCst);
        for (address, byte) in (START + offset..).zip(bytes) {
            // SAFETY: the address lies in bank 2, as checked above, and any byte there is valid.
            *byte = unsafe { ptr::with_exposed_provenance::<u8>(address as usize).read_volatile() };
        }
        // The exception occurs before anything after this.
        cortex_m::asm::dsb();
        cortex_m::asm::isb();
        READING.store(false, Ordering::Relaxed);
        !UNREADABLE.load(Ordering::Relaxed)
    }
}

impl WritableFlash for BankTwo {
    fn begin_erase(&mut self, page: u32) {
        if page >= PAGES {
            return;
        }
        self.unlock();
        FLASH.cr().modify(|w| {
            w.set_per(true);
            w.set_bker(true);
            w.set_pnb(page as u8);
        });
        FLASH.cr().modify(|w| w.set_strt(true));
    }

    fn begin_write(&mut self, offset: u32, word: [u8; WORD_LEN]) {
        if offset > LEN - WORD_LEN as u32 || !offset.is_multiple_of(WORD_LEN as u32) {
            return;
        }
        self.unlock();
        FLASH.cr().modify(|w| w.set_pg(true));
        let word = u64::from_le_bytes(word);
        for (address, half) in [(START + offset, word as u32), (START + offset + 4, (word >> 32) as u32)] {
            // SAFETY: the address lies in bank 2 and is a multiple of four, as checked above; no Rust object lies
            // there.
            unsafe { ptr::with_exposed_provenance_mut::<u32>(address as usize).write_volatile(half) };
            // The halves reach the flash one after the other.
            cortex_m::asm::isb();
        }
    }

    fn operation(&mut self) -> Operation {
        if !self.under_way {
            return Operation::Done;
        }
        let status = FLASH.sr().read();
        if status.bsy() {
            return Operation::Busy;
        }
        FLASH.cr().modify(|w| {
            w.set_pg(false);
            w.set_per(false);
            w.set_lock(true);
        });
        clear_flags();
        // The cached content of this bank is invalid now.
        FLASH.acr().modify(|w| w.set_dcrst(true));
        FLASH.acr().modify(|w| w.set_dcrst(false));
        FLASH.acr().modify(|w| w.set_dcen(true));
        self.under_way = false;
        let failed = status.operr() || status.progerr() || status.wrperr() || status.pgaerr() || status.pgserr();
        if failed { Operation::Failed } else { Operation::Done }
    }
}

/// Clears all flags that are set, by writing ones.
fn clear_flags() {
    FLASH.sr().modify(|_| {});
}

/// Whether the option bytes are right for the board.
pub fn option_bytes_are_right() -> bool {
    stm32g4::option_bytes_are_right(FLASH.optr().read().0)
}

/// Returns whether a non-maskable interrupt has reported a word of bank 2 that cannot be corrected, as when power
/// failed during a write. The read that met the word then reports it (RM0440, "Error code correction (ECC)").
pub(crate) fn take_unreadable() -> bool {
    let ours = stm32g4::is_store_ecc_error(FLASH.eccr().read().0, READING.load(Ordering::Relaxed));
    if ours {
        FLASH.eccr().modify(|w| w.set_eccd(true));
        UNREADABLE.store(true, Ordering::Relaxed);
    }
    ours
}
