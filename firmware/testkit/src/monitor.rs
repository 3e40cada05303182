//! An ideal amplifier and its monitor.

use frixel_wire::dac_code::DacCode;
use frixel_wire::hello::BoardLimits;

/// The voltage monitor of an ideal amplifier, which follows the DAC code with the time constant in the board's limits.
#[derive(Clone, Copy, Debug)]
pub struct IdealMonitor {
    voltage_v: f32,
    volts_per_code: f32,
    /// Share of the distance to the driven voltage that the electrode covers in a tick.
    step: f32,
}

impl IdealMonitor {
    /// The monitor of a board at 0 V that ticks `tick_hz` times a second.
    #[must_use]
    pub fn new(limits: &BoardLimits, tick_hz: u32) -> Self {
        let tick_period_s = 1.0 / tick_hz as f32;
        Self {
            voltage_v: 0.0,
            volts_per_code: limits.full_scale_v_peak / f32::from(i16::MAX),
            step: 1.0 - libm::expf(-tick_period_s / limits.edge_time_constant_s),
        }
    }

    /// The voltage on the electrode, in V.
    #[must_use]
    pub fn voltage_v(&self) -> f32 {
        self.voltage_v
    }

    /// Advances one tick, with this DAC code put out at its start.
    pub fn follow(&mut self, dac_code: DacCode) {
        self.voltage_v += self.step * (f32::from(dac_code.bits()) * self.volts_per_code - self.voltage_v);
    }
}
