//! The tick: `SysTick` at 40 kHz, above every other interrupt and every critical section.

use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use cortex_m_rt::exception;
use frixel_control::{Active, Board, Order, Sense, Status, Ticker};
use frixel_exchange::layout;
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::Fault;
use heapless::spsc::{Consumer, Producer};

use crate::owned::Owned;
use crate::{fault_injection, shared};

/// Clock of `SysTick` on this machine.
const CLOCK_HZ: u32 = 25_000_000;

static TICK: Owned<Tick> = Owned::new();
static STATUS_REQUESTED: AtomicBool = AtomicBool::new(false);

/// What the tick owns: the ticker and its ends of the queues.
pub struct Tick {
    /// Computes the voltage from touch and scene.
    pub ticker: Ticker<'static>,
    /// Orders from the session.
    pub orders: Consumer<'static, Order<'static>>,
    /// Coefficients to return to the session.
    pub spares: Producer<'static, &'static mut Active>,
    /// A status for the session, if requested.
    pub statuses: Producer<'static, Status>,
    /// The amplifier's monitor.
    pub monitor: Monitor,
    /// Ticks since reset.
    pub count: u32,
}

/// The amplifier's monitor. There is no amplifier: the monitor follows the driven voltage, with the edges that the
/// board specifies.
pub struct Monitor {
    voltage_v: f32,
    volts_per_code: f32,
    step: f32,
}

impl Monitor {
    /// The monitor of a board at 0 V.
    pub fn new(board: &Board) -> Self {
        let tick_period_s = 1.0 / board.tick_hz as f32;
        Self {
            voltage_v: 0.0,
            volts_per_code: board.limits.full_scale_v_peak / f32::from(i16::MAX),
            step: 1.0 - libm::expf(-tick_period_s / board.limits.edge_time_constant_s),
        }
    }

    fn follow(&mut self, dac_code: DacCode) {
        self.voltage_v += self.step * (f32::from(dac_code.bits()) * self.volts_per_code - self.voltage_v);
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

/// Requests a status from the tick.
pub fn request_status() {
    STATUS_REQUESTED.store(true, Ordering::Release);
}

/// Deadline: the drive must be put out before the next tick begins, 25 us. If it is late, the next `SysTick` is
/// pending already, and the ticker raises a fault whose detail is the time taken, in counts of 40 ns.
#[exception]
fn SysTick() {
    // SAFETY: this is the handler that owns the value.
    let Some(tick) = (unsafe { TICK.get() }) else { return };
    tick.run();
    if SCB::is_pendst_pending() {
        let reload = SYST::get_reload();
        tick.ticker.raise(Fault::Deadline, 2 * reload - SYST::get_current());
    }
}

impl Tick {
    fn run(&mut self) {
        self.count = self.count.wrapping_add(1);
        if let Some(order) = self.orders.dequeue()
            && let Some(spare) = self.ticker.apply(order)
        {
            // Cannot fail: there are two of them, and room for both.
            let _ = self.spares.enqueue(spare);
        }
        let sense = Sense {
            amplifier_fault: shared::get(layout::AMPLIFIER_FAULT) != 0,
            monitor_v: self.monitor.voltage_v,
            arm_switch: !self.ticker.waits_for_release(),
        };
        let drive = self.ticker.tick(&sense);
        shared::drive(self.count, drive);
        self.monitor.follow(drive.dac_code);
        if STATUS_REQUESTED.load(Ordering::Acquire) {
            STATUS_REQUESTED.store(false, Ordering::Relaxed);
            // Cannot fail: the session requests the next status only after it has taken this one.
            let _ = self.statuses.enqueue(self.ticker.status());
        }
        fault_injection::in_tick();
    }
}
