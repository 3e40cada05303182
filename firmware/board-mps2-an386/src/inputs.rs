//! The inputs of the tick: the amplifier's ready line, its monitor, and the arm switch.

use core::convert::Infallible;
use core::sync::atomic::{AtomicBool, Ordering};

use embedded_hal::digital::{ErrorType, InputPin};
use frixel_board::hardware;
use frixel_exchange::{BOARD, layout};
use frixel_testkit::IdealMonitor;

use crate::{fault_injection, output, shared};

/// Whether the simulated person holds the arm switch.
static SWITCH_IS_HELD: AtomicBool = AtomicBool::new(false);

/// Holds or releases the arm switch.
pub fn hold_switch(is_held: bool) {
    SWITCH_IS_HELD.store(is_held, Ordering::Relaxed);
}

/// The contact of the arm switch.
pub struct Switch;

impl ErrorType for Switch {
    type Error = Infallible;
}

impl InputPin for Switch {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(SWITCH_IS_HELD.load(Ordering::Relaxed))
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|is_high| !is_high)
    }
}

/// The amplifier's ready line, which the simulator may lower.
pub struct Ready;

impl ErrorType for Ready {
    type Error = Infallible;
}

impl InputPin for Ready {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(shared::get(layout::AMPLIFIER_FAULT) == 0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|is_high| !is_high)
    }
}

/// There is no amplifier: its monitor follows the driven voltage as the board's amplifier is specified to.
pub struct Monitor(IdealMonitor);

impl Monitor {
    /// The monitor of an output that is zero.
    pub fn new() -> Self {
        let time_constant_ticks = BOARD.amplifier.time_constant_s / BOARD.tick_period_s();
        Self(IdealMonitor::new(BOARD.limits.full_scale_v_peak, time_constant_ticks))
    }
}

impl hardware::Monitor for Monitor {
    fn monitor_v(&mut self) -> f32 {
        fault_injection::in_tick();
        self.0.follow(output::drive().dac_code);
        self.0.voltage_v()
    }
}
