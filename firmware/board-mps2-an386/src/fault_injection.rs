//! Faults on demand, for the tests of what the board does about them.

use core::hint::black_box;

use frixel_exchange::layout;

use crate::shared;

/// More loops than there are in two ticks.
const OVERRUN_LOOPS: u32 = 10_000;

/// An address without memory.
const NOWHERE: *const u32 = 0x6000_0000 as *const u32;

/// In the main loop: injects the fault that the simulator asks for.
pub fn in_main() {
    match shared::get(layout::PROVOKE) {
        layout::PROVOKE_PANIC => {
            shared::set(layout::PROVOKE, layout::PROVOKE_NOTHING);
            panic!("injected");
        }
        layout::PROVOKE_HARD_FAULT => {
            shared::set(layout::PROVOKE, layout::PROVOKE_NOTHING);
            // SAFETY: nothing is read: there is no memory, and the bus fault that follows is the purpose.
            black_box(unsafe { NOWHERE.read_volatile() });
        }
        layout::PROVOKE_STACK_OVERFLOW => {
            shared::set(layout::PROVOKE, layout::PROVOKE_NOTHING);
            black_box(without_end(0));
        }
        _ => {}
    }
}

/// In the tick: overruns it, if the simulator asks for that.
#[inline]
pub fn in_tick() {
    if shared::get(layout::PROVOKE) == layout::PROVOKE_OVERRUN {
        shared::set(layout::PROVOKE, layout::PROVOKE_NOTHING);
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
