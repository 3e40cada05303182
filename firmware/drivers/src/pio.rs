//! Instructions of the programmable I/O (PIO) of the RP2040 and the RP2350, encoded for its state machines (RP2040 data
//! sheet, 3.4, "Instruction Set"). A board writes its programs with them.
//!
//! Every function panics if a number does not fit into its instruction. In constants, where programs are defined, that
//! fails to compile.
//!
//! A state machine takes one cycle of its divided clock per instruction, plus the cycles of [`Instruction::delay`].
//! That number shares five bits with the pins of [`Instruction::side`].

/// An instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction(u16);

/// Condition of a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Condition {
    /// Always.
    Always = 0,
    /// Register X is not zero. X is decremented in either case.
    XNotZeroDecrement = 2,
    /// Register Y is zero.
    YZero = 3,
    /// Register Y is not zero. Y is decremented in either case.
    YNotZeroDecrement = 4,
}

/// Destination of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Destination {
    /// The pins configured for the machine.
    Pins = 0,
    /// Register X.
    X = 1,
    /// Register Y.
    Y = 2,
    /// The directions of the pins, 1 for an output. Not a destination of [`copy`].
    PinDirections = 4,
}

/// Source of [`copy`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The configured status: all ones while the transmit FIFO holds fewer words than configured.
    Status = 5,
    /// The output shift register.
    OutputShift = 7,
}

impl Instruction {
    /// Waits for this number of cycles after the instruction.
    ///
    /// # Panics
    /// If they need more than five bits. Use it in a constant, where that fails to compile.
    #[must_use]
    pub const fn delay(self, cycles: u16) -> Self {
        assert!(cycles < 32, "a delay has five bits at most");
        Self(self.0 | cycles << 8)
    }

    /// Sets the `count` side-set pins at the start of the instruction. The delay then has `count` bits fewer.
    ///
    /// # Panics
    /// If the levels or the delay do not fit. Use it in a constant, where that fails to compile.
    #[must_use]
    pub const fn side(self, levels: u16, count: u32) -> Self {
        assert!(count <= 5 && levels < 1 << count, "there are at most five side-set pins");
        assert!((self.0 >> 8) & 0x1f < 1 << (5 - count), "the side-set pins leave fewer bits to the delay");
        Self(self.0 | levels << (13 - count))
    }

    /// The word for the instruction memory.
    pub const fn word(self) -> u16 {
        self.0
    }
}

/// Jumps to an address.
///
/// # Panics
///
/// If the address is above 31.
pub const fn jump(condition: Condition, address: u16) -> Instruction {
    assert!(address < 32, "a program has 32 instructions at most");
    Instruction((condition as u16) << 5 | address)
}

/// Waits until an interrupt flag is set, and clears it.
///
/// # Panics
///
/// If the flag is above 7.
pub const fn wait_flag(flag: u16) -> Instruction {
    assert!(flag < 8, "there are eight flags");
    Instruction(0x20c0 | flag)
}

/// Shifts bits from the input pins into the input shift register.
///
/// # Panics
///
/// If there are no bits, or more than 31.
pub const fn shift_in(bits: u16) -> Instruction {
    assert!(bits >= 1 && bits < 32, "1 to 31 bits");
    Instruction(0x4000 | bits)
}

/// Shifts bits out of the output shift register.
///
/// # Panics
///
/// If there are no bits, or more than 31.
pub const fn shift_out(to: Destination, bits: u16) -> Instruction {
    assert!(bits >= 1 && bits < 32, "1 to 31 bits");
    Instruction(0x6000 | (to as u16) << 5 | bits)
}

/// Moves the input shift register to the receive FIFO; drops it if the FIFO is full.
pub const PUSH: Instruction = Instruction(0x8000);
/// Moves a word from the transmit FIFO to the output shift register; uses register X if the FIFO is empty.
pub const PULL: Instruction = Instruction(0x8080);
/// Waits for a word in the transmit FIFO, and moves it to the output shift register.
pub const PULL_BLOCKING: Instruction = Instruction(0x80a0);

/// Copies a register.
///
/// # Panics
///
/// If the destination is the directions of pins.
pub const fn copy(to: Destination, from: Source) -> Instruction {
    assert!(!matches!(to, Destination::PinDirections), "not a destination of this instruction");
    Instruction(0xa000 | (to as u16) << 5 | from as u16)
}

/// Sets an interrupt flag.
///
/// # Panics
///
/// If the flag is above 7.
pub const fn set_flag(flag: u16) -> Instruction {
    assert!(flag < 8, "there are eight flags");
    Instruction(0xc000 | flag)
}

/// Sets pins, directions or a register to a value.
///
/// # Panics
///
/// If the value is above 31.
pub const fn set(to: Destination, value: u16) -> Instruction {
    assert!(value < 32, "a value has five bits");
    Instruction(0xe000 | (to as u16) << 5 | value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Instructions with published encodings: the example programs of the data sheet, with the assembler's output.
    #[test]
    fn words_match_the_assembler() {
        for (instruction, word) in [
            // `out x, 1 side 0 [2]`, `jmp bitloop side 1 [4]` at address 0 (3.6.2, "WS2812 LEDs").
            (shift_out(Destination::X, 1).delay(2).side(0, 1), 0x6221),
            (jump(Condition::Always, 0).delay(4).side(1, 1), 0x1400),
            // `pull`, `set x, 31`, `set pins, 1`, `set pindirs, 1`, `jmp x-- 2`, `mov y, status`, `irq nowait 0`.
            (PULL_BLOCKING, 0x80a0),
            (PULL, 0x8080),
            (PUSH, 0x8000),
            (set(Destination::X, 31), 0xe03f),
            (set(Destination::Pins, 1), 0xe001),
            (set(Destination::PinDirections, 1), 0xe081),
            (jump(Condition::XNotZeroDecrement, 2), 0x0042),
            (jump(Condition::YZero, 5), 0x0065),
            (jump(Condition::YNotZeroDecrement, 3), 0x0083),
            (copy(Destination::Y, Source::Status), 0xa045),
            (copy(Destination::X, Source::OutputShift), 0xa027),
            (set_flag(0), 0xc000),
            (wait_flag(4), 0x20c4),
            (shift_in(1), 0x4001),
            (shift_out(Destination::Pins, 1), 0x6001),
        ] {
            assert_eq!(instruction.word(), word, "{instruction:?}");
        }
    }

    #[test]
    fn side_set_pins_stand_above_the_delay() {
        let instruction = set(Destination::Y, 0).delay(7).side(0b10, 2);
        assert_eq!(instruction.word(), 0xe040 | 0b10 << 11 | 7 << 8);
    }

    #[test]
    #[should_panic(expected = "fewer bits")]
    fn a_delay_without_room_beside_the_side_set_pins_is_refused() {
        let _ = set(Destination::Y, 0).delay(8).side(0, 2);
    }
}
