//! Functions of the boot ROM that erase and write the flash (RP2040, 2.8.3, "Bootrom Contents"; RP2350, 5.4, "Bootrom
//! APIs"). They are found by a code of two letters, and exist on both chips with the same arguments. They use the
//! flash's interface directly, so that nothing can be read from the flash meanwhile; this image runs from RAM.

use core::mem;
use core::ptr;

/// A function that takes nothing.
type Plain = unsafe extern "C" fn();

/// The functions.
pub(crate) struct FlashFunctions {
    connect: Plain,
    exit_xip: Plain,
    erase: unsafe extern "C" fn(offset: u32, len: u32, block_len: u32, block_command: u8),
    program: unsafe extern "C" fn(offset: u32, bytes: *const u8, len: u32),
    flush_cache: Plain,
    enter_xip: Plain,
}

/// Bytes that the functions erase, or a multiple of it.
pub(crate) const SECTOR_LEN: u32 = 4096;
/// Bytes that they write, or a multiple of it.
pub(crate) const PAGE_LEN: usize = 256;

/// Length of a block, and the flash's command that erases one, which are not used for a single sector.
const BLOCK_LEN: u32 = 1 << 16;
const ERASE_BLOCK: u8 = 0xd8;

impl FlashFunctions {
    /// Looks the functions up. `None` if the ROM has not all of them.
    pub(crate) fn find() -> Option<Self> {
        // SAFETY: these are the signatures of the functions with these codes.
        unsafe {
            Some(Self {
                connect: mem::transmute::<usize, Plain>(find(*b"IF")?),
                exit_xip: mem::transmute::<usize, Plain>(find(*b"EX")?),
                erase: mem::transmute::<usize, unsafe extern "C" fn(u32, u32, u32, u8)>(find(*b"RE")?),
                program: mem::transmute::<usize, unsafe extern "C" fn(u32, *const u8, u32)>(find(*b"RP")?),
                flush_cache: mem::transmute::<usize, Plain>(find(*b"FC")?),
                enter_xip: mem::transmute::<usize, Plain>(find(*b"CX")?),
            })
        }
    }

    /// Erases a sector at an offset from the beginning of the flash.
    pub(crate) fn erase(&self, offset: u32) {
        // SAFETY: `offset` is a multiple of the sector's length, as `flash.rs` makes it.
        self.without_xip(|| unsafe { (self.erase)(offset, SECTOR_LEN, BLOCK_LEN, ERASE_BLOCK) });
    }

    /// Writes a page at an offset from the beginning of the flash. Ones leave a bit as it is.
    pub(crate) fn program(&self, offset: u32, page: &[u8; PAGE_LEN]) {
        // SAFETY: `offset` is a multiple of the page's length, as `flash.rs` makes it.
        self.without_xip(|| unsafe { (self.program)(offset, page.as_ptr(), PAGE_LEN as u32) });
    }

    /// Does something with the flash while nothing can be read from it.
    pub(crate) fn without_xip<R>(&self, work: impl FnOnce() -> R) -> R {
        // SAFETY: all code and all constants are in RAM, interrupt handlers and their vectors included.
        unsafe {
            (self.connect)();
            (self.exit_xip)();
        }
        let result = work();
        // SAFETY: likewise.
        unsafe {
            (self.flush_cache)();
            (self.enter_xip)();
        }
        result
    }
}

/// The address of a function. The ROM has a table of functions and a function that searches it, at fixed places.
#[cfg(feature = "rp2040")]
fn find(code: [u8; 2]) -> Option<usize> {
    const TABLE: usize = 0x14;
    const SEARCH: usize = 0x18;
    // SAFETY: the ROM has 16-bit addresses at these places, of the table and of a function with this signature.
    let found = unsafe {
        let search = mem::transmute::<usize, unsafe extern "C" fn(*const u16, u32) -> usize>(word(SEARCH));
        search(ptr::with_exposed_provenance(word(TABLE)), u32::from(u16::from_le_bytes(code)))
    };
    (found != 0).then_some(found)
}

/// The address of a function. The ROM has a function that searches its table, at a fixed place.
#[cfg(feature = "rp2350")]
fn find(code: [u8; 2]) -> Option<usize> {
    const SEARCH: usize = 0x16;
    /// A function for the Arm cores, in secure state.
    const FUNCTION: u32 = 0x0004;
    // SAFETY: the ROM has the 16-bit address of a function with this signature there.
    let found = unsafe {
        let search = mem::transmute::<usize, unsafe extern "C" fn(u32, u32) -> usize>(word(SEARCH));
        search(u32::from(u16::from_le_bytes(code)), FUNCTION)
    };
    (found != 0).then_some(found)
}

/// A word of the ROM.
///
/// # Safety
/// The address is an even one in the ROM.
unsafe fn word(address: usize) -> usize {
    // SAFETY: the caller says so.
    usize::from(unsafe { ptr::with_exposed_provenance::<u16>(address).read_volatile() })
}
