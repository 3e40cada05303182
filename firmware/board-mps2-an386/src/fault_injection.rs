//! Fault injection, for tests of the board's reaction to faults.

use core::hint::black_box;

use frixel_exchange::layout;

use crate::shared;

/// Number of loops that takes more than two ticks.
const OVERRUN_LOOPS: u32 = 10_000;

/// An address without memory.
const NOWHERE: *const u32 = 0x6000_0000 as *const u32;

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
            black_box(without_end(0));
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

#[allow(unconditional_recursion, reason = "that is the point")]
#[inline(never)]
fn without_end(depth: u32) -> u32 {
    let here = black_box([depth; 16]);
    without_end(depth + 1) + here.iter().sum::<u32>()
}
