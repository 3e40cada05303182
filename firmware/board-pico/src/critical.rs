//! Critical sections that never mask the tick: they mask the only other interrupt, that of the serial port. So the tick
//! must not use critical sections: no `singleton!`.

use core::sync::atomic::{Ordering, compiler_fence};

use cortex_m::peripheral::NVIC;
use critical_section::RawRestoreState;
use rp_pac::Interrupt;

struct BelowTheTick;
critical_section::set_impl!(BelowTheTick);

// SAFETY: inside, only this context and the tick can run, and the tick uses no critical section.
unsafe impl critical_section::Impl for BelowTheTick {
    unsafe fn acquire() -> RawRestoreState {
        let was_enabled = NVIC::is_enabled(Interrupt::UART0_IRQ);
        NVIC::mask(Interrupt::UART0_IRQ);
        // The interrupt may still be taken until the write has reached the controller.
        cortex_m::asm::dsb();
        cortex_m::asm::isb();
        compiler_fence(Ordering::SeqCst);
        was_enabled
    }

    unsafe fn release(was_enabled: RawRestoreState) {
        compiler_fence(Ordering::SeqCst);
        if was_enabled {
            // SAFETY: restores what `acquire` found.
            unsafe { NVIC::unmask(Interrupt::UART0_IRQ) };
        }
    }
}
