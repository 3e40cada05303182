//! Band-limited noise: a sum of waves that a seed says.

use super::{Around, direction};
use crate::turns;

/// Most layers of noise in a scene.
pub(crate) const NOISES_MAX: usize = if cfg!(feature = "noise") { 8 } else { 0 };
/// Waves that a layer of noise is made of.
const WAVES: usize = 8;
/// Keeps the sum within its range although a cosine may be a little larger than 1.
const WITHIN: f32 = 1.0 - 1e-6;

/// The waves of one layer, in the scene's table of noises.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Waves([Cosine; WAVES]);

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Cosine {
    cycles_per_m_x: f32,
    cycles_per_m_y: f32,
    phase_turns: f32,
}

/// `middle + swing` times the sum of cosines of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Noise {
    waves: u8,
    middle_n: f32,
    swing_n: f32,
}

impl Waves {
    /// Directions are spread over half a turn and wave numbers over the band, each in eight parts of which a wave has
    /// one: no seed leaves a part of them empty.
    pub(crate) fn new(seed: u32, wavelength_min_m: f32, wavelength_max_m: f32) -> Self {
        let (least, largest) = (1.0 / wavelength_max_m, 1.0 / wavelength_min_m);
        let mut waves = [Cosine::default(); WAVES];
        for (number, wave) in (0..).zip(&mut waves) {
            let (x, y) = direction((number as f32 + fraction(seed, number, 1)) / 16.0);
            let part = ((5 * number % 8) as f32 + fraction(seed, number, 2)) / 8.0;
            let cycles_per_m = least + (largest - least) * part;
            *wave = Cosine {
                cycles_per_m_x: cycles_per_m * x,
                cycles_per_m_y: cycles_per_m * y,
                phase_turns: fraction(seed, number, 3),
            };
        }
        Self(waves)
    }
}

impl Noise {
    pub(super) fn new(waves: u8, [low_n, high_n]: [f32; 2]) -> Self {
        Self { waves, middle_n: 0.5 * (high_n + low_n), swing_n: 0.5 * (high_n - low_n) * (WITHIN / WAVES as f32) }
    }

    #[inline(never)]
    pub(super) fn electric_friction_n(&self, around: &Around) -> f32 {
        let [x_m, y_m] = around.moment.place_m;
        let Some(Waves(waves)) = around.tables.noises().get(usize::from(self.waves)) else { return 0.0 };
        let mut sum = 0.0;
        for wave in waves {
            sum += turns::cosine(x_m * wave.cycles_per_m_x + y_m * wave.cycles_per_m_y + wave.phase_turns);
        }
        self.middle_n + self.swing_n * sum
    }
}

/// The fraction, from 0 to 1, that a seed has for a wave: `draw` is 1 to 3. The hash is "lowbias32" of C. Wellons'
/// hash-prospector.
fn fraction(seed: u32, wave: u32, draw: u32) -> f32 {
    let mut v = seed.wrapping_add(0x9e37_79b9_u32.wrapping_mul(3 * wave + draw));
    v ^= v >> 16;
    v = v.wrapping_mul(0x7feb_352d);
    v ^= v >> 15;
    v = v.wrapping_mul(0x846c_a68b);
    v ^= v >> 16;
    (v >> 8) as f32 / (1 << 24) as f32
}
