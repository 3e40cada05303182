//! The output enable: DAC clear and amplifier enable, held by a one-shot.
//!
//! State machine 0 of PIO 1 is the one-shot. A kick is a word with the levels of the two pins and their duration; the
//! pins go low by themselves [`LIFE_US`] after the last kick, even if the core has stopped. External resistors pull
//! both wires down, so that they are low in reset, too. That disables the amplifier; [`zero_for_good`], which `main`
//! calls first of all, clears a code that the DAC took meanwhile.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP6 | PIO1 | amplifier enable, high enables |
//! | GP7 | PIO1 | CLEAR of the DAC, low clears |

use frixel_cortex_m::Boot;
use frixel_drivers::ad5761r::zero_output;
use frixel_drivers::amplifier::KickedEnable;
use frixel_drivers::pio::{Condition, Destination, Instruction, PULL_BLOCKING, Source, copy, jump, set, shift_out};
use rp_pac::io::vals::Outover;
use rp_pac::{IO_BANK0, PIO1};

use crate::dac::SYNC;
use crate::pins::{self, Function, forced};
use crate::pio::{self, MACHINE_HZ, Machine};

/// Time from the last kick until the output is zero, in us. The specification is 1 ms.
pub const LIFE_US: u32 = 900;

const AMPLIFIER_ENABLE: usize = 6;
const DAC_CLEAR: usize = 7;

const ONE_SHOT: Machine = Machine { pio: PIO1, number: 0, address: 0 };
/// Cycles of a round in which the machine looks for a kick: three instructions, 1 us. A kick waits no longer.
const ROUND: u32 = 3 * 8;
/// Rounds that a kick lasts.
const ROUNDS: u32 = LIFE_US * (MACHINE_HZ / 1_000_000) / ROUND;

const PROGRAM: [Instruction; 7] = [
    // Idle, with both pins low, until there is a kick. When entered from a round, it does not wait.
    PULL_BLOCKING,
    // The pins of the kick, and its rounds.
    shift_out(Destination::Pins, 2),
    shift_out(Destination::X, 30),
    // A round: another kick goes before the count.
    copy(Destination::Y, Source::Status).delay(7),
    jump(Condition::YZero, 0).delay(7),
    jump(Condition::XNotZeroDecrement, 3).delay(7),
    // The end.
    set(Destination::Pins, 0),
];

/// The bits of both pins in a kick.
const BOTH: u32 = 0b11;

/// The one-shot.
pub struct Output(());

impl Output {
    /// Connects the pins to the one-shot, which holds them low. [`zero_for_good`] has set them low before.
    pub fn new(_: &Boot) -> Self {
        ONE_SHOT.load(
            &PROGRAM,
            |w| {
                w.set_out_base(AMPLIFIER_ENABLE as u8);
                w.set_out_count(2);
                w.set_set_base(AMPLIFIER_ENABLE as u8);
                w.set_set_count(2);
            },
            // To the right: the least significant bits first.
            |w| w.set_out_shiftdir(true),
        );
        ONE_SHOT.execute(set(Destination::Pins, 0));
        ONE_SHOT.execute(set(Destination::PinDirections, 0b11));
        ONE_SHOT.execute(jump(Condition::Always, ONE_SHOT.address as u16));
        pio::start(PIO1, 1 << ONE_SHOT.number);
        for pin in [AMPLIFIER_ENABLE, DAC_CLEAR] {
            pins::connect(pin, Function::Pio1);
        }
        override_enable(Outover::LOW);
        Self(())
    }
}

/// Connects the enable to the one-shot, or forces it low (RP2040, 2.19.6.1, `GPIO0_CTRL`).
#[inline]
fn override_enable(over: Outover) {
    // The function stays, so that no kick reconnects a pin that `zero_for_good` has disconnected.
    IO_BANK0.gpio(AMPLIFIER_ENABLE).ctrl().modify(|w| w.set_outover(over));
}

impl KickedEnable for Output {
    #[inline]
    fn kick(&mut self) {
        ONE_SHOT.transmit(BOTH | ROUNDS << 2);
        override_enable(Outover::NORMAL);
    }

    /// Pulls the enable low at once, until the next kick, even if the state machine has stopped. Both pins of the
    /// one-shot are low within 1.1 us, through a kick without pins and without rounds.
    #[inline]
    fn disable(&mut self) {
        override_enable(Outover::LOW);
        ONE_SHOT.transmit(0);
    }
}

/// Sets the output to zero until the next reset, from any context: disconnects amplifier enable, SYNC and CLEAR from
/// their state machines, in the order that [`zero_output`] explains.
pub fn zero_for_good() {
    pins::start();
    zero_output(&mut forced(AMPLIFIER_ENABLE), &mut forced(SYNC), &mut forced(DAC_CLEAR));
}
