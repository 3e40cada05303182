//! The parts of this board. [`crate::output`] and [`crate::inputs`] simulate DAC, amplifier and arm switch; this module
//! has placeholders for the parts that the emulated board lacks.

use frixel_board::hardware::{Hardware, Watchdog};
use frixel_drivers::pin::{DirectPin, SetLevel};
use frixel_exchange::BOARD;

use crate::inputs::{Monitor, Ready, Switch};
use crate::output::{Enable, Frames};
use crate::period::Period;
use crate::uart::Uart;

/// The parts of this board.
pub enum Mps2 {}

impl Hardware for Mps2 {
    const TICK_HZ: u32 = BOARD.tick_hz;
    /// So low that a single reading covers the debounce time. The simulated contact does not bounce, and a host may arm
    /// at any tick, because the simulated person is always ready.
    const SWITCH_HZ: u32 = 50;

    type Period = Period;
    type Frames = Frames;
    // The simulator takes codes.
    type Dac = ();
    type Enable = Enable;
    type Ready = DirectPin<Ready>;
    type Monitor = Monitor;
    type Switch = DirectPin<Switch>;
    type Light = DirectPin<NoLight>;
    type Serial = Uart;
    type Watchdog = NoWatchdog;
}

/// There is no light.
pub struct NoLight;

impl SetLevel for NoLight {
    fn set(&self, _: bool) {}
}

/// Placeholder for the watchdog: the simulator ends an emulator that hangs.
pub struct NoWatchdog;

impl Watchdog for NoWatchdog {
    fn feed(&mut self) {}

    fn let_debugger_stop_it(&mut self, _: bool) {}
}
