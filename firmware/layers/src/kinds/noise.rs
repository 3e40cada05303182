//! Band-limited noise: the mean of eight cosine waves over the screen, drawn from a seed.

use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};

use crate::context::Context;
use crate::cosine::cosine;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::noise_waves::{WAVES, Waves};
use crate::parameters::{parameters, range, within};
use crate::point::Point;
use crate::prepare::{Preparation, no_room};
use crate::region::ActiveRegion;
use crate::tables::NOISES_MAX;

/// Keeps the sum within its range, although a cosine may exceed 1 by a millionth.
const WITHIN: f32 = 1.0 - 1e-6;

parameters! {
    /// The mean of eight cosine waves over the screen, `low + (high - low) (1 + mean) / 2`; `PROTOCOL.md` defines the
    /// waves.
    pub struct Noise {
        /// Seed from which the waves are generated.
        seed: u32 = 52,
        /// Shortest wavelength, m.
        wavelength_min_m: f32 = 24 in range::WAVELENGTH_M,
        /// Longest wavelength, m.
        wavelength_max_m: f32 = 28 in range::WAVELENGTH_M,
        /// Least electric friction, N.
        low_n: f32 = 32 in range::FRICTION_N,
        /// Largest electric friction, N.
        high_n: f32 = 36 in range::FRICTION_N,
    }
}

impl Kind for Noise {
    type Coefficients = NoiseCoefficients;

    fn check_relations(&self, _points: &[Point], layer: u8) -> Result<(), ConfigRefusal> {
        let min_m = range::WAVELENGTH_M.min as f32;
        within(ConfigField::Wavelength, self.wavelength_min_m, min_m, self.wavelength_max_m, layer)
    }

    fn cost(&self) -> Cost {
        const { measured_cost("noise") }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.low_n, self.high_n])
    }

    fn table_bytes(&self) -> usize {
        size_of::<Waves>()
    }

    fn prepare(&self, layer: u8, preparation: &mut Preparation) -> Result<NoiseCoefficients, Refusal> {
        let waves = Waves::new(self.seed, self.wavelength_min_m, self.wavelength_max_m);
        let number = preparation.tables.add_noise(waves);
        let number = number.map_err(|_| no_room(ConfigField::NoiseLayers, NOISES_MAX, layer))?;
        Ok(NoiseCoefficients {
            waves: number,
            middle_n: 0.5 * (self.high_n + self.low_n),
            swing_n: 0.5 * (self.high_n - self.low_n) * (WITHIN / WAVES as f32),
        })
    }
}

/// `middle + swing` times the sum of the cosines of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NoiseCoefficients {
    /// Number of its waves in the scene's tables.
    waves: u8,
    middle_n: f32,
    swing_n: f32,
}

impl Evaluate for NoiseCoefficients {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        let [x_m, y_m] = context.inputs.place_m;
        let Some(Waves(waves)) = context.tables.noises().get(usize::from(self.waves)) else { return 0.0 };
        let mut sum = 0.0;
        for wave in waves {
            sum += cosine(x_m * wave.cycles_per_m_x + y_m * wave.cycles_per_m_y + wave.phase_turns);
        }
        self.middle_n + self.swing_n * sum
    }
}
