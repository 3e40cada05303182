//! The parts of this board. [`crate::output`] and [`crate::inputs`] stand for DAC, amplifier and arm switch, as the
//! simulator sees them; these are the parts that the emulated board lacks.

use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, OutputPin};
use frixel_board::hardware::{Dac, Hardware, Watchdog};
use frixel_exchange::BOARD;

use crate::inputs::{Monitor, Ready, Switch};
use crate::output::{Enable, Frames};
use crate::period::Period;
use crate::uart::Uart;

/// The parts of this board.
pub enum Mps2 {}

impl Hardware for Mps2 {
    const TICK_HZ: u32 = BOARD.tick_hz;

    type Period = Period;
    type Frames = Frames;
    type Dac = NoDac;
    type Enable = Enable;
    type Ready = Ready;
    type Monitor = Monitor;
    type Switch = Switch;
    type Light = NoLight;
    type Serial = Uart;
    type Watchdog = NoWatchdog;
}

/// There is no DAC to configure: the simulator takes codes.
pub struct NoDac;

impl Dac for NoDac {
    fn prepare(&mut self) -> Result<(), u32> {
        Ok(())
    }

    fn check(&mut self) -> Result<(), u32> {
        Ok(())
    }
}

/// There is no light.
pub struct NoLight;

impl ErrorType for NoLight {
    type Error = Infallible;
}

impl OutputPin for NoLight {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// There is no watchdog: an emulator that hangs is ended by its simulator.
pub struct NoWatchdog;

impl Watchdog for NoWatchdog {
    fn feed(&mut self) {}

    fn let_debugger_stop_it(&mut self, _: bool) {}
}
