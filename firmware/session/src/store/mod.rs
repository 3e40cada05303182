//! Persistent storage of the limits measured during bring-up.
//!
//! They are stored in a [`Slot`] of two copies. A new copy replaces the older one: its page is erased, then its words
//! are written, ending with a CRC-32 over the others. A power failure at any byte thus leaves one good copy, which
//! [`Slot::find`] finds. [`Writer::step`] does not wait: it begins one flash operation at a time.
//!
//! A board implements the [`Flash`] trait, and [`WritableFlash`] if one of its images stores limits.

mod limits;
mod slot;

pub use limits::{
    CURRENT_CEILING_A_PEAK, CURRENT_CEILING_A_RMS, CeilingPolicy, LIMITS_LEN, LimitsError, RAIL_MAX,
    VOLTAGE_CEILING_V_PEAK, check_touched_board, load_limits, read_limits, write_limits,
};
pub use slot::{COPY_LEN, Slot, Writer, Writing, first_copy};

/// Write granularity of the flash, bytes: a double word on the STM32G4 (RM0440, 3.3.7).
pub const WORD_LEN: usize = 8;

/// The flash memory of a store. Offsets count from the beginning of this memory.
pub trait Flash {
    /// Bytes of a page.
    const PAGE_LEN: u32;

    /// Reads bytes; must not be called during an operation. Returns `false` if some bytes cannot be read, such as a
    /// word partly written when the power failed.
    #[must_use]
    fn read(&self, offset: u32, bytes: &mut [u8]) -> bool;
}

/// A flash that an image can write. It is erased in pages, to 0xff, and written in words, each at most once between two
/// erasures.
pub trait WritableFlash: Flash {
    /// Begins to erase a page.
    fn begin_erase(&mut self, page: u32);

    /// Begins to write a word at an offset that is a multiple of [`WORD_LEN`].
    fn begin_write(&mut self, offset: u32, word: [u8; WORD_LEN]);

    /// Returns the state of the last operation, and locks the flash once the operation is no longer
    /// [`Operation::Busy`]: poll until then.
    fn operation(&mut self) -> Operation;
}

/// State of an operation of the flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// The operation is in progress.
    Busy,
    /// The operation has succeeded, or none was begun.
    Done,
    /// The operation has failed: the page is worn out or protected.
    Failed,
}
