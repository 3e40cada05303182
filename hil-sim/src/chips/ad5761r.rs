//! AD5761R: 16-bit bipolar DAC (Analog Devices data sheet, rev. C).

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{self, OutputPin};
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};

/// Internal reference, in volts.
const REFERENCE_V: f64 = 2.5;
/// `M` and `C` of the transfer function `V = Vref (M D/2^16 - C)` for the ranges RA = 0 to 7 (data sheet, table 12).
const RANGES: [(f64, f64); 8] =
    [(8.0, 4.0), (4.0, 0.0), (4.0, 2.0), (2.0, 0.0), (4.0, 1.0), (2.4, 1.2), (6.4, 0.0), (8.0, 0.0)];
/// Nanoseconds of a byte on the bus, at 5.3 MHz.
const BYTE_NS: u64 = 1_500;
/// Nanoseconds after a software reset in which the chip ignores frames. Assumed: the data sheet gives no time.
const RESET_NS: u64 = 10_000;

/// Clocks per frame. If there are more, the last 24 count; with fewer, the chip ignores the frame.
const FRAME_CLOCKS: u32 = 24;
/// Nanoseconds in which software sets a pin: a few instructions at 16 MHz, the processor's clock after a reset.
const PIN_NS: u64 = 500;
/// Settling time of the output, in nanoseconds. The data sheet's first page states 7.5 us, typical, for selected
/// ranges; the table with the maximum is unread, so this is twice that.
const SETTLING_NS: u64 = 15_000;

const SHORT_CIRCUIT: u16 = 1 << 12;
const BROWN_OUT: u16 = 1 << 11;
const WRITABLE: u16 = 0x07ff;

#[derive(Debug)]
#[allow(clippy::struct_excessive_bools, reason = "each is a wire or a state of its own")]
struct Chip {
    is_supplied: bool,
    has_sdo: bool,
    is_shorted: bool,
    clear_is_high: bool,
    sync_is_high: bool,
    reset_is_high: bool,
    /// The last bits shifted in while SYNC was low, and their number.
    shifted_in: u32,
    clocks: u32,
    /// The control register, including status bits.
    control: u16,
    input: u16,
    output: u16,
    /// Whether the output is clamped to ground, from a reset until the first write to the control register.
    is_clamped: bool,
    /// The bytes that the chip shifts out with the next frame.
    shifting_out: [u8; 3],
    now_ns: u64,
    ready_at_ns: u64,
    /// Time at which the output last began to change.
    changed_at_ns: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Input {
    Sync,
    Clear,
    Reset,
}

/// A DAC on a board. All clones are the same chip.
///
/// To a driver it is a device on an SPI bus, and a delay that advances the chip's virtual time.
#[derive(Clone, Debug)]
pub struct Ad5761rChip(Rc<RefCell<Chip>>);

/// An input of the chip, as a pin that software sets.
#[derive(Debug)]
pub struct ChipPin {
    chip: Rc<RefCell<Chip>>,
    input: Input,
}

impl Ad5761rChip {
    /// A chip with its supplies on and CLEAR high.
    #[must_use]
    #[allow(clippy::new_without_default, reason = "a chip is a thing, not a value")]
    pub fn new() -> Self {
        let mut chip = Chip {
            is_supplied: true,
            has_sdo: true,
            is_shorted: false,
            clear_is_high: true,
            sync_is_high: true,
            reset_is_high: true,
            shifted_in: 0,
            clocks: 0,
            control: 0,
            input: 0,
            output: 0,
            is_clamped: true,
            shifting_out: [0; 3],
            now_ns: 0,
            ready_at_ns: 0,
            changed_at_ns: 0,
        };
        chip.reset();
        Self(Rc::new(RefCell::new(chip)))
    }

    /// SYNC, as a pin set by software. Each change advances the chip's virtual time.
    pub fn sync_pin(&self) -> ChipPin {
        ChipPin { chip: Rc::clone(&self.0), input: Input::Sync }
    }

    /// CLEAR, as a pin set by software.
    pub fn clear_pin(&self) -> ChipPin {
        ChipPin { chip: Rc::clone(&self.0), input: Input::Clear }
    }

    /// Switches the supplies on or off. The chip starts with its registers after power-on.
    pub fn supply(&self, on: bool) {
        let mut chip = self.0.borrow_mut();
        chip.is_supplied = on;
        chip.reset();
    }

