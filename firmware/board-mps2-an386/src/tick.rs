//! The interrupt of `SysTick`, above every other interrupt and every critical section. It runs the tick of
//! [`frixel_board::tick`], and passes to the simulator what the tick puts out.

use cortex_m::peripheral::SYST;
use cortex_m_rt::exception;
use frixel_board::tick::{Tick, TickShared};
use frixel_control::Ticker;
use frixel_cortex_m::Owned;
use frixel_drivers::amplifier::Amplifier;
use frixel_drivers::arm_switch::ArmSwitch;
use frixel_session::TickEnds;

use crate::board::Mps2;
use crate::inputs::{Monitor, Ready, Switch};
use crate::output::{Enable, Frames};
use crate::period::{HostWait, Period};
use crate::{inputs, output, period};

static INTERRUPT: Owned<Interrupt> = Owned::new();
/// What the tick shares with the main loop.
pub static SHARED: TickShared = TickShared::new::<Period>();

/// What the arm switch is told of its readings a second, so that a single one counts: the simulated contact does not
/// bounce, and a host may arm at any tick, because the person is always ready.
const SWITCH_HZ: u32 = 50;

/// Everything that only the interrupt uses.
struct Interrupt {
    tick: Tick<Mps2>,
    host_wait: HostWait,
}

/// Starts the tick.
pub fn start(ticker: Ticker<'static>, queues: TickEnds, systick: SYST) {
    let tick = Tick {
        shared: &SHARED,
        ticker,
        queues,
        period: Period,
        frames: Frames,
        amplifier: Amplifier::new(Enable, Ready),
        monitor: Monitor::new(),
        arm_switch: ArmSwitch::new(Switch, SWITCH_HZ),
    };
    if INTERRUPT.give(Interrupt { tick, host_wait: HostWait::default() }).is_some() {
        period::start(systick);
    }
}

#[exception]
fn SysTick() {
    // SAFETY: this is the handler that owns the value.
    let Some(Interrupt { tick, host_wait }) = (unsafe { INTERRUPT.get() }) else { return };
    if host_wait.is_needed() {
        return;
    }
    // The person lets go of the switch whenever the board waits for that.
    inputs::hold_switch(!tick.ticker.waits_for_release());
    tick.run();
    output::publish(SHARED.count());
}
