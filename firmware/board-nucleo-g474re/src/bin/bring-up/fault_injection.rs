//! Injects faults. Each resets the board, and the next start checks that the reason was stored.

use core::sync::atomic::{AtomicU32, Ordering};

use board_nucleo_g474re::watchdog::Watchdog;
use frixel_board::bring_up::{FAULTS, Injection};
use frixel_board::fault::LastReset;
use frixel_cortex_m::retained;
use frixel_wire::fault::Fault;

/// Marks the memory below as valid; the number of injected faults is in its lowest byte.
const MARK: u32 = 0x7072_6f00;

/// Kept over a reset: [`MARK`] and the number of injected faults.
#[unsafe(link_section = ".uninit.INJECTED")]
static INJECTED: AtomicU32 = AtomicU32::new(0);

/// Progress of the fault injection after the last reset. Called once.
pub(crate) fn after(last_reset: &LastReset) -> Injection {
    let kept = retained(&INJECTED).swap(0, Ordering::Relaxed);
    let injected = if kept & !0xff == MARK { (kept & 0xff) as usize } else { 0 };
    Injection::after_reset(injected, last_reset.fault.map(|(fault, _)| fault))
}

/// Injects a fault.
pub(crate) fn inject(fault: Fault) -> ! {
    let injected = FAULTS.iter().take_while(|other| **other != fault).count() + 1;
    retained(&INJECTED).store(MARK | injected as u32, Ordering::Relaxed);
    match fault {
        // An undefined instruction.
        Fault::HardFault => cortex_m::asm::udf(),
        Fault::StackOverflow => {
            overflow(0);
            panic!("the stack did not overflow")
        }
        Fault::Watchdog => {
            let _watchdog = Watchdog::start();
            loop {
                cortex_m::asm::nop();
            }
        }
        _ => panic!("injected, with a number: {injected}"),
    }
}

/// Calls itself until there is no stack left.
#[allow(unconditional_recursion, reason = "that is its purpose")]
#[inline(never)]
fn overflow(depth: u32) -> u32 {
    let filler = core::hint::black_box([depth; 64]);
    overflow(filler[0] + 1) + filler[63]
}
