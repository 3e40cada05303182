//! AD5761R: 16-bit bipolar DAC (Analog Devices data sheet, rev. C).

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::delay::DelayNs;
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
    /// The control register, status bits included.
    control: u16,
    input: u16,
    output: u16,
    /// The output is clamped to ground, from a reset until the first write to the control register.
    is_clamped: bool,
    /// The bytes that the chip shifts out with the next frame.
    shifting_out: [u8; 3],
    now_ns: u64,
    ready_at_ns: u64,
}

/// A DAC on a board.
#[derive(Clone, Debug)]
pub struct Ad5761rChip(Rc<RefCell<Chip>>);

/// The chip's SPI side: SCLK, SDI, SDO and SYNC.
#[derive(Debug)]
pub struct ChipSpi(Rc<RefCell<Chip>>);

/// A delay that advances the chip's virtual time.
#[derive(Debug)]
pub struct ChipDelay(Rc<RefCell<Chip>>);

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
            control: 0,
            input: 0,
            output: 0,
            is_clamped: true,
            shifting_out: [0; 3],
            now_ns: 0,
            ready_at_ns: 0,
        };
        chip.reset();
        Self(Rc::new(RefCell::new(chip)))
    }

    /// The bus for a driver.
    pub fn spi(&self) -> ChipSpi {
        ChipSpi(Rc::clone(&self.0))
    }

    /// A delay that advances the chip's virtual time.
    pub fn delay(&self) -> ChipDelay {
        ChipDelay(Rc::clone(&self.0))
    }

    /// Switches the supplies on or off. The chip starts with its registers after power-on.
    pub fn supply(&self, on: bool) {
        let mut chip = self.0.borrow_mut();
        chip.is_supplied = on;
        chip.reset();
    }

    /// Simulates a dip of the supply that the chip detects and that leaves its registers unchanged.
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

    /// Sets the level of CLEAR. Its falling edge sets the DAC register to the value that the control register selects.
    pub fn set_clear(&self, high: bool) {
        let mut chip = self.0.borrow_mut();
        if chip.clear_is_high && !high {
            let value = chip.control >> 9;
            chip.output = chip.scale_point(value);
        }
        chip.clear_is_high = high;
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

impl ErrorType for ChipSpi {
    type Error = Infallible;
}

impl SpiDevice for ChipSpi {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        let mut chip = self.0.borrow_mut();
        let mut received = Vec::new();
        let outgoing = if chip.is_supplied { chip.shifting_out } else { [0; 3] };
        let mut exchange = |chip: &mut Chip, byte: u8| {
            chip.now_ns += BYTE_NS;
            let answer = outgoing.get(received.len()).copied().unwrap_or_default();
            received.push(byte);
            if chip.has_sdo { answer } else { 0xff }
        };
        for operation in operations {
            match operation {
                Operation::Read(bytes) => bytes.iter_mut().for_each(|byte| *byte = exchange(&mut chip, 0)),
                Operation::Write(bytes) => bytes.iter().for_each(|byte| _ = exchange(&mut chip, *byte)),
                Operation::TransferInPlace(bytes) => {
                    bytes.iter_mut().for_each(|byte| *byte = exchange(&mut chip, *byte));
                }
                Operation::Transfer(read, write) => {
                    for index in 0..read.len().max(write.len()) {
                        let answer = exchange(&mut chip, write.get(index).copied().unwrap_or_default());
                        if let Some(byte) = read.get_mut(index) {
                            *byte = answer;
                        }
                    }
                }
                Operation::DelayNs(ns) => chip.now_ns += u64::from(*ns),
            }
        }
        // Only the last 24 bits count; a frame that is too short is ignored.
        let is_ready = chip.is_supplied && chip.now_ns >= chip.ready_at_ns;
        if let Some(frame) = received.last_chunk::<3>().filter(|_| is_ready) {
            chip.execute(*frame);
        }
        Ok(())
    }
}

impl DelayNs for ChipDelay {
    fn delay_ns(&mut self, ns: u32) {
        self.0.borrow_mut().now_ns += u64::from(ns);
    }
}