    /// Simulates a supply dip that the chip detects and that leaves its registers unchanged.
    pub fn brown_out(&self) {
        self.0.borrow_mut().control |= BROWN_OUT;
    }

    /// Shorts the output to ground, or removes the short.
    pub fn short_circuit(&self, shorted: bool) {
        self.0.borrow_mut().is_shorted = shorted;
    }

    /// Connects or disconnects SDO.
    pub fn connect_sdo(&self, connected: bool) {
        self.0.borrow_mut().has_sdo = connected;
    }

    /// Sets the level of CLEAR. Only its falling edge sets the DAC register to the value selected by the control
    /// register.
    pub fn set_clear(&self, high: bool) {
        self.0.borrow_mut().set(Input::Clear, high);
    }

    /// Sets the level of SYNC. Its rising edge executes the frame.
    pub fn set_sync(&self, high: bool) {
        self.0.borrow_mut().set(Input::Sync, high);
    }

    /// Sets the level of RESET. While it is low, the registers have their power-on values and the output is clamped to
    /// ground, regardless of the other inputs.
    pub fn set_reset(&self, high: bool) {
        self.0.borrow_mut().set(Input::Reset, high);
    }

    /// A falling edge of SCLK, at which the chip samples `bit` from SDI.
    pub fn clock(&self, bit: bool) {
        let _ = self.0.borrow_mut().clock(bit);
    }

    /// The levels of SDO during the next frame, 24 bits, most significant first. They change when a frame ends.
    #[must_use]
    pub fn shifting_out(&self) -> u32 {
        let chip = self.0.borrow();
        let [first, second, third] = chip.shifting_out;
        match (chip.has_sdo, chip.is_supplied) {
            (false, _) => 0xff_ffff,
            (true, false) => 0,
            (true, true) => u32::from_be_bytes([0, first, second, third]),
        }
    }

    /// The chip's virtual time, in nanoseconds.
    #[must_use]
    pub fn now_ns(&self) -> u64 {
        self.0.borrow().now_ns
    }

    /// Time at which the output has settled after its last change, in nanoseconds of the chip's virtual time.
    #[must_use]
    pub fn settled_at_ns(&self) -> u64 {
        self.0.borrow().changed_at_ns + SETTLING_NS
    }

    /// Volts on the output.
    #[must_use]
    pub fn output_v(&self) -> f64 {
        self.0.borrow().output_v()
    }
}

impl Chip {
    /// The registers after power-on and after a full reset.
    fn reset(&mut self) {
        self.control = 0;
        self.input = 0;
        self.output = 0;
        self.is_clamped = true;
        self.shifting_out = [0; 3];
        self.ready_at_ns = self.now_ns + RESET_NS;
    }

    fn is_twos_complement(&self) -> bool {
        // B2C acts on the bipolar ranges only.
        self.control & 1 << 7 != 0 && matches!(self.control & 7, 0 | 2 | 5)
    }

    /// Encodes a straight-binary code in the format that the DAC register uses.
    fn coded(&self, straight: u16) -> u16 {
        if self.is_twos_complement() { straight ^ 0x8000 } else { straight }
    }

    /// The code of a two-bit field such as CV or PV: zero scale, midscale or full scale.
    fn scale_point(&self, field: u16) -> u16 {
        self.coded(match field & 3 {
            0 => 0,
            1 => 0x8000,
            _ => 0xffff,
        })
    }

    fn output_v(&self) -> f64 {
        let has_reference = self.control & 1 << 5 != 0;
        if !self.is_supplied || self.is_clamped || self.is_shorted || !has_reference {
            return 0.0;
        }
        let (m, c) = RANGES.get(usize::from(self.control & 7)).copied().unwrap_or_default();
        REFERENCE_V * (m * f64::from(self.coded(self.output)) / 65_536.0 - c)
    }

    /// Sets an input and notes when the output changes.
    fn set(&mut self, input: Input, high: bool) {
        let before_v = self.output_v();
        match input {
            Input::Sync => self.set_sync(high),
            Input::Clear => self.set_clear(high),
            Input::Reset => {
                self.reset_is_high = high;
                self.reset();
            }
        }
        if (self.output_v() - before_v).abs() > 0.0 {
            self.changed_at_ns = self.now_ns;
        }
    }

