//! Mishaps on demand, for the tests of what becomes of them.

use core::hint::black_box;

use frixel_exchange::layout;

use crate::shared;

/// More loops than there are in two ticks.
const OVERRUN_LOOPS: u32 = 10_000;

/// Where there is no memory.
const NOWHERE: *const u32 = 0x6000_0000 as *const u32;

/// Brings about what the main program can be made to do.
pub fn in_main() {
    match shared::get(layout::PROVOKE) {
        layout::PROVOKE_PANIC => {
            shared::set(layout::PROVOKE, layout::PROVOKE_NOTHING);
            panic!("provoked");
        }
        layout::PROVOKE_HARD_FAULT => {
            shared::set(layout::PROVOKE, layout::PROVOKE_NOTHING);
            // SAFETY: it is not; that is the point.
            black_box(unsafe { NOWHERE.read_volatile() });
        }
        layout::PROVOKE_STACK_OVERFLOW => {
            shared::set(layout::PROVOKE, layout::PROVOKE_NOTHING);
            black_box(without_end(0));
        }
        _ => {}
    }
}

/// Brings about what the tick can be made to do.
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
