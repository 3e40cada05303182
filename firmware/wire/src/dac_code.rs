//! Codes of the board's DAC.

use fixed::types::I1F15;

/// A bipolar DAC code, as a fraction of the board's full-scale voltage: `I1F15::MAX`, 32,767 steps, is full scale
/// (`full_scale_v_peak` of [`BoardLimits`](crate::hello::BoardLimits)), zero is 0 V.
///
/// ```
/// use frixel_wire::dac_code::DacCode;
///
/// assert_eq!(DacCode::from_bits(16_384).0.to_num::<f32>(), 0.5);
/// assert_eq!(DacCode::ZERO.bits(), 0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[repr(transparent)]
pub struct DacCode(pub I1F15);

impl DacCode {
    /// 0 V.
    pub const ZERO: Self = Self(I1F15::ZERO);
    /// The full-scale voltage.
    pub const MAX: Self = Self(I1F15::MAX);

    /// Creates a code from its number of steps, in two's complement.
    pub const fn from_bits(steps: i16) -> Self {
        Self(I1F15::from_bits(steps))
    }

    /// The number of steps, in two's complement: the value written to the DAC and sent over the wire.
    pub const fn bits(self) -> i16 {
        self.0.to_bits()
    }
}
