//! The interface of a board: its parts, each behind a small trait, and [`Hardware`], which names them.
//!
//! | part | trait | who uses it |
//! |---|---|---|
//! | timer of the tick | [`Period`] | tick |
//! | DAC, a frame a tick | [`DacFrames`] | tick |
//! | DAC, to configure and to read back | [`Dac`], which the driver [`Ad5761r`] implements | main loop |
//! | amplifier's enable behind its one-shot | [`KickedEnable`] | tick |
//! | amplifier's monitor | [`Monitor`] | tick |
//! | amplifier's ready line, arm switch | [`InputPin`] of `embedded-hal` | tick |
//! | state light | [`OutputPin`] of `embedded-hal` | main loop |
//! | serial port | [`Read`], [`Write`] and their readiness, of `embedded-io` | main loop |
//! | watchdog | [`Watchdog`] | main loop |
//! | processor | [`Processor`] | faults |
//!
//! The tick is an interrupt that must not be delayed, so its parts never wait, never log, and take no critical section
//! that masks the tick.

use core::hint;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::spi::SpiDevice;
use embedded_io::{Read, ReadReady, Write, WriteReady};
use frixel_drivers::ad5761r::Ad5761r;
use frixel_drivers::amplifier::KickedEnable;
use frixel_wire::dac_code::DacCode;

/// The parts of a board. The implementing type has no value; it only names the parts.
pub trait Hardware: 'static {
    /// Ticks a second.
    const TICK_HZ: u32;
    /// Samples of the arm switch per second, used by its driver to count the debounce time.
    const SWITCH_HZ: u32 = Self::TICK_HZ;

    /// The timer of the tick.
    type Period: Period;
    /// The tick's half of the DAC.
    type Frames: DacFrames;
    /// The main loop's half of the DAC.
    type Dac: Dac;
    /// The enable of the amplifier. Where the wiring allows it, disabling also clears the DAC.
    type Enable: KickedEnable;
    /// The pin that is high while the amplifier is ready.
    type Ready: InputPin;
    /// The amplifier's monitor.
    type Monitor: Monitor;
    /// The pin that is high while the contact of the arm switch is closed.
    type Switch: InputPin;
    /// The light that shows the state.
    type Light: OutputPin;
    /// The serial port to the host. Its errors are not counted: lost bytes damage a frame, which is resent, and a
    /// permanently failed port means that the host is gone.
    type Serial: Read + ReadReady + Write + WriteReady;
    /// The watchdog.
    type Watchdog: Watchdog;

    /// Called repeatedly while the main loop waits for the tick, for some periods. A board does nothing here; a test
    /// without interrupts runs the tick.
    fn wait_for_tick() {
        hint::spin_loop();
    }
}

/// The timer of the tick, whose interrupt runs [`Tick::run`](crate::tick::Tick::run) at the start of each period.
pub trait Period {
    /// Length of a period, in cycles of this timer.
    const PERIOD_CYCLES: u32;
    /// Cycles after which a tick is too late for the DAC.
    const DEADLINE_CYCLES: u32;

    /// Cycles since the current period began, less than [`Self::PERIOD_CYCLES`].
    fn cycles(&self) -> u32;

    /// Whether a period has begun since the last call, which this resets. The tick calls this first, to acknowledge its
    /// own interrupt, and last, to check whether it has ended in time.
    fn has_begun(&mut self) -> bool;
}

/// The tick's half of the DAC.
pub trait DacFrames {
    /// Begins to send a code, which the DAC outputs at the end of the period. Sends nothing if it is too late, or if
    /// the previous frame is still under way. It never waits.
    fn send(&mut self, code: DacCode) -> Result<(), Late>;
}

/// A frame that was not sent, because the DAC could not output it at the end of the period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Late;

/// The main loop's half of the DAC. It may wait. The tick sends no frames meanwhile ([`crate::tick::TickShared::bus`]).
pub trait Dac {
    /// Configures the DAC, sets it to zero, and reads the configuration back. Returns the detail of fault `Dac` if the
    /// configuration is wrong.
    fn prepare(&mut self) -> Result<(), u32>;

    /// Reads the configuration back. Returns the detail of fault `Dac` if the configuration is wrong.
    fn check(&mut self) -> Result<(), u32>;
}

/// No DAC: it passes every check.
impl Dac for () {
    fn prepare(&mut self) -> Result<(), u32> {
        Ok(())
    }

    fn check(&mut self) -> Result<(), u32> {
        Ok(())
    }
}

impl<S: SpiDevice, D: DelayNs> Dac for Ad5761r<S, D> {
    fn prepare(&mut self) -> Result<(), u32> {
        Self::prepare(self).map_err(|error| error.detail())
    }

    fn check(&mut self) -> Result<(), u32> {
        Self::check(self).map_err(|error| error.detail())
    }
}

/// The amplifier's monitor output behind an ADC.
pub trait Monitor {
    /// Volts at the amplifier's output, before the series resistor, as last converted: at the start of a tick, those of
    /// the tick before the last one (`Sense::monitor_v` of `frixel-control`). It never waits.
    fn monitor_v(&mut self) -> f32;
}

/// The running watchdog, which resets the processor unless it is fed.
pub trait Watchdog {
    /// Feeds it for about another tenth of a second. The main loop calls this only after a new tick, so that the board
    /// is reset if either of them stops.
    fn feed(&mut self);

    /// Sets whether the watchdog stops while a debugger halts the processor, which is allowed only while the board is
    /// disarmed. Called with every new status, and before the board arms.
    fn let_debugger_stop_it(&mut self, may_stop: bool);
}

/// The processor operations needed by a fault, available in any state.
pub trait Processor {
    /// Disables all interrupts until the reset.
    fn disable_interrupts(&self);

    /// Sets the output to zero until the reset: disables the amplifier, and then the DAC, in the order explained at
    /// [`zero_output`](frixel_drivers::ad5761r::zero_output).
    fn zero_output_for_good(&self);

    /// Resets the processor.
    fn reset(&self) -> !;
}
