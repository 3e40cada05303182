//! The interrupt of `SysTick`, above every other interrupt and every critical section. It runs the tick of
//! [`frixel_board::tick`], and passes its output to the simulator.

use cortex_m::peripheral::SYST;
use cortex_m_rt::exception;
use frixel_board::tick::{Tick, TickShared};
use frixel_cortex_m::{Boot, TickOwner};

use crate::board::Mps2;
use crate::period::Period;
use crate::{inputs, output, period};

static TICK: TickOwner<Mps2> = TickOwner::new();
/// Data shared between the tick and the main loop.
pub static SHARED: TickShared = TickShared::new::<Period>();

/// Gives the tick to its interrupt, and enables the interrupt.
pub fn start(boot: Boot, tick: Tick<Mps2>, systick: SYST) {
    TICK.give(boot, tick);
    period::start(systick);
}

#[exception]
fn SysTick() {
    // SAFETY: this is the handler.
    unsafe { TICK.with(run) }
}

fn run(tick: &mut Tick<Mps2>) {
    if tick.period.host_wait.is_needed() {
        return;
    }
    // The simulated person releases the switch whenever the board waits for that.
    inputs::hold_switch(!tick.ticker.waits_for_release());
    tick.run();
    output::publish(SHARED.count());
}
