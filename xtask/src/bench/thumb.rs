//! Decoder for the Thumb-2 instructions that affect the stack or call functions (Armv7-M architecture reference, A7.7).

/// The effect of an instruction on stack and control flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Instruction {
    /// Grows the stack by this number of bytes.
    Push(u32),
    /// Moves the stack pointer by an amount that the instruction does not contain.
    MoveStack,
    /// Calls the function at this address.
    Call(u32),
    /// Branches to this address, possibly under a condition.
    Branch(u32),
    /// Calls, or branches to, the address in this register.
    CallRegister(u8),
    /// Loads the word at an address into a register.
    LoadWord(u8, u32),
    /// Any other instruction.
    Other,
}

/// Decodes an instruction of one or two halfwords at `place`.
pub(super) fn decode(first: u16, second: u16, place: u32) -> Instruction {
    if first < 0xe800 { narrow(first, place) } else { wide(first, second, place) }
}

fn narrow(first: u16, place: u32) -> Instruction {
    match first {
        // PUSH of registers and LR.
        _ if first & 0xfe00 == 0xb400 => Instruction::Push(4 * (first & 0x1ff).count_ones()),
        // SUB SP, SP, #imm7.
        _ if first & 0xff80 == 0xb080 => Instruction::Push(4 * u32::from(first & 0x7f)),
        // BLX, and BX except BX LR.
        _ if first & 0xff07 == 0x4700 && first != 0x4770 => Instruction::CallRegister((first >> 3 & 0xf) as u8),
        // LDR from a literal.
        _ if first & 0xf800 == 0x4800 => literal((first >> 8 & 7) as u8, place, 4 * i32::from(first & 0xff)),
        // B and B<c>; conditions 14 and 15 are UDF and SVC.
        _ if first & 0xf800 == 0xe000 => branch(place, u32::from(first & 0x7ff) << 1, 12),
        _ if first & 0xf000 == 0xd000 && first & 0x0f00 < 0x0e00 => branch(place, u32::from(first & 0xff) << 1, 9),
        _ => Instruction::Other,
    }
}

fn wide(first: u16, second: u16, place: u32) -> Instruction {
    let to_sp = second & 0x0f00 == 0x0d00;
    match first {
        // STMDB SP!.
        0xe92d => Instruction::Push(4 * second.count_ones()),
        // STR with pre-indexed SP.
        0xf84d if to_sp => Instruction::Push(u32::from(second & 0xff)),
        // STRD with pre-indexed SP, and VPUSH.
        0xe96d | 0xed2d | 0xed6d => Instruction::Push(4 * u32::from(second & 0xff)),
        // SUB SP, SP, #const and #imm12.
        0xf1ad | 0xf5ad if to_sp => Instruction::Push(expand(first, second)),
        0xf2ad | 0xf6ad if to_sp => Instruction::Push(immediate(first, second)),
        // SUB SP, SP, register.
        0xebad if to_sp => Instruction::MoveStack,
        // LDR from a literal after or before the instruction.
        0xf8df => literal((second >> 12) as u8, place, i32::from(second & 0xfff)),
        0xf85f => literal((second >> 12) as u8, place, -i32::from(second & 0xfff)),
        _ if first & 0xf800 == 0xf000 => far(first, second, place),
        _ => Instruction::Other,
    }
}

/// `BL`, `B.W` and `B<c>.W`.
fn far(first: u16, second: u16, place: u32) -> Instruction {
    let bit = |halfword: u16, index: u32| u32::from(halfword) >> index & 1;
    let (sign, j1, j2, low) = (bit(first, 10), bit(second, 13), bit(second, 11), u32::from(second & 0x7ff) << 1);
    let long = || {
        let (i1, i2) = (1 ^ j1 ^ sign, 1 ^ j2 ^ sign);
        sign << 24 | i1 << 23 | i2 << 22 | u32::from(first & 0x3ff) << 12 | low
    };
    match second & 0xd000 {
        0xd000 => match branch(place, long(), 25) {
            Instruction::Branch(target) => Instruction::Call(target),
            other => other,
        },
        0x9000 => branch(place, long(), 25),
        0x8000 if first & 0x0380 != 0x0380 => {
            branch(place, sign << 20 | j2 << 19 | j1 << 18 | u32::from(first & 0x3f) << 12 | low, 21)
        }
        _ => Instruction::Other,
    }
}

