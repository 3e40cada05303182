//! Faults on purpose, one after the other: each restarts the board, and the next start sees whether its reason was kept.

use core::sync::atomic::{AtomicU32, Ordering};

use board_nucleo_g474re::fault::LastReset;
use board_nucleo_g474re::watchdog::Watchdog;
use defmt::{error, info};
use frixel_wire::fault::Fault;

/// What is provoked, in this order.
const FAULTS: [Fault; 4] = [Fault::Panic, Fault::HardFault, Fault::StackOverflow, Fault::Watchdog];
/// Above the number of the fault that was provoked last.
const MARK: u32 = 0x7072_6f00;

/// Kept over the restarts: [`MARK`] and how many faults were provoked.
#[unsafe(link_section = ".uninit.PROVOKED")]
static PROVOKED: AtomicU32 = AtomicU32::new(0);

fn provoked() -> usize {
    let provoked = PROVOKED.load(Ordering::Relaxed);
    if provoked & !0xff == MARK { (provoked & 0xff) as usize } else { 0 }
}

/// Whether all were.
pub(crate) fn are_done() -> bool {
    provoked() >= FAULTS.len()
}

/// After a restart that was provoked: says what was kept, and whether there is more to provoke.
pub(crate) fn go_on(last_reset: &LastReset) -> bool {
    let Some(expected) = provoked().checked_sub(1).and_then(|index| FAULTS.get(index)) else { return false };
    let found = last_reset.fault.map(|(fault, _)| fault);
    if found == Some(*expected) {
        info!("fault {=u8}, as provoked: {=[u8]:a}", expected.number(), last_reset.text);
    } else if found.is_none() {
        // Power-on, or the button: somebody begins again.
        PROVOKED.store(0, Ordering::Relaxed);
        return false;
    } else {
        error!("fault {=u8} was provoked, {=u8} was kept", expected.number(), found.map_or(0, Fault::number));
    }
    if are_done() {
        info!("all faults were kept; begin again, and go on with step 7 after step 6");
        return false;
    }
    true
}

/// Provokes the next one.
pub(crate) fn next() -> ! {
    let index = provoked();
    PROVOKED.store(MARK | (index + 1) as u32, Ordering::Relaxed);
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
        _ => panic!("provoked, with a number: {index}"),
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
