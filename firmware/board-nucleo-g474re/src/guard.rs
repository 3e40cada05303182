//! A guard region below the stack, set up in the memory protection unit.
//!
//! Below the STM32's RAM lie unused addresses, and the option bytes of the flash, where a write may not fault; on the
//! emulated board, which has this file too, nothing below RAM faults. With the guard, an overflow faults whatever the
//! size of the frame. The guard is disabled in the hard fault's handler, which has a stack of its own (PM0214, "Memory
//! protection unit").

use cortex_m::asm;
use cortex_m::peripheral::MPU;

/// First byte of the guard. The STM32's unique number lies below it.
const START: u32 = 0x1fff_8000;
/// Length of the guard, up to the start of RAM; more than any stack frame.
const LEN: u32 = 0x8000;

// Region attribute and size register: no access, no execution.
const RASR_EXECUTE_NEVER: u32 = 1 << 28;
const RASR_SIZE: u32 = (LEN.ilog2() - 1) << 1;
const RASR_ENABLE: u32 = 1;
// Control register: outside the regions, memory behaves as without the unit.
const CTRL_ENABLE: u32 = 1;
const CTRL_DEFAULT_MAP: u32 = 1 << 2;

const _: () = assert!(START + LEN == 0x2000_0000 && START.is_multiple_of(LEN) && LEN.is_power_of_two());

/// Sets the guard up.
pub fn start(mpu: &mut MPU) {
    // SAFETY: the guard is not memory of this program, and the access to all other memory is unchanged.
    unsafe {
        mpu.rnr.write(0);
        mpu.rbar.write(START);
        mpu.rasr.write(RASR_EXECUTE_NEVER | RASR_SIZE | RASR_ENABLE);
        mpu.ctrl.write(CTRL_ENABLE | CTRL_DEFAULT_MAP);
    }
    // Takes effect from the next instruction on.
    asm::dsb();
    asm::isb();
}