/// A branch to `offset`, signed, of `bits` bits, relative to the instruction after the next.
fn branch(place: u32, offset: u32, bits: u32) -> Instruction {
    let unused = 32 - bits;
    let offset = ((offset << unused) as i32) >> unused;
    Instruction::Branch(place.wrapping_add(4).wrapping_add_signed(offset))
}

/// A load from `offset` relative to the address of the instruction after the next, rounded down to a multiple of four.
fn literal(register: u8, place: u32, offset: i32) -> Instruction {
    Instruction::LoadWord(register, (place.wrapping_add(4) & !3).wrapping_add_signed(offset))
}

/// The twelve bits of an immediate operand.
fn immediate(first: u16, second: u16) -> u32 {
    u32::from(first >> 10 & 1) << 11 | u32::from(second >> 12 & 7) << 8 | u32::from(second & 0xff)
}

/// A modified immediate constant (A5.3.2).
fn expand(first: u16, second: u16) -> u32 {
    let bits = immediate(first, second);
    let byte = bits & 0xff;
    match bits >> 8 {
        0 => byte,
        1 => byte << 16 | byte,
        2 => byte << 24 | byte << 8,
        3 => byte * 0x0101_0101,
        _ => (byte & 0x7f | 0x80).rotate_right(bits >> 7),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Encodings as the assembler produces them.
    #[test]
    fn instructions_that_move_the_stack_or_call_are_recognised() {
        use Instruction::{Branch, Call, CallRegister, LoadWord, MoveStack, Other, Push};
        for (name, first, second, expected) in [
            ("push {r4, r7, lr}", 0xb590, 0, Push(12)),
            ("sub sp, #16", 0xb084, 0, Push(16)),
            ("add sp, #16", 0xb004, 0, Other),
            ("pop {r4, r7, pc}", 0xbd90, 0, Other),
            ("push.w {r8, r9, r11}", 0xe92d, 0x0b00, Push(12)),
            ("str r8, [sp, #-4]!", 0xf84d, 0x8d04, Push(4)),
            ("str.w r8, [sp, #4]", 0xf8cd, 0x8004, Other),
            ("strd r0, r1, [sp, #-8]!", 0xe96d, 0x0102, Push(8)),
            ("vpush {d8, d9}", 0xed2d, 0x8b04, Push(16)),
            ("sub.w sp, sp, #512", 0xf5ad, 0x7d00, Push(512)),
            ("sub.w sp, sp, #1088", 0xf5ad, 0x6d88, Push(1088)),
            ("subw sp, sp, #1052", 0xf2ad, 0x4d1c, Push(1052)),
            ("sub.w r0, sp, #512", 0xf5ad, 0x7000, Other),
            ("sub.w sp, sp, r4", 0xebad, 0x0d04, MoveStack),
            ("blx r3", 0x4798, 0, CallRegister(3)),
            ("bx r12", 0x4760, 0, CallRegister(12)),
            ("ldr r0, [pc, #4]", 0x4801, 0, LoadWord(0, 0x1008)),
            ("ldr.w r4, [pc, #2036]", 0xf8df, 0x47f4, LoadWord(4, 0x1004 + 2036)),
            ("ldr.w r4, [pc, #-4]", 0xf85f, 0x4004, LoadWord(4, 0x1000)),
            ("bx lr", 0x4770, 0, Other),
            ("bl, of the start-up code", 0xf004, 0xfe0f, Call(0x1000 + 4 + 19_486)),
            ("b.w, of the hard fault", 0xf001, 0xb96f, Branch(0x1000 + 4 + 4_830)),
            ("b #-10", 0xe7fb, 0, Branch(0x1000 + 4 - 10)),
            ("beq #4", 0xd002, 0, Branch(0x1000 + 4 + 4)),
            ("udf #0", 0xde00, 0, Other),
            ("msr basepri, r0", 0xf380, 0x8811, Other),
            ("dsb sy", 0xf3bf, 0x8f4f, Other),
        ] {
            assert_eq!(decode(first, second, 0x1000), expected, "{name}");
        }
    }
}
