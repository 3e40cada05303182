//! The tick: the timer's interrupt at `tick_hz`, above every other interrupt and every critical section. It never logs
//! and never waits.

use core::sync::atomic::{AtomicU32, Ordering};

#[cfg(feature = "telemetry")]
use frixel_control::TickMeter;
use frixel_control::{Sense, Ticker};
use frixel_drivers::amplifier::Amplifier;
use frixel_drivers::arm_switch::ArmSwitch;
use frixel_drivers::bus_handover::BusHandover;
use frixel_session::TickEnds;
use frixel_wire::fault::Fault;

use crate::hardware::{DacFrames, Hardware, Monitor, Period};

/// Data shared between the tick and the rest of the program. A board has one, in a static.
pub struct TickShared {
    count: AtomicU32,
    /// A fault found outside the tick: its number above [`FAULT_SHIFT`], its detail below; zero without a fault.
    fault: AtomicU32,
    /// Arbitrates the DAC's bus between the tick and the main loop, which checks the DAC before the board arms and
    /// before it plays.
    pub bus: BusHandover,
    /// Durations of the ticks, for telemetry.
    #[cfg(feature = "telemetry")]
    pub meter: TickMeter,
}

const FAULT_SHIFT: u32 = 24;
const DETAIL_MASK: u32 = (1 << FAULT_SHIFT) - 1;

impl TickShared {
    /// Before the first tick, on a board whose timer is `P`.
    #[must_use]
    pub const fn new<P: Period>() -> Self {
        Self {
            count: AtomicU32::new(0),
            fault: AtomicU32::new(0),
            bus: BusHandover::new(),
            #[cfg(feature = "telemetry")]
            meter: TickMeter::new(P::DEADLINE_CYCLES),
        }
    }

    /// Ticks since reset, modulo 2^32.
    #[inline]
    pub fn count(&self) -> u32 {
        self.count.load(Ordering::Relaxed)
    }

    /// Raises a fault at the next tick, and replaces one already raised for it. `detail` has 24 bits.
    pub fn raise(&self, fault: Fault, detail: u32) {
        self.fault.store(u32::from(fault.number()) << FAULT_SHIFT | detail & DETAIL_MASK, Ordering::Release);
    }
}

/// Data used only by the interrupt. The interrupt of the board's timer calls [`Tick::run`], and does nothing else.
pub struct Tick<H: Hardware> {
    /// Data shared with the rest of the program.
    pub shared: &'static TickShared,
    /// Computes the voltage from touch and scene.
    pub ticker: Ticker<'static>,
    /// Its ends of the queues.
    pub queues: TickEnds,
    /// The timer.
    pub period: H::Period,
    /// The DAC.
    pub frames: H::Frames,
    /// The amplifier.
    pub amplifier: Amplifier<H::Enable, H::Ready>,
    /// The amplifier's monitor.
    pub monitor: H::Monitor,
    /// The switch held by a person.
    pub arm_switch: ArmSwitch<H::Switch>,
}

impl<H: Hardware> Tick<H> {
    /// Runs one tick.
    ///
    /// Deadline: the frame for the DAC must begin within [`Period::DEADLINE_CYCLES`] of the period. A tick that misses
    /// the deadline, or has not ended when the next period begins, sets the output to zero and raises
    /// [`Fault::Deadline`]. The fault's detail is the time taken, in cycles.
    #[inline]
    pub fn run(&mut self) {
        // Acknowledges the interrupt.
        let _ = self.period.has_begun();
        // Before anything with a variable duration: the DAC has just output a code, which soon moves the monitor.
        let sense = self.sense();
        let shared = self.shared;
        shared.count.store(shared.count().wrapping_add(1), Ordering::Relaxed);
        self.queues.apply_order(&mut self.ticker);
        let found = shared.fault.load(Ordering::Acquire);
        if found != 0 {
            self.raise_found(found);
        }
        let drive = self.ticker.tick(&sense);
        let cycles = self.period.cycles();
        let output_is_zero = !drive.amplifier_enable && !self.queues.has_order();
        let mut is_late = false;
        if !shared.bus.tick_sends(output_is_zero) {
            self.amplifier.set_enabled(false);
        } else if self.frames.send(drive.dac_code).is_ok() {
            self.amplifier.set_enabled(drive.amplifier_enable);
        } else {
            is_late = true;
            self.late(self.period.cycles());
        }
        self.queues.offer_status(&self.ticker);
        let has_ended_in_time = !self.period.has_begun();
        let cycles = if has_ended_in_time { cycles } else { H::Period::PERIOD_CYCLES + self.period.cycles() };
        #[cfg(feature = "telemetry")]
        shared.meter.record(cycles);
        // A tick that was too late for the DAC and has also not ended in time is one missed deadline.
        if !has_ended_in_time && !is_late {
            self.late(cycles);
        }
    }

    fn sense(&mut self) -> Sense {
        Sense {
            amplifier_fault: self.amplifier.has_fault(),
            monitor_v: self.monitor.monitor_v(),
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
        self.shared.fault.store(0, Ordering::Relaxed);
        if let Ok(fault) = Fault::try_from((found >> FAULT_SHIFT) as u8) {
            self.ticker.raise(fault, found & DETAIL_MASK);
        }
    }
}
