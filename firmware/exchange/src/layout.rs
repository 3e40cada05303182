//! Which word of the shared memory is what. Offsets count words.
//!
//! A count that one side writes and the other reads is written after what it counts.

/// Bytes of the shared memory: the PSRAM of an MPS2 board.
pub const SHARED_LEN: usize = 16 << 20;

/// [`PRESENT`] once there is a simulator; the simulator writes it before it starts the board.
pub const SIMULATOR: usize = 0;
/// A simulator is there: the version of this layout.
pub const PRESENT: u32 = 0x6672_7801;

/// One of the modes below; the simulator writes it before it starts the board.
pub const MODE: usize = 1;
/// The board ticks on its own timer, and the host is on its serial port.
pub const MODE_LINK: u32 = 0;
/// The board ticks when it is given a tick, and its serial bytes come and go with it.
pub const MODE_LOCKSTEP: u32 = 1;

/// One of the mishaps below, for the board to bring about and to set back to [`PROVOKE_NOTHING`].
pub const PROVOKE: usize = 2;
/// All is well.
pub const PROVOKE_NOTHING: u32 = 0;
/// The firmware panics.
pub const PROVOKE_PANIC: u32 = 1;
/// The processor reads where there is no memory.
pub const PROVOKE_HARD_FAULT: u32 = 2;
/// A tick takes longer than a tick.
pub const PROVOKE_OVERRUN: u32 = 3;
/// A function calls itself without end.
pub const PROVOKE_STACK_OVERFLOW: u32 = 4;

/// The amplifier's fault line: raised when not zero.
pub const AMPLIFIER_FAULT: usize = 3;
/// What the board drives now, as [`crate::word_of`] has it.
pub const OUTPUT: usize = 4;
/// Ticks since the board was last reset.
pub const TICK: usize = 5;
/// Times that the firmware has started since power-on.
pub const STARTS: usize = 6;
/// Tick of the last byte that came on the serial port.
pub const RECEIVED_AT_TICK: usize = 7;
/// Bytes that came on the serial port since power-on, modulo 2^32.
pub const RECEIVED_BYTES: usize = 15;

/// Drives in [`DRIVES`] since power-on, modulo 2^32.
pub const DRIVES_WRITTEN: usize = 8;
/// Touch reports in [`TOUCHES`] since power-on, modulo 2^32.
pub const TOUCHES_WRITTEN: usize = 9;
/// Touch reports that the board has taken since power-on, modulo 2^32.
pub const TOUCHES_READ: usize = 10;

/// What was driven when the firmware last started: what ended it has to leave the output at zero.
pub const OUTPUT_AT_START: usize = 11;

/// Number of the batch of ticks that is given, from 1.
pub const BATCH_GIVEN: usize = 12;
/// Ticks in it.
pub const BATCH_TICKS: usize = 13;
/// Number of the batch of ticks that is done.
pub const BATCH_DONE: usize = 14;

/// Ring of touch reports, [`TOUCHES_LEN`] times [`crate::STAMPED_TOUCH_WORDS`] words.
pub const TOUCHES: usize = 0x100;
/// Reports that the ring holds.
pub const TOUCHES_LEN: usize = 64;

/// Ring of drives in [`MODE_LINK`]: tick and drive in turn, [`DRIVES_LEN`] times two words.
pub const DRIVES: usize = 0x1000;
/// Drives that the ring holds, 13 s at 40 kHz.
pub const DRIVES_LEN: usize = 1 << 19;

/// What is given in [`MODE_LOCKSTEP`]: the [`crate::TickInput`]s of a batch, one after the other.
pub const INPUTS: usize = DRIVES + 2 * DRIVES_LEN;
/// What is done in [`MODE_LOCKSTEP`]: the [`crate::TickOutput`]s of a batch, one after the other.
pub const OUTPUTS: usize = INPUTS + BATCH_TICKS_MAX * crate::INPUT_WORDS_MAX;
/// Most ticks in a batch.
pub const BATCH_TICKS_MAX: usize = 1 << 15;

const _: () = assert!(TOUCHES + TOUCHES_LEN * crate::STAMPED_TOUCH_WORDS <= DRIVES);
const _: () = assert!(4 * (OUTPUTS + BATCH_TICKS_MAX * crate::OUTPUT_WORDS_MAX) <= SHARED_LEN);
