//! Pins. The modules that use them and the table of `docs/board/hardware.md` state their functions; alternate functions
//! are those of DS12288, "Alternate functions".

use frixel_drivers::pin::{DirectPin, ReadLevel, SetLevel};
use stm32_metapac::RCC;
use stm32_metapac::gpio::Gpio;
use stm32_metapac::gpio::vals::{Moder, Ospeedr, Pupdr};

/// Time for a weak resistor to move a wire: 100 us.
const PULL_CYCLES: u32 = crate::clock::CORE_HZ / 10_000;

/// Enables the ports.
pub fn start() {
    RCC.ahb2enr().modify(|w| {
        w.set_gpioaen(true);
        w.set_gpioben(true);
        w.set_gpiocen(true);
        w.set_gpioden(true);
    });
    // A peripheral is accessible two clocks after its enable (RM0440, "Peripheral clock enable register"); the read
    // takes them.
    let _ = RCC.ahb2enr().read();
}

/// A pin that software reads or sets.
pub type Pin = DirectPin<Wire>;

/// A pin of a port, by its number.
pub struct Wire(Gpio, u32);

impl ReadLevel for Wire {
    #[inline]
    fn is_high(&self) -> bool {
        is_high(self.0, self.1)
    }
}

impl SetLevel for Wire {
    #[inline]
    fn set(&self, high: bool) {
        set(self.0, self.1, high);
    }
}

/// A pin that becomes an output when it is set, whatever its function was, without a glitch to the other level.
pub(crate) struct Forced(Wire);

impl SetLevel for Forced {
    fn set(&self, high: bool) {
        self.0.set(high);
        mode(self.0.0, self.0.1, Moder::OUTPUT);
    }
}

/// A pin that becomes an output when it is set.
pub(crate) fn forced(port: Gpio, pin: u32) -> DirectPin<Forced> {
    DirectPin(Forced(Wire(port, pin)))
}

/// The level of a pin that a peripheral uses.
#[cfg(feature = "optical-frame")]
pub(crate) fn reads(port: Gpio, pin: u32) -> Pin {
    DirectPin(Wire(port, pin))
}

/// Connects a pin to a peripheral.
pub fn alternate(port: Gpio, pin: u32, function: u8) {
    port.ospeedr().modify(|w| w.0 = field(w.0, 2, pin, Ospeedr::HIGH_SPEED as u32));
    port.afr(usize::from(pin >= 8)).modify(|w| w.0 = field(w.0, 4, pin % 8, u32::from(function)));
    mode(port, pin, Moder::ALTERNATE);
}

/// Connects a pin to a peripheral as open-drain output.
#[cfg_attr(not(feature = "optical-frame"), allow(dead_code, reason = "only the optical frame is on such a bus"))]
pub(crate) fn alternate_open_drain(port: Gpio, pin: u32, function: u8) {
    port.otyper().modify(|w| w.0 |= 1 << pin);
    alternate(port, pin, function);
}

/// Makes a pin an output that is low.
pub(crate) fn output_low(port: Gpio, pin: u32) -> Pin {
    set(port, pin, false);
    mode(port, pin, Moder::OUTPUT);
    DirectPin(Wire(port, pin))
}

/// Makes a pin an input that is pulled down: a disconnected wire reads as low.
pub(crate) fn input_pulled_down(port: Gpio, pin: u32) -> Pin {
    port.pupdr().modify(|w| w.0 = field(w.0, 2, pin, Pupdr::PULL_DOWN as u32));
    mode(port, pin, Moder::INPUT);
    DirectPin(Wire(port, pin))
}

/// The level of a pin that is an input, through the weak resistor to either side. It is then pulled by none.
pub fn levels_through_pulls(port: Gpio, pin: u32) -> [bool; 2] {
    mode(port, pin, Moder::INPUT);
    let levels = [Pupdr::PULL_UP, Pupdr::PULL_DOWN].map(|pull| {
        port.pupdr().modify(|w| w.0 = field(w.0, 2, pin, pull as u32));
        // 55 kOhm and 300 pF of a long wire: 17 us.
        cortex_m::asm::delay(PULL_CYCLES);
        is_high(port, pin)
    });
    port.pupdr().modify(|w| w.0 = field(w.0, 2, pin, Pupdr::FLOATING as u32));
    levels
}

/// Makes a pin analog, as it is at reset.
pub fn analog(port: Gpio, pin: u32) {
    mode(port, pin, Moder::ANALOG);
}

/// Whether a pin is high.
pub(crate) fn is_high(port: Gpio, pin: u32) -> bool {
    port.idr().read().0 & 1 << pin != 0
}

/// Sets an output high or low.
pub(crate) fn set(port: Gpio, pin: u32, high: bool) {
    // The lower half of the register sets pins, the upper half resets them.
    port.bsrr().write(|w| w.0 = 1 << if high { pin } else { pin + 16 });
}

fn mode(port: Gpio, pin: u32, mode: Moder) {
    port.moder().modify(|w| w.0 = field(w.0, 2, pin, mode as u32));
}

/// Returns `register` with `value` in field number `index`, where all fields have `bits` bits.
fn field(register: u32, bits: u32, index: u32, value: u32) -> u32 {
    let shift = bits * index;
    register & !(((1 << bits) - 1) << shift) | value << shift
}
