//! The waves of a layer of noise, in the scene's tables.

use crate::cosine::direction;

/// Number of waves in a layer of noise.
pub(crate) const WAVES: usize = 8;

/// The waves of one layer, in the scene's tables.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Waves(pub(crate) [PlaneWave; WAVES]);

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PlaneWave {
    pub(crate) cycles_per_m_x: f32,
    pub(crate) cycles_per_m_y: f32,
    pub(crate) phase_turns: f32,
}

impl Waves {
    /// Directions are spread over half a turn, and wave numbers over the band. Each range is divided into eight parts,
    /// one per wave, so that every seed covers all parts.
    pub(crate) fn new(seed: u32, wavelength_min_m: f32, wavelength_max_m: f32) -> Self {
        let (least, largest) = (1.0 / wavelength_max_m, 1.0 / wavelength_min_m);
        let mut waves = [PlaneWave::default(); WAVES];
        for (number, wave) in (0..).zip(&mut waves) {
            let (x, y) = direction((number as f32 + fraction(seed, number, 1)) / 16.0);
            let part = ((5 * number % 8) as f32 + fraction(seed, number, 2)) / 8.0;
            let cycles_per_m = least + (largest - least) * part;
            *wave = PlaneWave {
                cycles_per_m_x: cycles_per_m * x,
                cycles_per_m_y: cycles_per_m * y,
                phase_turns: fraction(seed, number, 3),
            };
        }
        Self(waves)
    }
}

/// The pseudo-random number, from 0 to 1, of a seed and a wave; `draw` is 1 to 3. The hash is "lowbias32" of C.
/// Wellons' hash-prospector.
fn fraction(seed: u32, wave: u32, draw: u32) -> f32 {
    let mut v = seed.wrapping_add(0x9e37_79b9_u32.wrapping_mul(3 * wave + draw));
    v ^= v >> 16;
    v = v.wrapping_mul(0x7feb_352d);
    v ^= v >> 15;
    v = v.wrapping_mul(0x846c_a68b);
    v ^= v >> 16;
    (v >> 8) as f32 / (1 << 24) as f32
}
