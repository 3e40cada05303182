//! Injects one fault after the other. Each restarts the board, and the next start checks that the fault was stored.

use core::sync::atomic::{AtomicU32, Ordering};

use board_nucleo_g474re::fault::LastReset;
use board_nucleo_g474re::watchdog::Watchdog;
use defmt::{error, info};
use frixel_wire::fault::Fault;

/// The faults, in this order.
const FAULTS: [Fault; 4] = [Fault::Panic, Fault::HardFault, Fault::StackOverflow, Fault::Watchdog];
/// Marks the memory below as valid; the number of injected faults stands in its lowest byte.
const MARK: u32 = 0x7072_6f00;

/// Kept across restarts: [`MARK`] and the number of injected faults.
#[unsafe(link_section = ".uninit.INJECTED")]
static INJECTED: AtomicU32 = AtomicU32::new(0);

fn injected() -> usize {
    let injected = INJECTED.load(Ordering::Relaxed);
    if injected & !0xff == MARK { (injected & 0xff) as usize } else { 0 }
}

/// Whether all faults have been injected.
pub(crate) fn are_done() -> bool {
    injected() >= FAULTS.len()
}

/// After a restart by an injected fault: logs whether it was stored, and returns whether another one follows.
pub(crate) fn continues_after(last_reset: &LastReset) -> bool {
    let Some(expected) = injected().checked_sub(1).and_then(|index| FAULTS.get(index)) else { return false };
    let found = last_reset.fault.map(|(fault, _)| fault);
    if found == Some(*expected) {
        info!("fault {=u8}, as injected: {=[u8]:a}", expected.number(), last_reset.text);
    } else if found.is_none() {
        // Power-on, or the reset button: bring-up starts from the beginning.
        INJECTED.store(0, Ordering::Relaxed);
        return false;
    } else {
        error!("fault {=u8} was injected, {=u8} was stored", expected.number(), found.map_or(0, Fault::number));
    }
    if are_done() {
        info!("all faults were stored; restart, and continue with step 7 after step 6");
        return false;
    }
    true
}

/// Injects the next fault.
pub(crate) fn next() -> ! {
    let index = injected();
    INJECTED.store(MARK | (index + 1) as u32, Ordering::Relaxed);
    match FAULTS.get(index) {
        Some(Fault::HardFault) => hard_fault(),
        Some(Fault::StackOverflow) => {
            overflow(0);
            panic!("the stack did not overflow")
        }
        Some(Fault::Watchdog) => {
            let _watchdog = Watchdog::start();
            loop {
                cortex_m::asm::nop();
            }
        }
        _ => panic!("injected, with a number: {index}"),
    }
}

fn hard_fault() -> ! {
    // An undefined instruction.
    cortex_m::asm::udf()
}

/// Calls itself until there is no stack left.
#[allow(unconditional_recursion, reason = "that is its purpose")]
#[inline(never)]
fn overflow(depth: u32) -> u32 {
    let filler = core::hint::black_box([depth; 64]);
    overflow(filler[0] + 1) + filler[63]
}
