//! A guard region below the stack, set up in the memory protection unit.
//!
//! For boards whose stack is at the bottom of RAM, with RAM starting at `0x2000_0000`. Below the STM32's RAM are unused
//! addresses, and the option bytes of the flash, where a write may not fault; on the emulated board, nothing below RAM
//! faults. With the guard, an overflow faults for any frame size. The guard is disabled in the hard fault's handler,
//! which has its own stack (PM0214, "Memory protection unit").

use cortex_m::asm;
use cortex_m::peripheral::MPU;

/// First byte of the guard. The STM32's unique number lies below it.
const START: u32 = 0x1fff_8000;
/// Length of the guard, up to the start of RAM; more than any stack frame.
const LEN: u32 = 0x8000;

// Control register: outside the regions, memory behaves as without the unit.
const CTRL_ENABLE: u32 = 1;
const CTRL_DEFAULT_MAP: u32 = 1 << 2;

const _: () = assert!(START + LEN == 0x2000_0000 && START.is_multiple_of(LEN) && LEN.is_power_of_two());

/// Sets the guard up.
pub fn start(mpu: &mut MPU) {
    // SAFETY: the guard is not memory of this program, and the access to all other memory is unchanged.
    unsafe {
        mpu.rnr.write(0);
        set_region(mpu);
        mpu.ctrl.write(CTRL_ENABLE | CTRL_DEFAULT_MAP);
    }
    // Takes effect from the next instruction on.
    asm::dsb();
    asm::isb();
}

/// Sets the region to no access and no execution.
///
/// # Safety
/// The guard is not memory of this program.
#[cfg(not(armv8m))]
unsafe fn set_region(mpu: &mut MPU) {
    const EXECUTE_NEVER: u32 = 1 << 28;
    const SIZE: u32 = (LEN.ilog2() - 1) << 1;
    const ENABLE: u32 = 1;
    // SAFETY: that of this function.
    unsafe {
        mpu.rbar.write(START);
        mpu.rasr.write(EXECUTE_NEVER | SIZE | ENABLE);
    }
}

/// Sets the region to read-only and no execution: an `ARMv8-M` cannot forbid reads, and a stack overflows with a write.
/// Compiled, but not run (`ARMv8-M` Architecture Reference Manual, `MPU_RBAR` and `MPU_RLAR`, not read).
///
/// # Safety
/// The guard is not memory of this program.
#[cfg(armv8m)]
unsafe fn set_region(mpu: &mut MPU) {
    const READ_ONLY: u32 = 0b10 << 1;
    const EXECUTE_NEVER: u32 = 1;
    const ENABLE: u32 = 1;
    const LAST_BLOCK: u32 = START + LEN - 32;
    // SAFETY: that of this function.
    unsafe {
        mpu.rbar.write(START | READ_ONLY | EXECUTE_NEVER);
        mpu.rlar.write(LAST_BLOCK | ENABLE);
    }
}
