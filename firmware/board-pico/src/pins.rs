//! Pins, by their GPIO number. The modules that use them and the table of `docs/board/hardware.md` state their
//! functions.

use frixel_drivers::pin::{DirectPin, ReadLevel, SetLevel};
use rp_pac::{IO_BANK0, PADS_BANK0, RESETS, SIO};

/// Driver of a pin (RP2040, 2.19.2, "Function Select").
#[derive(Clone, Copy)]
pub(crate) enum Function {
    Uart = 2,
    #[cfg(feature = "optical-frame")]
    I2c = 3,
    /// Software.
    Sio = 5,
    Pio0 = 6,
    Pio1 = 7,
    /// Nothing: the pin is analog.
    None = 31,
}

/// Pulls of a pad.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pull {
    None,
    Up,
    Down,
}

/// Enables the pins. This must not fail, because a panic calls it, too.
pub fn start() {
    /// Longest wait; a reset ends within some cycles.
    const ROUNDS_MAX: u32 = 1_000;
    RESETS.reset().modify(|w| {
        w.set_io_bank0(false);
        w.set_pads_bank0(false);
    });
    let _ = (0..ROUNDS_MAX).find(|_| {
        let done = RESETS.reset_done().read();
        done.io_bank0() && done.pads_bank0()
    });
}

/// A pin that software reads or sets.
pub type Pin = DirectPin<Gpio>;

/// A pin by its number.
pub struct Gpio(usize);

impl ReadLevel for Gpio {
    #[inline]
    fn is_high(&self) -> bool {
        SIO.gpio_in(0).read() & 1 << self.0 != 0
    }
}

impl SetLevel for Gpio {
    fn set(&self, high: bool) {
        set(self.0, high);
    }
}

/// A pin that becomes an output when it is set, whatever it was connected to before, without a pulse of the other
/// level.
pub(crate) struct Forced(usize);

impl SetLevel for Forced {
    fn set(&self, high: bool) {
        set(self.0, high);
        enable_output(self.0, true);
        connect(self.0, Function::Sio);
    }
}

/// A pin that becomes an output when it is set.
pub(crate) fn forced(pin: usize) -> DirectPin<Forced> {
    DirectPin(Forced(pin))
}

/// A pin that software drives low or releases.
#[cfg(feature = "optical-frame")]
pub(crate) struct OpenDrain(usize);

#[cfg(feature = "optical-frame")]
impl SetLevel for OpenDrain {
    fn set(&self, high: bool) {
        enable_output(self.0, !high);
    }
}

/// Takes a pin from its peripheral, released and pulled up.
#[cfg(feature = "optical-frame")]
pub(crate) fn released(pin: usize) -> DirectPin<OpenDrain> {
    enable_output(pin, false);
    set(pin, false);
    connect_pulled_up(pin, Function::Sio);
    DirectPin(OpenDrain(pin))
}

/// The level of a pin that a peripheral uses.
#[cfg(feature = "optical-frame")]
pub(crate) fn reads(pin: usize) -> Pin {
    DirectPin(Gpio(pin))
}

/// An output that is low.
pub(crate) fn output_low(pin: usize) -> Pin {
    set(pin, false);
    enable_output(pin, true);
    connect(pin, Function::Sio);
    DirectPin(Gpio(pin))
}

/// An input that is pulled down: a disconnected wire reads as low.
///
/// On the RP2350, the pull-down alone does not bring a pin down that was high (erratum RP2350-E9), so
/// `docs/board/hardware.md` requires a resistor.
pub(crate) fn input_pulled_down(pin: usize) -> Pin {
    enable_output(pin, false);
    configure(pin, Function::Sio, Pull::Down, true);
    DirectPin(Gpio(pin))
}

/// Connects a pin to a peripheral that drives it. Its level can still be read.
pub(crate) fn connect(pin: usize, function: Function) {
    configure(pin, function, Pull::None, true);
}

/// Connects an input, or a line that others drive low, to a peripheral, pulled up: a disconnected wire is idle.
pub(crate) fn connect_pulled_up(pin: usize, function: Function) {
    configure(pin, function, Pull::Up, true);
}

/// Makes a pin analog.
pub(crate) fn analog(pin: usize) {
    configure(pin, Function::None, Pull::None, false);
}

/// The pad comes last: on the RP2350 it holds its state until it is set to follow the function (RP2350, 9.7, "Isolation
/// latches").
fn configure(pin: usize, function: Function, pull: Pull, reads: bool) {
    IO_BANK0.gpio(pin).ctrl().write(|w| w.set_funcsel(function as u8));
    PADS_BANK0.gpio(pin).modify(|w| {
        w.set_pde(pull == Pull::Down);
        w.set_pue(pull == Pull::Up);
        w.set_ie(reads);
        w.set_od(false);
        #[cfg(feature = "rp2350")]
        w.set_iso(false);
    });
}

fn set(pin: usize, high: bool) {
    let output = SIO.gpio_out(0);
    if high { output.value_set().write_value(1 << pin) } else { output.value_clr().write_value(1 << pin) }
}

/// Sets whether software drives the pin.
fn enable_output(pin: usize, enabled: bool) {
    let output = SIO.gpio_oe(0);
    if enabled { output.value_set().write_value(1 << pin) } else { output.value_clr().write_value(1 << pin) }
}
