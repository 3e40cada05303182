//! The memory that the board shares with the simulator: the PSRAM, which the simulator sees as an ordinary file.
//! Without a simulator it is ordinary memory, and no finger ever touches the screen.

use core::sync::atomic::{Ordering, fence};

use frixel_control::Drive;
use frixel_exchange::{STAMPED_TOUCH_WORDS, StampedTouch, layout, word_of};
use frixel_session::Touch;

/// Address of the PSRAM (Arm DAI0386, MPS2 FPGA image AN386; AN505 as the emulator has it, `hw/arm/mps2-tz.c`).
const BASE: *mut u32 = if cfg!(an505) { 0x8000_0000_usize } else { 0x2100_0000 } as *mut u32;
const WORDS: usize = layout::SHARED_LEN / 4;

/// A word of the shared memory.
#[inline]
pub fn get(word: usize) -> u32 {
    assert!(word < WORDS);
    // SAFETY: the PSRAM has this word, and no Rust object lies in it.
    unsafe { BASE.add(word).read_volatile() }
}

/// Sets a word of the shared memory.
#[inline]
pub fn set(word: usize, value: u32) {
    assert!(word < WORDS);
    // SAFETY: the PSRAM has this word, and no Rust object lies in it.
    unsafe { BASE.add(word).write_volatile(value) }
}

/// Sets a word that marks other words as written.
pub fn publish(word: usize, value: u32) {
    fence(Ordering::Release);
    set(word, value);
}

/// A position in a sequence of words.
pub struct Cursor(usize);

impl Cursor {
    /// Begins at a word.
    pub const fn at(word: usize) -> Self {
        Self(word)
    }

    /// Returns the current word and advances to the next.
    pub fn get(&mut self) -> u32 {
        let value = get(self.0);
        self.0 += 1;
        value
    }

    /// Sets the current word and advances to the next.
    pub fn set(&mut self, value: u32) {
        set(self.0, value);
        self.0 += 1;
    }
}

/// Outputs a drive: the values of the DAC and of the amplifier's enable.
#[inline]
pub fn drive(tick: u32, drive: Drive) {
    let word = word_of(drive);
    set(layout::OUTPUT, word);
    let written = get(layout::DRIVES_WRITTEN);
    let place = layout::DRIVES + 2 * (written as usize % layout::DRIVES_LEN);
    set(place, tick);
    set(place + 1, word);
    set(layout::TICK, tick);
    publish(layout::DRIVES_WRITTEN, written.wrapping_add(1));
}

/// Sets the output to zero and disables the amplifier, in any state.
pub fn output_off() {
    set(layout::OUTPUT, word_of(Drive::default()));
}

/// Returns the next report of the touch source, if one has arrived.
#[inline]
pub fn touch(now_tick: u32) -> Option<Touch> {
    let read = get(layout::TOUCHES_READ);
    if get(layout::TOUCHES_WRITTEN) == read {
        return None;
    }
    fence(Ordering::Acquire);
    let mut cursor = Cursor::at(layout::TOUCHES + STAMPED_TOUCH_WORDS * (read as usize % layout::TOUCHES_LEN));
    let report = StampedTouch::read(|| cursor.get());
    publish(layout::TOUCHES_READ, read.wrapping_add(1));
    report.map(|report| report.at(now_tick))
}
