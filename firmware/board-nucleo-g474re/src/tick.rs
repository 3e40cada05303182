//! The tick: the interrupt of TIM3, 40,000 times a second, at priority 0, above every other interrupt and every critical
//! section. It logs nothing and waits for nothing.
//!
//! | pin | function | |
//! |---|---|---|
//! | PC10 | input, pulled down | amplifier: high while all is well |
//! | PC11 | input, pulled down | arm switch: high while held |

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use cortex_m::peripheral::NVIC;
use frixel_parts::arm_switch::ArmSwitch;
use frixel_render::{Active, Order, Sense, Status, Ticker};
use frixel_wire::fault::Fault;
use heapless::spsc::{Consumer, Producer};
use stm32_metapac::{GPIOC, Interrupt, interrupt};

use crate::adc::Adc;
use crate::dac::Dac;
use crate::output::Output;
use crate::owned::Owned;
use crate::{period, pins};

const AMPLIFIER_WELL: u32 = 10;
const ARM_SWITCH: u32 = 11;
const BUTTON: u32 = 13;

static TICK: Owned<Tick> = Owned::new();
static STATUS_WANTED: AtomicBool = AtomicBool::new(false);
static COUNT: AtomicU32 = AtomicU32::new(0);

#[cfg(feature = "log")]
defmt::timestamp!("tick {=u32}", count());

/// What the tick owns.
pub struct Tick {
    /// Turns touch into voltage.
    pub ticker: Ticker<'static>,
    /// Its ends of the queues.
    pub queues: Queues,
    /// The amplifier's monitor.
    pub adc: Adc,
    /// The DAC.
    pub dac: Dac,
    /// Amplifier enable and DAC clear.
    pub output: Output,
    /// The switch that a person holds.
    pub arm_switch: ArmSwitch,
}

/// The tick's ends of the queues between it and the main loop.
pub struct Queues {
    /// Orders from the session.
    pub orders: Consumer<'static, Order<'static>>,
    /// Coefficients that go back to the session.
    pub spares: Producer<'static, &'static mut Active>,
    /// A status for the session, when it asked for one.
    pub statuses: Producer<'static, Status>,
}

/// Starts to tick. [`start_inputs`] comes before.
pub fn start(tick: Tick) {
    // SAFETY: TIM3 is unmasked below.
    unsafe { TICK.give(tick) };
    period::start_interrupts();
    // SAFETY: no critical section depends on it being masked. Priority 0, the highest, is its priority from reset on.
    unsafe { NVIC::unmask(Interrupt::TIM3) };
}

/// Takes the input pins. The button of the board, PC13, is an input, too, which only bring-up looks at.
pub fn start_inputs() {
    pins::input_pulled_down(GPIOC, AMPLIFIER_WELL);
    pins::input_pulled_down(GPIOC, ARM_SWITCH);
    pins::input(GPIOC, BUTTON);
}

/// Ticks since reset, modulo 2^32.
pub fn count() -> u32 {
    COUNT.load(Ordering::Relaxed)
}

/// Asks the tick for a status.
pub fn want_status() {
    STATUS_WANTED.store(true, Ordering::Release);
}

/// What the inputs say: the amplifier is well, and the contact of the arm switch is closed.
pub fn inputs() -> (bool, bool) {
    (pins::is_high(GPIOC, AMPLIFIER_WELL), pins::is_high(GPIOC, ARM_SWITCH))
}

/// Deadline: the frame for the DAC has to be begun [`period::DEADLINE_CYCLES`] into the period, 21.8 us. A tick that is too
/// late puts the output to zero and faults, and so does one that has not ended when the next begins; the number that goes
/// with the fault is the time taken, in cycles.
#[interrupt]
fn TIM3() {
    let _ = period::has_begun();
    // SAFETY: this is the handler that owns it.
    if let Some(tick) = unsafe { TICK.get() } {
        tick.run();
    }
}

impl Tick {
    fn run(&mut self) {
        COUNT.store(count().wrapping_add(1), Ordering::Relaxed);
        if let Some(order) = self.queues.orders.dequeue()
            && let Some(spare) = self.ticker.apply(order)
        {
            // There are two of them, and room for both.
            let _ = self.queues.spares.enqueue(spare);
        }
        let sense = self.sense();
        let drive = self.ticker.tick(&sense);
        if self.dac.send(drive.dac_code) {
            if drive.amplifier_enable { self.output.kick() } else { self.output.zero() }
        } else {
            self.late(period::cycles());
        }
        if STATUS_WANTED.load(Ordering::Acquire) {
            STATUS_WANTED.store(false, Ordering::Relaxed);
            // The session asks for the next one when it has taken this one.
            let _ = self.queues.statuses.enqueue(self.ticker.status());
        }
        if period::has_begun() {
            self.late(period::PERIOD_CYCLES + period::cycles());
        }
    }

    fn sense(&mut self) -> Sense {
        let (amplifier_is_well, contact_closed) = inputs();
        Sense {
            amplifier_fault: !amplifier_is_well,
            monitor_v: self.adc.monitor_v(),
            arm_switch: self.arm_switch.update(contact_closed),
        }
    }

    #[cold]
    fn late(&mut self, cycles: u32) {
        self.output.zero();
        self.ticker.raise(Fault::Deadline, cycles);
    }
}
