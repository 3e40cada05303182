//! Functions of the boot ROM that connect the flash (RP2040, 2.8.3, "Bootrom Contents"). They are looked up by a code
//! of two letters. They use the flash's interface directly, so that nothing can be read from the flash meanwhile; this
//! image runs from RAM.

use core::mem;
use core::ptr;

/// A function without arguments.
type Plain = unsafe extern "C" fn();

/// The functions that connect the flash and disconnect it.
pub(crate) struct FlashFunctions {
    connect: Plain,
    exit_xip: Plain,
    flush_cache: Plain,
    enter_xip: Plain,
}

impl FlashFunctions {
    /// Looks the functions up. `None` if the ROM lacks one of them.
    pub(crate) fn find() -> Option<Self> {
        // SAFETY: these are the signatures of the functions with these codes.
        unsafe {
            Some(Self {
                connect: mem::transmute::<usize, Plain>(find(*b"IF")?),
                exit_xip: mem::transmute::<usize, Plain>(find(*b"EX")?),
                flush_cache: mem::transmute::<usize, Plain>(find(*b"FC")?),
                enter_xip: mem::transmute::<usize, Plain>(find(*b"CX")?),
            })
        }
    }

    /// Runs `work` while the flash cannot be read.
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

/// A halfword of the ROM.
///
/// # Safety
/// The address is an even one in the ROM.
unsafe fn word(address: usize) -> usize {
    // SAFETY: guaranteed by the caller.
    usize::from(unsafe { ptr::with_exposed_provenance::<u16>(address).read_volatile() })
}
