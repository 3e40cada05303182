//! The shared memory through which the emulated board and the simulator exchange the signals of the board's pins.
//!
//! The memory is an array of little-endian 32-bit words. [`layout`] assigns the words. [`TickInput`] and
//! [`TickOutput`] are the input and output of a tick, `touch` is a report of the touch source, each encoded as words.
//! Both sides compile this crate.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod layout;
mod tick;
mod touch;
mod words;

pub use tick::{
    INPUT_WORDS_MAX, OUTPUT_WORDS_MAX, TICK_BYTES_MAX, TickBytes, TickInput, TickOutput, drive_of, word_of,
};
pub use touch::{STAMPED_TOUCH_WORDS, StampedTouch};

use frixel_control::Board;
use frixel_wire::hello::{BoardKind, BoardLimits};

/// The emulated board: the limits of the smallest real one, like the simulated board.
///
/// Its receive window is a quarter of theirs: the emulator moves 20 kB/s over its serial port, and 8 kB/s on a busy
/// machine, where a real board moves 200. A full window must not delay an answer beyond the host's timeout.
pub const BOARD: Board = Board {
    kind: BoardKind::Mps2An386,
    id: *b"frixel-qemu\0",
    limits: BoardLimits { receive_window_bytes: 1024, ..Board::SIMULATOR.limits },
    ..Board::SIMULATOR
};
