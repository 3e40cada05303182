//! The tick: the interrupt of TIM3, 40,000 times a second, at priority 0, above every other interrupt and every
//! critical section. It never logs and never waits.
//!
//! | pin | function | |
//! |---|---|---|
//! | PC10 | input, pulled down | amplifier: high while it is ready |
//! | PB2 | input, pulled down | arm switch: high while held |
//!
//! The two lie on different connectors (PC10 on CN7, PB2 on CN10 beside a ground pin), so that no bridge between
//! neighbours closes the switch (UM2505, "Extension connectors", unread).

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::NVIC;
#[cfg(feature = "telemetry")]
use frixel_control::TickMeter;
use frixel_control::{Sense, Ticker};
use frixel_drivers::amplifier::Amplifier;
use frixel_drivers::arm_switch::ArmSwitch;
use frixel_drivers::bus_handover::BusHandover;
use frixel_session::TickEnds;
use frixel_wire::fault::Fault;
use stm32_metapac::{GPIOB, GPIOC, Interrupt, interrupt};

use crate::adc::Adc;
use crate::board::TICK_HZ;
use crate::dac::DacFrames;
use crate::output::Output;
use crate::owned::Owned;
use crate::pins::Pin;
use crate::{period, pins};

const AMPLIFIER_READY: u32 = 10;
const ARM_SWITCH: u32 = 2;

static TICK: Owned<Tick> = Owned::new();
/// How long the ticks take, for telemetry.
#[cfg(feature = "telemetry")]
pub static METER: TickMeter = TickMeter::new(period::DEADLINE_CYCLES);
static COUNT: AtomicU32 = AtomicU32::new(0);
/// Arbitrates the DAC's bus between the tick and the main loop, which checks the DAC before the board arms and before
/// it plays.
pub static DAC_BUS: BusHandover = BusHandover::new();
/// A fault that the main loop has found: its number above [`FAULT_SHIFT`], its detail below; zero without a fault.
static FAULT: AtomicU32 = AtomicU32::new(0);
const FAULT_SHIFT: u32 = 24;

#[cfg(feature = "log")]
defmt::timestamp!("tick {=u32}", count());

/// The ticker, and everything else that only the interrupt uses.
pub struct Tick {
    /// Computes the voltage from touch and scene.
    pub ticker: Ticker<'static>,
    /// Its ends of the queues.
    pub queues: TickEnds,
    /// The amplifier's monitor.
    pub adc: Adc,
    /// The DAC.
    pub dac: DacFrames,
    /// The amplifier. While its enable is low, the DAC is cleared, too.
    pub amplifier: Amplifier<Output, Pin>,
    /// The switch that a person holds.
    pub arm_switch: ArmSwitch<Pin>,
}

/// Starts the tick.
pub fn start(tick: Tick) {
    // SAFETY: TIM3 is unmasked below.
    unsafe { TICK.give(tick) };
    period::start_interrupts();
    // SAFETY: no critical section depends on it being masked. Priority 0, the highest, is its priority from reset on.
    unsafe { NVIC::unmask(Interrupt::TIM3) };
}

/// The amplifier behind the one-shot.
pub fn amplifier(output: Output) -> Amplifier<Output, Pin> {
    Amplifier::new(output, Pin::input_pulled_down(GPIOC, AMPLIFIER_READY))
}

/// The arm switch.
pub fn arm_switch() -> ArmSwitch<Pin> {
    ArmSwitch::new(Pin::input_pulled_down(GPIOB, ARM_SWITCH), TICK_HZ)
}

/// Configures both input pins before the tick runs, for bring-up.
pub fn start_inputs() {
    pins::input_pulled_down(GPIOC, AMPLIFIER_READY);
    pins::input_pulled_down(GPIOB, ARM_SWITCH);
}

/// Ticks since reset, modulo 2^32.
pub fn count() -> u32 {
    COUNT.load(Ordering::Relaxed)
}

/// Raises a fault at the next tick. `detail` has 24 bits.
pub fn raise(fault: Fault, detail: u32) {
    FAULT.store(u32::from(fault.number()) << FAULT_SHIFT | detail & ((1 << FAULT_SHIFT) - 1), Ordering::Release);
}

/// The levels of the inputs: the amplifier is ready, and the contact of the arm switch is closed.
pub fn inputs() -> (bool, bool) {
    (pins::is_high(GPIOC, AMPLIFIER_READY), pins::is_high(GPIOB, ARM_SWITCH))
}

/// Deadline: the frame for the DAC must begin within [`period::DEADLINE_CYCLES`] of the period, 21.8 us. A tick that
/// misses it sets the output to zero and raises a fault, and so does a tick that has not ended when the next begins.
/// The fault's detail is the time taken, in cycles.
#[interrupt]
fn TIM3() {
    let _ = period::has_begun();
    // SAFETY: this is the handler that owns the value.
    if let Some(tick) = unsafe { TICK.get() } {
        tick.run();
    }
}

impl Tick {
    fn run(&mut self) {
        COUNT.store(count().wrapping_add(1), Ordering::Relaxed);
        self.queues.apply_order(&mut self.ticker);
        let found = FAULT.load(Ordering::Acquire);
        if found != 0 {
            self.raise_found(found);
        }
        let sense = self.sense();
        let drive = self.ticker.tick(&sense);
        let cycles = period::cycles();
        let output_is_zero = !drive.amplifier_enable && !self.queues.has_order();
        let mut is_late = false;
        if !DAC_BUS.tick_sends(output_is_zero) {
            self.amplifier.set_enabled(false);
        } else if self.dac.send(drive.dac_code) {
            self.amplifier.set_enabled(drive.amplifier_enable);
        } else {
            is_late = true;
            self.late(period::cycles());
        }
        self.queues.offer_status(&self.ticker);
        let has_ended_in_time = !period::has_begun();
        let cycles = if has_ended_in_time { cycles } else { period::PERIOD_CYCLES + period::cycles() };
        #[cfg(feature = "telemetry")]
        METER.record(cycles);
        // A tick that was too late for the DAC and has not ended in time either is one missed deadline.
        if !has_ended_in_time && !is_late {
            self.late(cycles);
        }
    }

    fn sense(&mut self) -> Sense {
        Sense {
            amplifier_fault: self.amplifier.has_fault(),
            monitor_v: self.adc.monitor_v(),
            arm_switch: self.arm_switch.is_held(),
        }
    }

    #[cold]
    fn late(&mut self, cycles: u32) {
        self.amplifier.set_enabled(false);
        self.ticker.raise(Fault::Deadline, cycles);
    }

    #[cold]
    fn raise_found(&mut self, found: u32) {
        FAULT.store(0, Ordering::Relaxed);
        if let Ok(fault) = Fault::try_from((found >> FAULT_SHIFT) as u8) {
            self.ticker.raise(fault, found & ((1 << FAULT_SHIFT) - 1));
        }
    }
}
