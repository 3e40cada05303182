//! The period of the tick. A state machine of PIO 0 is the beat: it divides its clock into periods, raises the tick's
//! interrupt at the start of each, and at the same instant of each lets another one send the DAC's frame
//! ([`crate::dac`]). State machines alone thus set the instant at which the DAC outputs a code, without software.
//!
//! PWM 0, which drives no pin, counts the cycles of the core in a period. It starts with the beat, both count the same
//! clock, and neither stops for a debugger, so they stay together.

use frixel_board::hardware;
use frixel_drivers::pio::{Condition, Destination, Instruction, PULL, Source, copy, jump, set, set_flag};
use rp_pac::{PIO0, PWM};

use crate::chip::TICK_HZ;
use crate::clock::CORE_HZ;
use crate::pio::{self, CORE_CYCLES, MACHINE_HZ, Machine};

/// Length of a period, in cycles of the core.
pub const PERIOD_CYCLES: u32 = CORE_HZ / TICK_HZ;
/// Latest cycle of the core at which a frame may be given to the state machine: 1 us before it looks for one. That
/// covers the few cycles by which the counter starts after the beat.
pub const DEADLINE_CYCLES: u32 = (LEAD + WAIT) * CORE_CYCLES - CORE_HZ / 1_000_000;

/// Cycles of a state machine in a period.
const PERIOD: u32 = MACHINE_HZ / TICK_HZ;
/// Cycles before the wait: raise the interrupt, load the counter.
const LEAD: u32 = 2;
/// Cycles from the flag that starts the frame to the end of the period, in which the frame is sent.
const TAIL: u32 = 1 + TAIL_SPARE + 1 + 32 * TAIL_ROUNDS;
const TAIL_ROUNDS: u32 = 4;
/// Cycles that remain when the wait is divided into rounds of eight cycles.
const TAIL_SPARE: u32 = (PERIOD - LEAD - 2 - 32 * TAIL_ROUNDS) % 8;
/// Cycles of the wait.
const WAIT: u32 = PERIOD - LEAD - TAIL;

/// Flag set at the start of a period; raises the PIO's interrupt.
const BEGUN: u16 = 0;
/// Flag at which the frame starts.
pub(crate) const FRAME: u16 = 4;
const COUNTER: usize = 0;

const BEAT: Machine = Machine { pio: PIO0, number: 1, address: 16 };
const PROGRAM: [Instruction; 6] = [
    set_flag(BEGUN),
    copy(Destination::X, Source::OutputShift),
    jump(Condition::XNotZeroDecrement, 18).delay(7),
    set_flag(FRAME).delay(TAIL_SPARE as u16),
    set(Destination::X, TAIL_ROUNDS as u16 - 1),
    jump(Condition::XNotZeroDecrement, 21).delay(31),
];

const _: () = {
    assert!(CORE_HZ.is_multiple_of(TICK_HZ) && MACHINE_HZ.is_multiple_of(TICK_HZ) && PERIOD_CYCLES <= 1 << 16);
    assert!(WAIT.is_multiple_of(8) && LEAD + WAIT + TAIL == PERIOD);
    // A frame ends in the period in which it starts.
    assert!(TAIL > crate::dac::FRAME_CYCLES);
};

/// The timer of the tick.
pub struct Period(());

impl hardware::Period for Period {
    const PERIOD_CYCLES: u32 = PERIOD_CYCLES;
    const DEADLINE_CYCLES: u32 = DEADLINE_CYCLES;

    #[inline]
    fn cycles(&self) -> u32 {
        cycles()
    }

    #[inline]
    fn has_begun(&mut self) -> bool {
        let has_begun = PIO0.irq().read().irq() & 1 << BEGUN != 0;
        if has_begun {
            // Ones clear flags.
            PIO0.irq().write(|w| w.set_irq(1 << BEGUN));
        }
        has_begun
    }
}

/// Cycles of the core since the period began.
#[inline]
pub(crate) fn cycles() -> u32 {
    u32::from(PWM.ch(COUNTER).ctr().read().ctr())
}

/// Starts the beat, the frames and the counter, without interrupts. The frames' machine is loaded already.
pub(crate) fn start(frames: &Machine) -> Period {
    BEAT.load(&PROGRAM, |_| (), |_| ());
    // The rounds of the wait: the output shift register keeps them.
    BEAT.transmit(WAIT / 8 - 1);
    BEAT.execute(PULL);
    BEAT.execute(jump(Condition::Always, BEAT.address as u16));
    let counter = PWM.ch(COUNTER);
    counter.csr().write(|_| ());
    counter.div().write(|w| w.set_int(1));
    counter.top().write(|w| w.set_top((PERIOD_CYCLES - 1) as u16));
    counter.ctr().write(|w| w.set_ctr(0));
    pio::start(PIO0, 1 << BEAT.number | 1 << frames.number);
    counter.csr().write(|w| w.set_en(true));
    Period(())
}

/// Enables the interrupt at the start of every period, from the next one on.
pub(crate) fn start_interrupts() {
    PIO0.irq().write(|w| w.set_irq(1 << BEGUN));
    // The flag of the same number as machine 0.
    PIO0.irqs(0).inte().write(|w| w.set_sm0(true));
}
