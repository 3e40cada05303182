//! The inputs of the tick: the amplifier's ready line, its monitor, and the arm switch. The simulator may break each.

use core::sync::atomic::{AtomicBool, Ordering};

use frixel_board::hardware;
use frixel_drivers::pin::ReadLevel;
use frixel_exchange::{BOARD, layout};
use frixel_testkit::IdealMonitor;
use frixel_wire::dac_code::DacCode;

use crate::{fault_injection, output, shared};

/// Whether the simulated person holds the arm switch.
static SWITCH_IS_HELD: AtomicBool = AtomicBool::new(false);

/// Holds or releases the arm switch.
pub fn hold_switch(is_held: bool) {
    SWITCH_IS_HELD.store(is_held, Ordering::Relaxed);
}

/// The contact of the arm switch.
pub struct Switch;

impl ReadLevel for Switch {
    fn is_high(&self) -> bool {
        match shared::get(layout::ARM_SWITCH) {
            layout::SWITCH_OPEN => false,
            layout::SWITCH_WELDED => true,
            _ => SWITCH_IS_HELD.load(Ordering::Relaxed),
        }
    }
}

/// The amplifier's ready line, which the simulator may lower.
pub struct Ready;

impl ReadLevel for Ready {
    fn is_high(&self) -> bool {
        shared::get(layout::AMPLIFIER_FAULT) == 0
    }
}

/// Simulated monitor. It follows the driven voltage as the board's amplifier is specified to.
pub struct Monitor {
    ideal: IdealMonitor,
    /// Ticks since the amplifier was disabled.
    disabled_ticks: u32,
}

impl Monitor {
    /// The monitor of an output that is zero.
    pub fn new() -> Self {
        let time_constant_ticks = BOARD.amplifier.time_constant_s / BOARD.tick_period_s();
        Self { ideal: IdealMonitor::new(BOARD.limits.full_scale_v_peak, time_constant_ticks), disabled_ticks: 0 }
    }
}

impl hardware::Monitor for Monitor {
    fn monitor_v(&mut self) -> f32 {
        fault_injection::in_tick();
        let drive = output::drive();
        self.disabled_ticks = if drive.amplifier_enable { 0 } else { self.disabled_ticks.saturating_add(1) };
        if drive.amplifier_enable || self.disabled_ticks > shared::get(layout::OFF_DELAY_TICKS) {
            let held = shared::get(layout::DAC_HELD);
            let is_held = drive.amplifier_enable && held & layout::DAC_STUCK != 0;
            self.ideal.follow(if is_held { DacCode::from_bits(held as i16) } else { drive.dac_code });
        }
        self.ideal.voltage_v() * (1.0 - f32::from_bits(shared::get(layout::MONITOR_LOSS)))
    }
}
