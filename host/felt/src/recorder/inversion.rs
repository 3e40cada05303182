//! Converts a commanded voltage to friction, without the errors of amplifier and finger.

use frixel_layers::Waveform;
use frixel_model::{FrictionLaw, ParameterError};
use frixel_wire::hello::BoardLimits;

use frixel_scene::Program;

/// The full model, driven through an ideal amplifier and a DAC with its steps.
#[derive(Debug)]
pub(super) struct Inversion {
    law: FrictionLaw,
    waveform: Waveform,
    codes_per_v_rms: f64,
    electric_friction_max_n: f64,
    /// The last amplitude, as a DAC code, and its friction, N, cached since many ticks share it.
    last: (f64, f64),
}

impl Inversion {
    pub(super) fn new(program: &Program, limits: &BoardLimits) -> Result<Self, ParameterError> {
        let header = &program.header;
        let peak_per_rms = f64::from(program.carrier.peak_per_rms());
        let codes_per_v_peak = f64::from(i16::MAX) / f64::from(limits.full_scale_v_peak);
        Ok(Self {
            law: program.mean_friction()?,
            waveform: header.waveform,
            codes_per_v_rms: peak_per_rms * codes_per_v_peak,
            electric_friction_max_n: program.reach.electric_friction_max_n,
            last: (f64::NAN, f64::NAN),
        })
    }

    /// Electric friction at a commanded voltage, including DAC steps, N.
    ///
    /// The code of a square wave is its amplitude. The code of a sine wave is only one of many samples, so its
    /// amplitude is rounded as the DAC would round it.
    pub(super) fn electric_friction_n(&mut self, voltage_v_rms: f32, dac_code: i16) -> f64 {
        let amplitude_code = match self.waveform {
            Waveform::Square => f64::from(dac_code).abs(),
            Waveform::Sine => (f64::from(voltage_v_rms) * self.codes_per_v_rms).round(),
        };
        if amplitude_code.to_bits() != self.last.0.to_bits() {
            self.last = (amplitude_code, self.law.electric_friction_n(amplitude_code / self.codes_per_v_rms));
        }
        self.last.1
    }

    /// Whether the drive can add this friction.
    pub(super) fn reaches(&self, electric_friction_n: f64) -> bool {
        (0.0..=self.electric_friction_max_n).contains(&electric_friction_n)
    }

    /// DAC codes of an rms voltage.
    #[cfg(test)]
    pub(super) fn code_of(&self, voltage_v_rms: f64) -> i16 {
        (voltage_v_rms * self.codes_per_v_rms).round() as i16
    }

    /// Electric friction at an rms voltage that is not rounded to DAC steps, N.
    #[cfg(test)]
    pub(super) fn without_steps_n(&self, voltage_v_rms: f64) -> f64 {
        self.law.electric_friction_n(voltage_v_rms)
    }
}
