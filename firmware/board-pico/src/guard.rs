//! A guard below the stack, so that an overflow faults whatever the size of the frame. The handler of the hard fault has a
//! stack of its own.

#[cfg(feature = "rp2350")]
use cortex_m::peripheral::MPU;

/// Sets the guard up. On the RP2350 it is the processor's stack limit.
#[cfg(feature = "rp2350")]
pub fn start(_: &mut MPU) {
    unsafe extern "C" {
        /// Lowest address of the stack, from the linker script.
        static _stack_end: u32;
    }
    // SAFETY: the stack in use lies above, and that of the fault handler, too.
    unsafe { cortex_m::register::msplim::write((&raw const _stack_end).addr() as u32) };
}

/// On the RP2040, a region of the memory protection unit.
#[cfg(feature = "rp2040")]
#[path = "../../board-nucleo-g474re/src/guard.rs"]
mod region;
#[cfg(feature = "rp2040")]
pub use region::start;
