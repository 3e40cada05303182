//! Critical sections that never mask the tick.
//!
//! They raise BASEPRI to priority 1, so that they hold back every interrupt but those of priority 0, and the tick is the
//! only one of these (PM0214, "Exception mask registers"). The tick in turn must not use one: no logging there, and no `singleton!`.

use core::sync::atomic::{Ordering, compiler_fence};

use cortex_m::register::basepri;
use critical_section::RawRestoreState;

/// Priorities are the upper four bits of eight.
const BELOW_THE_TICK: u8 = 1 << 4;

struct BelowTheTick;
critical_section::set_impl!(BelowTheTick);

// SAFETY: inside, no code runs but this context and the tick, which uses no critical section.
unsafe impl critical_section::Impl for BelowTheTick {
    unsafe fn acquire() -> RawRestoreState {
        let before = basepri::read();
        // SAFETY: masking more than before breaks nothing; nested sections find the mask set already.
        unsafe { basepri::write(BELOW_THE_TICK) };
        compiler_fence(Ordering::SeqCst);
        before
    }

    unsafe fn release(before: RawRestoreState) {
        compiler_fence(Ordering::SeqCst);
        // SAFETY: back to what `acquire` found.
        unsafe { basepri::write(before) };
    }
}
