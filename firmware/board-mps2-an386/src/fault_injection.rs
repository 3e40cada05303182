//! Fault injection, for tests of the board's reaction to faults.

use core::hint::black_box;
use core::mem::MaybeUninit;

use cortex_m::interrupt;
use cortex_m::peripheral::SCB;
use frixel_exchange::layout;

use crate::shared;

/// Number of loops that takes more than two ticks.
const OVERRUN_LOOPS: u32 = 10_000;

/// An address without memory.
const NOWHERE: *const u32 = 0x6000_0000 as *const u32;

/// Words of a frame that is larger than the stack.
const FRAME_WORDS: usize = 20 * 1024 / 4;

/// Called by the main loop: injects the fault that the simulator requests.
pub fn in_main() {
    match shared::get(layout::INJECTED_FAULT) {
        layout::INJECT_PANIC => {
            shared::set(layout::INJECTED_FAULT, layout::INJECT_NOTHING);
            panic!("injected");
        }
        layout::INJECT_HARD_FAULT => {
            shared::set(layout::INJECTED_FAULT, layout::INJECT_NOTHING);
            // SAFETY: the read returns no value: there is no memory, and it causes the bus fault that is intended.
            black_box(unsafe { NOWHERE.read_volatile() });
        }
        layout::INJECT_STACK_OVERFLOW => {
            shared::set(layout::INJECTED_FAULT, layout::INJECT_NOTHING);
            // Without interrupts, whose entry would fault where this function does not.
            interrupt::free(|_| overflow());
        }
        layout::INJECT_RESET => {
            shared::set(layout::INJECTED_FAULT, layout::INJECT_NOTHING);
            interrupt::disable();
            shared::output_off();
            SCB::sys_reset();
        }
        _ => {}
    }
}

/// Called by the tick: overruns it if the simulator requests that.
#[inline]
pub fn in_tick() {
    if shared::get(layout::INJECTED_FAULT) == layout::INJECT_OVERRUN {
        shared::set(layout::INJECTED_FAULT, layout::INJECT_NOTHING);
        for i in 0..OVERRUN_LOOPS {
            black_box(i);
        }
    }
}

/// A function whose frame is larger than the stack. It uses only the lowest word of the frame, and calls nothing:
/// without a guard it returns as if nothing had happened.
#[inline(never)]
fn overflow() {
    let mut frame = MaybeUninit::<[u32; FRAME_WORDS]>::uninit();
    // SAFETY: the word is part of the frame, if there were a stack for it. The write causes the fault that is intended.
    unsafe { black_box(&mut frame).as_mut_ptr().cast::<u32>().write_volatile(0) };
}
