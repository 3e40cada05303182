//! Computes coefficients from parameters when a scene is committed.

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
/// the tick rate, and may be negative.
#[cfg_attr(
    not(any(feature = "vibration", feature = "grating", feature = "rings")),
    allow(dead_code, reason = "only these change with time")
)]
pub(crate) fn steps_per_tick(frequency_hz: f32, tick_hz: u32) -> u32 {
    // Units of 2^-32 Hz are finer than any accepted frequency.
    let turns = (frequency_hz * (1u64 << 32) as f32) as i64;
    let half = if turns < 0 { -i64::from(tick_hz / 2) } else { i64::from(tick_hz / 2) };
    ((turns + half) / i64::from(tick_hz)) as u32
}

/// The refusal of a layer if the scene already has the largest number of layers of its kind.
pub(crate) fn no_room(field: ConfigField, max: usize, layer: u8) -> Refusal {
    let max = max as f32;
    Refusal::Config(ConfigRefusal { field, found: max + 1.0, min: 0.0, max, layer })
}
