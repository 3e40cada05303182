//! What a board implements: its parts, each behind a small trait, and [`Hardware`], which names them.
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
//! The tick is an interrupt that nothing may delay, so what it uses never waits, never logs, and takes no critical
//! section that masks the tick.

use core::hint;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::spi::SpiDevice;
use embedded_io::{Read, ReadReady, Write, WriteReady};
use frixel_drivers::ad5761r::Ad5761r;
use frixel_drivers::amplifier::KickedEnable;
use frixel_wire::dac_code::DacCode;

/// The parts of a board. The type that implements it needs no value: it only names the parts.
pub trait Hardware: 'static {
    /// Ticks a second.
    const TICK_HZ: u32;
    /// Samples of the arm switch per second, from which its driver counts the time of debouncing.
    const SWITCH_HZ: u32 = Self::TICK_HZ;

    /// The timer of the tick.
    type Period: Period;
    /// The tick's half of the DAC.
    type Frames: DacFrames;
    /// The main loop's half of the DAC.
    type Dac: Dac;
    /// The enable of the amplifier. Where a wire can, disabling clears the DAC, too.
    type Enable: KickedEnable;
    /// The pin that is high while the amplifier is ready.
    type Ready: InputPin;
    /// The amplifier's monitor.
    type Monitor: Monitor;
    /// The pin that is high while the contact of the arm switch is closed.
    type Switch: InputPin;
    /// The light that shows the state.
    type Light: OutputPin;
    /// The serial port to the host. An error of it is not counted: bytes that are lost damage a frame, which is sent
    /// again, and a port that fails for good is a host that is gone.
    type Serial: Read + ReadReady + Write + WriteReady;
    /// The watchdog.
    type Watchdog: Watchdog;

    /// Called again and again while the main loop waits for the tick, some periods. A board does nothing here; a test
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

    /// Whether a period has begun since the last call; the call forgets it. The tick calls this first of all, which
    /// acknowledges its own interrupt, and last of all, which says whether it has ended in time.
    fn has_begun(&mut self) -> bool;
}

/// The tick's half of the DAC.
pub trait DacFrames {
    /// Begins to send a code, which the DAC puts out at the end of the period. If it is too late for that, or the
    /// previous frame is still under way, this sends nothing. It never waits.
    fn send(&mut self, code: DacCode) -> Result<(), Late>;
}

/// A frame that was not sent, because the DAC could not put it out at the end of the period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Late;

/// The main loop's half of the DAC. It may wait. The tick sends no frame meanwhile ([`crate::tick::TickShared::bus`]).
pub trait Dac {
    /// Configures the DAC, sets it to zero, and reads the configuration back. Returns the detail of fault `Dac` if it
    /// does not hold it.
    fn prepare(&mut self) -> Result<(), u32>;

    /// Reads the configuration back. Returns the detail of fault `Dac` if the DAC does not hold it any more.
    fn check(&mut self) -> Result<(), u32>;
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

/// The watchdog, which resets the processor unless it is fed. It runs.
pub trait Watchdog {
    /// Feeds it for another tenth of a second or so. The main loop calls this only after a new tick, so that either of
    /// the two resets the board by standing still.
    fn feed(&mut self);

    /// Sets whether the watchdog stops while a debugger halts the processor: only while the board is disarmed. Called
    /// with every new status, and before the board arms.
    fn let_debugger_stop_it(&mut self, may_stop: bool);
}

/// What a fault needs of the processor, in any state that it is found in.
pub trait Processor {
    /// Disables all interrupts until the reset.
    fn disable_interrupts(&self);

    /// Sets the output to zero until the reset: disables the amplifier, and then the DAC, in the order that
    /// [`zero_output`](frixel_drivers::ad5761r::zero_output) explains.
    fn zero_output_for_good(&self);

    /// Resets the processor.
    fn reset(&self) -> !;
}
