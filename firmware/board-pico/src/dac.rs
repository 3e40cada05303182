//! The DAC, an AD5761R behind state machine 0 of PIO 0, which sends a frame of 24 bits at the same instant of every
//! period for which it was given one ([`crate::period`]), and stores the bits that the DAC shifts out meanwhile.
//! Without a frame there are no edges. Two halves take turns
//! ([`BusHandover`](frixel_drivers::bus_handover::BusHandover)):
//!
//! - [`Frames`], in the tick: one output frame a period;
//! - [`DacBus`], in the main loop: for the driver that configures the DAC and reads it back, a frame a period, too.
//!
//! SCLK is high between frames, and the DAC samples at falling edges: mode 2, at 6.25 MHz. SDO is also read at the
//! falling edges, 80 ns after the rising edges, which it follows by up to 40 ns.
//!
//! | pin | function | |
//! |---|---|---|
//! | GP2 | PIO0 | SYNC |
//! | GP3 | PIO0 | SCLK |
//! | GP4 | PIO0 | SDI |
//! | GP5 | PIO0 | SDO, to read back |

use frixel_board::hardware::{DacFrames, Late};
use frixel_cortex_m::Boot;
use frixel_drivers::ad5761r::{self, Ad5761r, BusError, Frame, FrameBus, FrameDevice};
use frixel_drivers::pio::{Condition, Destination, Instruction, PULL, PUSH};
use frixel_drivers::pio::{jump, set, shift_in, shift_out, wait_flag};
use frixel_wire::dac_code::DacCode;
use rp_pac::PIO0;

use crate::clock::CycleDelay;
use crate::period::{self, DEADLINE_CYCLES, Period};
use crate::pins::{self, Function};
use crate::pio::Machine;

pub(crate) const SYNC: usize = 2;
const SCLK: usize = 3;
const SDI: usize = 4;
const SDO: usize = 5;

const FRAMES: Machine = Machine { pio: PIO0, number: 0, address: 0 };
/// Cycles of the state machine from the flag that starts a frame until SYNC is high again, and 4 more.
pub(crate) const FRAME_CYCLES: u32 = 5 + 24 * 4 + 1 + 4;

// Levels of SYNC (1) and SCLK (2).
const IDLE: u16 = 0b11;
const SELECTED: u16 = 0b10;
const FALLEN: u16 = 0b00;

/// Program of the state machine. A word is a one, 24 bits, the most significant first, and seven unused bits. Without a
/// word, the machine takes register X, which is zero.
const PROGRAM: [Instruction; 10] = [
    set(Destination::X, 0).side(IDLE, 2),
    wait_flag(period::FRAME).side(IDLE, 2),
    PULL.side(IDLE, 2),
    shift_out(Destination::Y, 1).side(IDLE, 2),
    jump(Condition::YZero, 0).side(IDLE, 2),
    set(Destination::Y, 23).side(SELECTED, 2),
    shift_out(Destination::Pins, 1).delay(1).side(SELECTED, 2),
    shift_in(1).side(FALLEN, 2),
    jump(Condition::YNotZeroDecrement, 6).side(FALLEN, 2),
    PUSH.side(SELECTED, 2),
];

/// The driver of this board's DAC.
pub type Dac = Ad5761r<FrameDevice<DacBus>, CycleDelay>;

/// Starts the beat and the state machine, and returns the two halves and the period. The DAC is not configured yet.
pub fn start(_: &Boot) -> (Frames, Dac, Period) {
    let set_pins = |w: &mut rp_pac::pio::regs::SmPinctrl| {
        w.set_out_base(SDI as u8);
        w.set_out_count(1);
        w.set_in_base(SDO as u8);
        w.set_sideset_base(SYNC as u8);
        w.set_sideset_count(2);
        w.set_set_base(SYNC as u8);
        w.set_set_count(3);
    };
    // Left, the most significant bit first, both ways: zeros.
    FRAMES.load(&PROGRAM, set_pins, |_| ());
    FRAMES.execute(set(Destination::Pins, IDLE).side(IDLE, 2));
    FRAMES.execute(set(Destination::PinDirections, 0b111).side(IDLE, 2));
    FRAMES.execute(jump(Condition::Always, FRAMES.address as u16).side(IDLE, 2));
    for pin in [SYNC, SCLK, SDI, SDO] {
        pins::connect(pin, Function::Pio0);
    }
    let period = period::start(&FRAMES);
    (Frames(()), Ad5761r::new(FrameDevice(DacBus(())), CycleDelay {}), period)
}

/// Gives a frame to the machine.
#[inline]
fn transmit(frame: Frame) {
    let [first, second, third] = frame;
    FRAMES.transmit(1 << 31 | u32::from_be_bytes([0, first, second, third]) << 7);
}

/// The tick's half of the DAC.
pub struct Frames(());

impl DacFrames for Frames {
    #[inline]
    fn send(&mut self, code: DacCode) -> Result<(), Late> {
        if period::cycles() > DEADLINE_CYCLES || !FRAMES.has_taken_all() {
            return Err(Late);
        }
        transmit(ad5761r::output(code));
        Ok(())
    }
}

/// The main loop's half of the DAC. It polls, while the tick sends nothing.
pub struct DacBus(());

impl FrameBus for DacBus {
    /// Sends one frame in the next period, and waits for its end.
    fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), BusError> {
        /// Reads of a register, 20 ns or more each: ten periods of the slower board.
        const ROUNDS_MAX: u32 = 50_000;
        let frame: &mut Frame = bytes.try_into().map_err(|_| BusError::Unsupported)?;
        // Discard what was received during the tick's frames.
        while FRAMES.receive().is_some() {}
        transmit(*frame);
        let received = (0..ROUNDS_MAX).find_map(|_| FRAMES.receive()).ok_or(BusError::Timeout)?;
        let [_, first, second, third] = received.to_be_bytes();
        *frame = [first, second, third];
        Ok(())
    }
}
