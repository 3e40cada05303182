//! An ideal amplifier and its monitor.

use frixel_wire::dac_code::DacCode;

/// The voltage monitor of an ideal amplifier, as a board reads it: at the beginning of a tick it shows the output after
/// the code of the tick before the last one has been there for a whole tick.
#[derive(Clone, Copy, Debug)]
pub struct IdealMonitor {
    voltage_v: f32,
    /// The code that the DAC puts out until the end of this tick.
    latched_code: DacCode,
    volts_per_code: f32,
    /// Share of the distance to the driven voltage that the output covers in a tick.
    step: f32,
}

impl IdealMonitor {
    /// The monitor of an amplifier at 0 V, which follows a DAC whose largest code stands for `full_scale_v_peak` with a
    /// time constant in ticks, 0 for one that follows at once.
    #[must_use]
    pub fn new(full_scale_v_peak: f32, time_constant_ticks: f32) -> Self {
        Self {
            voltage_v: 0.0,
            latched_code: DacCode::ZERO,
            volts_per_code: full_scale_v_peak / f32::from(i16::MAX),
            step: 1.0 - libm::expf(-1.0 / time_constant_ticks),
        }
    }

    /// The voltage that the board reads, in V.
    #[must_use]
    pub fn voltage_v(&self) -> f32 {
        self.voltage_v
    }

    /// Advances one tick, at whose end the board latches this code.
    pub fn follow(&mut self, dac_code: DacCode) {
        self.voltage_v += self.step * (f32::from(self.latched_code.bits()) * self.volts_per_code - self.voltage_v);
        self.latched_code = dac_code;
    }
}
