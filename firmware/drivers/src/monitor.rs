//! The amplifier's monitor output, read by an ADC through a level shifter.

/// Conversion of ADC codes to volts at the amplifier's output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonitorScale {
    /// Code at 0 V.
    zero_code: f32,
    volts_per_code: f32,
}

impl MonitorScale {
    /// The scale of `docs/board/hardware.md`: 12 bits over 3.3 V. The amplifier's monitor gives 1 V per 100 V, which
    /// the level shifter converts to 0.75 V around 1.65 V, so that 220 V use the full range.
    pub const SHIFTED: Self = Self::new(12, 3.3, 0.75 / 100.0);

    /// An ADC of `bits` bits with the range 0 to `reference_v`. 0 V at the amplifier's output is the middle of the
    /// range, and each volt there changes the ADC's input by `input_v_per_v`.
    pub const fn new(bits: u32, reference_v: f32, input_v_per_v: f32) -> Self {
        let codes = (1_u32 << bits) as f32;
        Self { zero_code: 0.5 * codes, volts_per_code: reference_v / codes / input_v_per_v }
    }

    /// Volts at the amplifier's output.
    #[inline]
    pub fn volts(&self, code: u16) -> f32 {
        (f32::from(code) - self.zero_code) * self.volts_per_code
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_become_volts_about_the_middle_of_the_span() {
        // 3.3 V over 4,096 codes; 200 V move the input by 1.5 V.
        let monitor = MonitorScale::new(12, 3.3, 1.5 / 200.0);
        assert!(monitor.volts(2048).abs() < 1e-6);
        let code_of = |output_v: f32| ((1.65 + output_v * 1.5 / 200.0) / 3.3 * 4096.0) as u16;
        for output_v in [-200.0, -50.0, 1.0, 120.0, 200.0] {
            let found = monitor.volts(code_of(output_v));
            assert!((found - output_v).abs() < 0.12, "{found} is not {output_v}");
        }
    }
}
