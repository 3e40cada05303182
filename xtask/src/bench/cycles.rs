//! Estimates the cycles of a Thumb-2 instruction.
//!
//! The numbers are from the Cortex-M4 technical reference (Arm 100166, tables 3-1 and 7-1), ignoring effects between
//! instructions: loads do not overlap, and memory has no wait states. Where the reference gives a range, the estimate
//! uses the middle for a taken branch (1 to 3 to refill the pipeline) and the maximum for an integer division.

/// Cycles to refill the pipeline after a branch.
const REFILL_CYCLES: u64 = 2;
/// A floating-point division or square root.
const FLOAT_DIVISION_CYCLES: u64 = 14;
/// An integer division: 2 to 12.
const DIVISION_CYCLES: u64 = 12;
/// A load from memory.
const LOAD_CYCLES: u64 = 2;

/// Cycles of the instruction of one or two halfwords at `place`. `next` is the address of the instruction executed
/// after it.
pub(super) fn cycles(first: u16, second: u16, place: u32, next: u32) -> u64 {
    let wide = first >= 0xe800;
    let own = if wide { wide_cycles(first, second) } else { narrow_cycles(first) };
    let fell_through = next == place + if wide { 4 } else { 2 };
    if fell_through { own } else { own + REFILL_CYCLES }
}

/// Cycles of a 16-bit instruction.
fn narrow_cycles(first: u16) -> u64 {
    match first >> 12 {
        // Register offset: stores, then loads from LDRSB on.
        0x5 if first & 0x0e00 >= 0x0600 => LOAD_CYCLES,
        // From a literal, at an immediate offset, from the stack.
        0x4 | 0x6..=0x9 if first & 0x0800 != 0 => LOAD_CYCLES,
        // PUSH and POP, of their registers and LR or PC.
        0xb if first & 0x0600 == 0x0400 => 1 + u64::from((first & 0x01ff).count_ones()),
        // STM and LDM.
        0xc => 1 + u64::from((first & 0x00ff).count_ones()),
        _ => 1,
    }
}

/// Cycles of a 32-bit instruction.
fn wide_cycles(first: u16, second: u16) -> u64 {
    let load = first & 0x0010 != 0;
    match first {
        _ if first & 0xec00 == 0xec00 && second & 0x0e00 == 0x0a00 => float_cycles(first, second),
        // STM and LDM.
        _ if first & 0xfe40 == 0xe800 => 1 + u64::from(second.count_ones()),
        // Table branch: a load and a branch.
        _ if first & 0xfff0 == 0xe8d0 && second & 0xfff0 >= 0xf000 => LOAD_CYCLES,
        // STRD and LDRD, exclusive accesses included.
        _ if first & 0xfe40 == 0xe840 => 1 + 2,
        // A load or store of one register.
        _ if first & 0xfe00 == 0xf800 && load => LOAD_CYCLES,
        // SDIV and UDIV.
        _ if first & 0xffd0 == 0xfb90 && second & 0x00f0 == 0x00f0 => DIVISION_CYCLES,
        // MLA and MLS.
        _ if first & 0xfff0 == 0xfb00 && second & 0xf000 != 0xf000 => 2,
        _ => 1,
    }
}

/// Cycles of a floating-point instruction.
fn float_cycles(first: u16, second: u16) -> u64 {
    match first {
        // Two registers to or from the core.
        _ if first & 0xffe0 == 0xec40 => 2,
        // VLDR and VSTR.
        _ if first & 0xff20 == 0xed00 => LOAD_CYCLES,
        // VLDM and VSTM, VPOP and VPUSH among them.
        _ if first & 0xfe00 == 0xec00 => 1 + u64::from(second & 0x00ff),
        // One register to or from the core, and the flags.
        _ if second & 0x0010 != 0 => 1,
        _ => match first & 0x00b0 {
            // VMLA, VMLS, VNMLA, VNMLS; VFMA and its like.
            0x0000 | 0x0010 | 0x0090 | 0x00a0 => 3,
            // VDIV.
            0x0080 => FLOAT_DIVISION_CYCLES,
            // VSQRT.
            0x00b0 if first & 0x000f == 0x0001 && second & 0x00c0 == 0x00c0 => FLOAT_DIVISION_CYCLES,
            _ => 1,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Encodings as the assembler produces them.
    #[test]
    fn instructions_take_what_the_reference_says() {
        for (name, first, second, expected) in [
            ("movs r0, #0", 0x2000, 0, 1),
            ("ldr r0, [r1]", 0x6808, 0, 2),
            ("str r0, [r1]", 0x6008, 0, 1),
            ("ldrb r0, [r1]", 0x7808, 0, 2),
            ("ldr r0, [pc, #4]", 0x4801, 0, 2),
            ("strb r0, [r1, r2]", 0x5488, 0, 1),
            ("ldrsb r0, [r1, r2]", 0x5688, 0, 2),
            ("ldr r0, [sp, #4]", 0x9801, 0, 2),
            ("push {r4, r7, lr}", 0xb590, 0, 4),
            ("pop {r7, pc}", 0xbd80, 0, 3),
            ("ldmia r0!, {r1, r2}", 0xc806, 0, 3),
            ("ldr.w r2, [r0, #2016]", 0xf8d0, 0x27e0, 2),
            ("str.w r2, [r0, #2016]", 0xf8c0, 0x27e0, 1),
            ("ldrd r1, r2, [r0]", 0xe9d0, 0x1200, 3),
            ("push.w {r8, r9, r10, r11}", 0xe92d, 0x0f00, 5),
            ("udiv r0, r0, r1", 0xfbb0, 0xf0f1, 12),
            ("mla r0, r1, r2, r3", 0xfb01, 0x3002, 2),
            ("umull r0, r1, r2, r3", 0xfba2, 0x0103, 1),
            ("vldr s8, [r0, #12]", 0xed90, 0x4a03, 2),
            ("vstr s0, [r4, #32]", 0xed84, 0x0a08, 2),
            ("vpush {d8, d9}", 0xed2d, 0x8b04, 5),
            ("vmov r1, s0", 0xee10, 0x1a10, 1),
            ("vmla.f32 s6, s0, s8", 0xee00, 0x3a04, 3),
            ("vmul.f32 s0, s0, s2", 0xee20, 0x0a01, 1),
            ("vadd.f32 s0, s0, s2", 0xee30, 0x0a01, 1),
            ("vdiv.f32 s4, s2, s4", 0xee81, 0x2a02, 14),
            ("vsqrt.f32 s0, s0", 0xeeb1, 0x0ac0, 14),
            ("vneg.f32 s0, s0", 0xeeb1, 0x0a40, 1),
            ("vcmp.f32 s0, s2", 0xeeb4, 0x0a41, 1),
            ("vcvt.f32.u32 s6, s6", 0xeeb8, 0x3a43, 1),
            ("vmrs APSR_nzcv, fpscr", 0xeef1, 0xfa10, 1),
        ] {
            let width = if first >= 0xe800 { 4 } else { 2 };
            assert_eq!(cycles(first, second, 0x100, 0x100 + width), expected, "{name}");
            assert_eq!(cycles(first, second, 0x100, 0x80), expected + REFILL_CYCLES, "{name}, and a branch");
        }
    }
}
