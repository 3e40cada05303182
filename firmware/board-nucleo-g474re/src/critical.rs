//! Critical sections that never mask the tick.
//!
//! They raise BASEPRI to priority 1, which masks every interrupt except those of priority 0. The tick is the only one
//! with that priority (PM0214, "Exception mask registers"). So the tick must not use critical sections: no logging,
//! and no `singleton!`.

use core::sync::atomic::{Ordering, compiler_fence};

use cortex_m::register::basepri;
use critical_section::RawRestoreState;

/// The priority is in the upper four bits of eight.
const BELOW_THE_TICK: u8 = 1 << 4;

struct BelowTheTick;
critical_section::set_impl!(BelowTheTick);

// SAFETY: inside, only this context and the tick can run, and the tick uses no critical section.
unsafe impl critical_section::Impl for BelowTheTick {
    unsafe fn acquire() -> RawRestoreState {
        let before = basepri::read();
        // SAFETY: raising the mask is always sound; nested sections find it raised already.
        unsafe { basepri::write(BELOW_THE_TICK) };
        compiler_fence(Ordering::SeqCst);
        before
    }

    unsafe fn release(before: RawRestoreState) {
        compiler_fence(Ordering::SeqCst);
        // SAFETY: restores the mask that `acquire` found.
        unsafe { basepri::write(before) };
    }
}
