//! What a board keeps over power-off: the last scene, with the finger profile that stands in its header, and the limits
//! that bring-up measured.
//!
//! Each is kept in a [`Slot`] of two copies. A new copy takes the place of the older one: its pages are erased, its
//! content is written, and its header last, with CRC-32s over both. So a power cut at any byte leaves one good copy, and
//! [`Slot::find`] tells which. Nothing here waits: [`Writer::step`] begins one operation of the flash at a time, and
//! [`SceneKeeper`] does so only while the board is disarmed.
//!
//! A board stands behind the [`Flash`] trait with its registers.

mod copy;
mod keeper;
mod limits;
mod writer;

pub use copy::{Found, Slot};
pub use keeper::SceneKeeper;
pub use limits::{LIMITS_LEN, read_limits, write_limits};
pub use writer::{Writer, Writing};

/// Bytes that the flash takes at once: a double word on the STM32G4 (RM0440, 3.3.7).
pub const WORD_LEN: usize = 8;

/// Flash as the stores use it. What it holds is erased in pages to 0xff, and written in words, each once between two
/// erasures. Offsets count from its own beginning.
pub trait Flash {
    /// Bytes of a page.
    const PAGE_LEN: u32;

    /// Reads bytes, while nothing is under way. `false` when they cannot be read whole: a word that was half written
    /// when the power went.
    #[must_use]
    fn read(&self, offset: u32, bytes: &mut [u8]) -> bool;

    /// Begins to erase a page.
    fn begin_erase(&mut self, page: u32);

    /// Begins to write a word at an offset that is a multiple of [`WORD_LEN`].
    fn begin_write(&mut self, offset: u32, word: [u8; WORD_LEN]);

    /// What became of the operation that was begun last. Asked until it is no longer [`Operation::Busy`], it leaves the
    /// flash locked.
    fn operation(&mut self) -> Operation;
}

/// What became of an operation of the flash.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// It is under way.
    Busy,
    /// It has ended well, or none was begun.
    Done,
    /// It has failed: the page is worn out or protected.
    Failed,
}
