//! Layout of the shared memory. Offsets count words.
//!
//! A side that writes data and a count of it writes the count last.

/// Bytes of the shared memory: the PSRAM of an MPS2 board.
pub const SHARED_LEN: usize = 16 << 20;

/// [`PRESENT`] when there is a simulator, which writes it before it starts the board.
pub const SIMULATOR: usize = 0;
/// The value of [`SIMULATOR`] for this version of the layout.
pub const PRESENT: u32 = 0x6672_7801;

/// One of the modes below; the simulator writes it before it starts the board.
pub const MODE: usize = 1;
/// The board ticks on its own timer, and the host is on its serial port.
pub const MODE_LINK: u32 = 0;
/// The board advances when the simulator sends a tick, which carries the serial bytes, too.
pub const MODE_LOCKSTEP: u32 = 1;

/// The fault that the board must inject, one of those below. The board sets it back to [`INJECT_NOTHING`].
pub const INJECTED_FAULT: usize = 2;
/// No fault.
pub const INJECT_NOTHING: u32 = 0;
/// The firmware panics.
pub const INJECT_PANIC: u32 = 1;
/// The processor reads where there is no memory.
pub const INJECT_HARD_FAULT: u32 = 2;
/// A tick takes longer than the tick period.
pub const INJECT_OVERRUN: u32 = 3;
/// A function's frame is larger than the stack.
pub const INJECT_STACK_OVERFLOW: u32 = 4;
/// The board is reset, as by its reset pin.
pub const INJECT_RESET: u32 = 5;

/// The amplifier's fault line: raised when non-zero.
pub const AMPLIFIER_FAULT: usize = 3;
/// The arm switch: held by a person who lets go of it when the board waits for that, or one of the values below.
pub const ARM_SWITCH: usize = 20;
/// The switch is open.
pub const SWITCH_OPEN: u32 = 1;
/// The switch is closed, whatever the person does.
pub const SWITCH_WELDED: u32 = 2;
/// The code that the DAC holds, an `i16`, plus [`DAC_STUCK`]; zero while the DAC takes codes.
pub const DAC_HELD: usize = 21;
/// Marks a code in [`DAC_HELD`].
pub const DAC_STUCK: u32 = 1 << 16;
/// Part of the driven voltage that the monitor does not show, an `f32`: 1 if it is dead.
pub const MONITOR_LOSS: usize = 22;
/// Ticks for which a disabled amplifier holds its output; `u32::MAX` for ever.
pub const OFF_DELAY_TICKS: usize = 23;
/// The board's current output, encoded by [`crate::word_of`].
pub const OUTPUT: usize = 4;
/// Ticks since the board was last reset.
pub const TICK: usize = 5;
/// Number of starts of the firmware since power-on.
pub const STARTS: usize = 6;
/// Number of bytes that have arrived on the serial port since power-on, modulo 2^32.
pub const RECEIVED_BYTES: usize = 15;

/// Number of drives written to [`DRIVES`] since power-on, modulo 2^32.
pub const DRIVES_WRITTEN: usize = 8;
/// Number of touch reports written to [`TOUCHES`] since power-on, modulo 2^32.
pub const TOUCHES_WRITTEN: usize = 9;
/// Number of touch reports that the board has read since power-on, modulo 2^32.
pub const TOUCHES_READ: usize = 10;

/// The output at the last start of the firmware. It must be zero, whatever ended the previous run.
pub const OUTPUT_AT_START: usize = 11;

/// Number of the fault that ended the previous run; 0 if none did.
pub const LAST_FAULT: usize = 18;
/// Detail of the last fault.
pub const LAST_FAULT_DETAIL: usize = 19;

/// Number of the batch of ticks that the simulator has sent last, from 1.
pub const BATCH_GIVEN: usize = 12;
/// Number of ticks in the batch.
pub const BATCH_TICKS: usize = 13;
/// Number of the batch of ticks that the board has finished last.
pub const BATCH_DONE: usize = 14;

/// Non-zero while a host has opened a connection and answers for slices of time in [`MODE_LINK`]: the board's clock
/// then stands still at the tick of [`HOST_ANSWERED_TO`]. Serial port and main loop go on.
pub const HOST_OPEN: usize = 16;
/// Number of ticks since power-on, as [`DRIVES_WRITTEN`] counts them, up to which the host has answered.
pub const HOST_ANSWERED_TO: usize = 17;

/// Ring of touch reports, [`TOUCHES_LEN`] times [`crate::STAMPED_TOUCH_WORDS`] words.
pub const TOUCHES: usize = 0x100;
/// Number of reports that the ring holds.
pub const TOUCHES_LEN: usize = 64;

/// Ring of drives in [`MODE_LINK`]: tick and drive alternate, [`DRIVES_LEN`] times two words.
pub const DRIVES: usize = 0x1000;
/// Number of drives that the ring holds, 13 s at 40 kHz.
pub const DRIVES_LEN: usize = 1 << 19;

/// Input in [`MODE_LOCKSTEP`]: the [`crate::TickInput`]s of a batch, one after the other.
pub const INPUTS: usize = DRIVES + 2 * DRIVES_LEN;
/// Output in [`MODE_LOCKSTEP`]: the [`crate::TickOutput`]s of a batch, one after the other.
pub const OUTPUTS: usize = INPUTS + BATCH_TICKS_MAX * crate::INPUT_WORDS_MAX;
/// Largest number of ticks in a batch.
pub const BATCH_TICKS_MAX: usize = 1 << 15;

const _: () = assert!(TOUCHES + TOUCHES_LEN * crate::STAMPED_TOUCH_WORDS <= DRIVES);
const _: () = assert!(4 * (OUTPUTS + BATCH_TICKS_MAX * crate::OUTPUT_WORDS_MAX) <= SHARED_LEN);
