//! The tick: `SysTick` at 40 kHz, above every other interrupt and every critical section.

use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use cortex_m_rt::exception;
use frixel_control::{Sense, Ticker};
use frixel_exchange::layout;
use frixel_session::TickEnds;
use frixel_testkit::IdealMonitor;
use frixel_wire::fault::Fault;

use crate::owned::Owned;
use crate::{fault_injection, shared};

/// Clock of `SysTick` on this machine.
const CLOCK_HZ: u32 = 25_000_000;

static TICK: Owned<Tick> = Owned::new();

/// The ticker, and everything else that only the interrupt uses.
pub struct Tick {
    /// Computes the voltage from touch and scene.
    pub ticker: Ticker<'static>,
    /// Its ends of the queues between it and the session.
    pub queues: TickEnds,
    /// There is no amplifier: its monitor follows the driven voltage as the board's amplifier is specified to.
    pub monitor: IdealMonitor,
    /// Ticks since reset.
    pub count: u32,
    /// The wait for a host that has not answered for its slice of time.
    pub host_wait: HostWait,
}

/// Stops the board's clock while a host is connected and has not answered for its slice of time: a busy machine would
/// otherwise let the board run on while it does not let the host run at all.
#[derive(Default)]
pub struct HostWait {
    /// [`layout::HOST_ANSWERED_TO`] as it was last read.
    answered_to: u32,
    /// Tick periods that the clock has stood still there.
    waited: u32,
}

impl HostWait {
    /// Tick periods after which the board no longer waits, 10 s: the host has hung, or was killed, and its host timeout
    /// has to act. Virtual time is never ahead of wall time.
    const MAX: u32 = 400_000;

    /// Whether the clock stands still in this tick period.
    fn is_needed(&mut self) -> bool {
        let answered_to = shared::get(layout::HOST_ANSWERED_TO);
        if answered_to != self.answered_to {
            *self = Self { answered_to, waited: 0 };
        }
        // Both counts wrap at 2^32; their difference always fits in an `i32`.
        let is_ahead = shared::get(layout::DRIVES_WRITTEN).wrapping_sub(answered_to).cast_signed() >= 0;
        if shared::get(layout::HOST_OPEN) == 0 || !is_ahead || self.waited >= Self::MAX {
            return false;
        }
        self.waited += 1;
        true
    }
}

/// Starts the tick.
pub fn start(tick: Tick, tick_hz: u32, mut systick: SYST) {
    // SAFETY: SysTick is enabled below.
    unsafe { TICK.give(tick) };
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(CLOCK_HZ / tick_hz - 1);
    systick.clear_current();
    systick.enable_interrupt();
    systick.enable_counter();
}

/// Deadline: the drive must be put out before the next tick begins, 25 us. If it is late, the next `SysTick` is
/// pending already, and the ticker raises a fault whose detail is the time taken, in counts of 40 ns.
#[exception]
fn SysTick() {
    // SAFETY: this is the handler that owns the value.
    let Some(tick) = (unsafe { TICK.get() }) else { return };
    if tick.host_wait.is_needed() {
        return;
    }
    tick.run();
    if SCB::is_pendst_pending() {
        let reload = SYST::get_reload();
        tick.ticker.raise(Fault::Deadline, 2 * reload - SYST::get_current());
    }
}

impl Tick {
    fn run(&mut self) {
        self.count = self.count.wrapping_add(1);
        self.queues.apply_order(&mut self.ticker);
        let sense = Sense {
            amplifier_fault: shared::get(layout::AMPLIFIER_FAULT) != 0,
            monitor_v: self.monitor.voltage_v(),
            arm_switch: !self.ticker.waits_for_release(),
        };
        let drive = self.ticker.tick(&sense);
        shared::drive(self.count, drive);
        self.monitor.follow(drive.dac_code);
        self.queues.offer_status(&self.ticker);
        fault_injection::in_tick();
    }
}
