//! What lies below the stack, out of bounds by the memory protection unit.
//!
//! Below RAM come addresses that nobody uses, and the option bytes of the flash, where a write does not fault for
//! certain. The guard makes an overflow fault whatever the frame is that goes over. It does not hold in the hard fault's handler,
//! which has a stack of its own (PM0214, "Memory protection unit").

use cortex_m::asm;
use cortex_m::peripheral::MPU;

/// First byte of the guard. The processor's unique number lies below it.
const START: u32 = 0x1fff_8000;
/// Bytes of the guard, up to the start of RAM; more than any frame has.
const LEN: u32 = 0x8000;

// Region attribute and size register: no access for anybody, no execution.
const RASR_EXECUTE_NEVER: u32 = 1 << 28;
const RASR_SIZE: u32 = (LEN.ilog2() - 1) << 1;
const RASR_ENABLE: u32 = 1;
// Control register: all that no region covers is as without the unit.
const CTRL_ENABLE: u32 = 1;
const CTRL_DEFAULT_MAP: u32 = 1 << 2;

const _: () = assert!(START + LEN == 0x2000_0000 && START.is_multiple_of(LEN) && LEN.is_power_of_two());

/// Sets the guard up.
pub fn start(mpu: &mut MPU) {
    // SAFETY: what is forbidden is no memory of this program, and all else stays as it is.
    unsafe {
        mpu.rnr.write(0);
        mpu.rbar.write(START);
        mpu.rasr.write(RASR_EXECUTE_NEVER | RASR_SIZE | RASR_ENABLE);
        mpu.ctrl.write(CTRL_ENABLE | CTRL_DEFAULT_MAP);
    }
    // From the next instruction on.
    asm::dsb();
    asm::isb();
}
