//! Computes coefficients from parameters when a scene is committed.

use core::num::NonZeroU32;

use frixel_model::divide_wide;
use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};

use crate::bitmap_pool::StoredBitmap;
use crate::tables::Tables;

/// Inputs and outputs of computing a layer's coefficients, besides its parameters.
pub(crate) struct Preparation<'a> {
    /// Ticks a second.
    pub(crate) tick_hz: u32,
    #[cfg_attr(not(feature = "bitmap"), allow(dead_code, reason = "only bitmaps lie in the pool"))]
    /// Finds a bitmap in the pool by its CRC-32.
    pub(crate) find_bitmap: &'a dyn Fn(u32) -> Option<StoredBitmap>,
    /// The scene's tables, which layers add to.
    pub(crate) tables: &'a mut Tables,
}

/// The number of ticks nearest to a time of at least 0 s.
pub fn ticks(time_s: f32, tick_hz: u32) -> u32 {
    (time_s * tick_hz as f32 + 0.5) as u32
}

/// Phase increment of a frequency per tick, in steps of 2^-32 turns, modulo a turn. The frequency is less than half of
/// the tick rate, and may be negative. Zero without a tick rate, and for NaN.
#[cfg_attr(
    not(any(feature = "vibration", feature = "grating", feature = "rings")),
    allow(dead_code, reason = "only these change with time")
)]
pub(crate) fn steps_per_tick(frequency_hz: f32, tick_hz: u32) -> u32 {
    let Some(divisor) = NonZeroU32::new(tick_hz) else { return 0 };
    let whole_hz = frequency_hz.abs() as u32;
    // Units of 2^-32 Hz are finer than the spacing of `f32` at 0.01 Hz, the lowest frequency of a vibration.
    let fraction = ((frequency_hz.abs() - whole_hz as f32) * (1u64 << 32) as f32) as u32;
    let (steps, remainder) = divide_wide(whole_hz, fraction, divisor);
    let steps = steps as u32 + u32::from(remainder >= tick_hz - tick_hz / 2);
    if frequency_hz < 0.0 { steps.wrapping_neg() } else { steps }
}

/// The refusal of a layer if the scene already has the largest number of layers of its kind.
pub(crate) fn no_room(field: ConfigField, max: usize, layer: u8) -> Refusal {
    let max = max as f32;
    Refusal::Config(ConfigRefusal { field, found: max + 1.0, min: 0.0, max, layer })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::steps_per_tick;

    proptest! {
        #[test]
        fn a_frequency_moves_the_nearest_number_of_steps(
            frequency_hz in prop_oneof![-20_000.0..20_000.0_f32, -1.0..1.0_f32],
            tick_hz in 8_000..100_000_u32,
        ) {
            let exact = f64::from(frequency_hz) * (1_u64 << 32) as f64 / f64::from(tick_hz);
            let found = steps_per_tick(frequency_hz, tick_hz) as i32;
            // A frequency above half the tick rate wraps.
            prop_assume!(exact.abs() < f64::from(i32::MAX));
            prop_assert!((f64::from(found) - exact).abs() <= 0.5 + 1e-6, "{found} {exact}");
        }
    }
}