    fn set_clear(&mut self, high: bool) {
        if self.clear_is_high && !high {
            self.output = self.scale_point(self.control >> 9);
        }
        self.clear_is_high = high;
    }

    fn set_sync(&mut self, high: bool) {
        if self.sync_is_high && !high {
            self.clocks = 0;
        } else if !self.sync_is_high && high && self.clocks >= FRAME_CLOCKS {
            let [_, frame @ ..] = self.shifted_in.to_be_bytes();
            if self.is_supplied && self.reset_is_high && self.now_ns >= self.ready_at_ns {
                self.execute(frame);
            }
        }
        self.sync_is_high = high;
    }

    /// Shifts a bit in, and returns the bit on SDO. Does nothing while SYNC is high.
    fn clock(&mut self, bit: bool) -> bool {
        if self.sync_is_high {
            return true;
        }
        let [first, second, third] = self.shifting_out;
        let outgoing = u32::from_be_bytes([0, first, second, third]);
        let level = self.clocks < FRAME_CLOCKS && outgoing >> (FRAME_CLOCKS - 1 - self.clocks) & 1 != 0;
        self.shifted_in = self.shifted_in << 1 | u32::from(bit);
        self.clocks += 1;
        !self.has_sdo || self.is_supplied && level
    }

    /// Shifts a byte in, and returns the byte on SDO.
    fn exchange(&mut self, byte: u8) -> u8 {
        self.now_ns += BYTE_NS;
        (0..8).rev().fold(0, |received, place| received << 1 | u8::from(self.clock(byte >> place & 1 != 0)))
    }

    /// Executes a frame at the rising edge of SYNC.
    fn execute(&mut self, frame: [u8; 3]) {
        let [address, high, low] = frame;
        let data = u16::from_be_bytes([high, low]);
        let mut read_back = None;
        match address & 0xf {
            0x1 => self.input = data,
            0x2 => self.output = self.input,
            0x3 => (self.input, self.output) = (data, data),
            0x4 => {
                self.control = data & WRITABLE;
                if self.is_clamped {
                    self.is_clamped = false;
                    self.output = self.scale_point(self.control >> 3);
                }
            }
            0x7 => self.output = self.scale_point(self.control >> 3),
            0xa => read_back = Some(self.input),
            0xb => read_back = Some(self.output),
            0xc => {
                if self.is_shorted {
                    self.control |= SHORT_CIRCUIT;
                }
                read_back = Some(self.control);
            }
            0xf => self.reset(),
            _ => {}
        }
        // Without a read-back, SDO repeats the frame for the next chip in the chain.
        let [high, low] = read_back.unwrap_or(data).to_be_bytes();
        self.shifting_out = [address, high, low];
    }
}

impl ErrorType for Ad5761rChip {
    type Error = Infallible;
}

impl SpiDevice for Ad5761rChip {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let mut chip = self.0.borrow_mut();
        chip.set(Input::Sync, false);
        for operation in operations {
            match operation {
                Operation::Read(bytes) => bytes.iter_mut().for_each(|byte| *byte = chip.exchange(0)),
                Operation::Write(bytes) => bytes.iter().for_each(|byte| _ = chip.exchange(*byte)),
                Operation::TransferInPlace(bytes) => bytes.iter_mut().for_each(|byte| *byte = chip.exchange(*byte)),
                Operation::Transfer(read, write) => {
                    for index in 0..read.len().max(write.len()) {
                        let answer = chip.exchange(write.get(index).copied().unwrap_or_default());
                        if let Some(byte) = read.get_mut(index) {
                            *byte = answer;
                        }
                    }
                }
                Operation::DelayNs(ns) => chip.now_ns += u64::from(*ns),
            }
        }
        chip.set(Input::Sync, true);
        Ok(())
    }
}

impl digital::ErrorType for ChipPin {
    type Error = Infallible;
}

impl OutputPin for ChipPin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.set(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.set(true);
        Ok(())
    }
}

impl ChipPin {
    fn set(&mut self, high: bool) {
        let mut chip = self.chip.borrow_mut();
        chip.now_ns += PIN_NS;
        chip.set(self.input, high);
    }
}

impl DelayNs for Ad5761rChip {
    fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().now_ns += u64::from(ns);
    }
}
