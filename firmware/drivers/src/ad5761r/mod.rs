//! AD5761R: a 16-bit bipolar DAC with an internal reference (Analog Devices data sheet, rev. C).
//!
//! [`Ad5761r`] configures and checks the chip over `embedded-hal`. A board that updates the output at a fixed rate
//! sends [`output`] frames by its own hardware; driver and tick take turns on the bus
//! ([`BusHandover`](crate::bus_handover::BusHandover)). [`zero_output`] is for panics, faults and the first
//! instructions after a reset.

mod bus;
mod frame;

use core::fmt;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use frixel_wire::dac_code::DacCode;

pub use bus::{BusError, FrameBus, FrameDevice};
pub use frame::{CONFIGURE, Control, FRAME_LEN, Frame, NO_OPERATION, READ_CONTROL, RESET, output};

/// Time for a software reset, in microseconds. The data sheet states none; 10 us is the longest of its other times.
const RESET_US: u32 = 10;

/// The DAC on an SPI bus in mode 2 (clock idle high, sampled at the falling edge), at most 50 MHz for writing, and 12
/// MHz for reading, because SDO follows an edge by up to 40 ns.
#[derive(Debug)]
pub struct Ad5761r<S, D> {
    spi: S,
    delay: D,
}

/// Why the DAC cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Error<E> {
    /// The bus failed.
    Spi(E),
    /// The control register differs from the written configuration: no DAC, no supply, or a broken wire.
    Configuration(Control),
    /// The supply dipped after the configuration was written.
    BrownOut(Control),
    /// The output was short-circuited after the configuration was written.
    ShortCircuit(Control),
}

/// [`Error::detail`] of a failed bus; no control register has this bit.
pub const DETAIL_SPI: u32 = 1 << 16;

impl<E> Error<E> {
    /// The detail of fault `Dac`: the control register that was read, or [`DETAIL_SPI`].
    pub fn detail(&self) -> u32 {
        match self {
            Self::Spi(_) => DETAIL_SPI,
            Self::Configuration(control) | Self::BrownOut(control) | Self::ShortCircuit(control) => {
                u32::from(control.0)
            }
        }
    }
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Spi(error) => write!(f, "the DAC's bus failed: {error:?}; check SCLK, SDI and SDO"),
            Self::Configuration(Control(found)) => write!(
                f,
                "the DAC's control register reads {found:#06x} instead of its configuration; \
                 check supply, SCLK, SDI, SDO and SYNC"
            ),
            Self::BrownOut(_) => f.write_str("the DAC's supply dips; check its supplies of +-15 V and 3.3 V"),
            Self::ShortCircuit(_) => {
                f.write_str("the DAC's output is short-circuited; check the wire to the amplifier")
            }
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}

impl<E> From<E> for Error<E> {
    fn from(error: E) -> Self {
        Self::Spi(error)
    }
}

/// Sets the output to zero from any state, even in the middle of a frame: for panics, faults, and as the first action
/// after every reset. Returns with CLEAR low.
///
/// The order of the edges matters. The amplifier is disabled first. Then SYNC rises: the DAC executes a complete frame,
/// or discards a truncated one, and further clocks have no effect. The falling edge of CLEAR comes last, because only
/// the edge sets the DAC to zero: a frame executed after it would output its code (data sheet, "Pin configuration and
/// function descriptions", not read). CLEAR is set high before, because it may already be low, as after a reset. The
/// times required between these edges were not read (data sheet, "Timing characteristics"); setting a pin takes 70 ns
/// or more at 170 MHz.
///
/// The pins' former functions must no longer drive them once they are set. A pin that reports an error is skipped; the
/// others are still set.
pub fn zero_output(enable: &mut impl OutputPin, sync: &mut impl OutputPin, clear: &mut impl OutputPin) {
    let _ = enable.set_low();
    let _ = sync.set_high();
    let _ = clear.set_high();
    let _ = clear.set_low();
}

impl<S: SpiDevice, D: DelayNs> Ad5761r<S, D> {
    /// Creates a driver for the DAC on `spi`. Sends nothing yet.
    pub const fn new(spi: S, delay: D) -> Self {
        Self { spi, delay }
    }

    /// Resets and configures the DAC, sets its output to 0 V, and reads the configuration back. On success the range
    /// is -10 V to 10 V and codes are two's complement.
    pub fn prepare(&mut self) -> Result<(), Error<S::Error>> {
        self.reset()?;
        self.configure()?;
        self.write(DacCode::ZERO)?;
        self.check()
    }

    /// Sets all registers to their values after power-on. The output is clamped to ground until [`Self::configure`].
    pub fn reset(&mut self) -> Result<(), Error<S::Error>> {
        self.spi.write(&RESET)?;
        self.delay.delay_us(RESET_US);
        Ok(())
    }

    /// Writes the control register, which also clears brown-out and short circuit.
    pub fn configure(&mut self) -> Result<(), Error<S::Error>> {
        Ok(self.spi.write(&CONFIGURE)?)
    }

    /// Sets the output: a code is a fraction of 10 V.
    pub fn write(&mut self, code: DacCode) -> Result<(), Error<S::Error>> {
        Ok(self.spi.write(&output(code))?)
    }

    /// Reads the control register, in two frames.
    pub fn read_control(&mut self) -> Result<Control, Error<S::Error>> {
        self.spi.write(&READ_CONTROL)?;
        let mut frame = NO_OPERATION;
        self.spi.transfer_in_place(&mut frame)?;
        Ok(Control::of_frame(frame))
    }

    /// Reads the control register and compares it with the configuration.
    pub fn check(&mut self) -> Result<(), Error<S::Error>> {
        let control = self.read_control()?;
        if !control.is_configured() {
            Err(Error::Configuration(control))
        } else if control.has_brown_out() {
            Err(Error::BrownOut(control))
        } else if control.has_short_circuit() {
            Err(Error::ShortCircuit(control))
        } else {
            Ok(())
        }
    }

    /// The bus and the delay.
    pub fn release(self) -> (S, D) {
        (self.spi, self.delay)
    }
}
