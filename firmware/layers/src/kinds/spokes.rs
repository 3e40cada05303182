//! Spokes around a centre: a wave over the angle `a`, which fades towards the centre.

use frixel_wire::message::Refusal;

use crate::angle::angle_turns;
use crate::context::Context;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::parameters::{parameters, range};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::ActiveRegion;
use crate::wave::{CentredWave, Wave};

/// Width in m below which spokes fade: fingers cannot resolve them, and the angle is undefined in the centre.
const NARROW_M: f32 = 1e-3;

parameters! {
    /// Spokes: `mean + f (trough + (crest - trough) w(n a + phase) - mean)` at the angle `a` around the centre, in
    /// turns, with `w` between 0 and 1, a period of one turn, and `mean` halfway between trough and crest. `f` is 1
    /// where a spoke is at least 1 mm wide; closer to the centre, it is the square of the width in mm.
    pub struct Spokes {
        /// Shape of the spokes, from x towards y.
        wave: Wave = 44,
        /// x of the centre, m.
        x_m: f32 = 24 in range::SHAPE_PLACE_M,
        /// y of the centre, m.
        y_m: f32 = 28 in range::SHAPE_PLACE_M,
        /// Phase, in turns of the wave.
        phase_turns: f32 = 32 in range::PHASE_TURNS,
        /// Electric friction where the wave is 0, N.
        trough_n: f32 = 36 in range::FRICTION_N,
        /// Electric friction where the wave is 1, N.
        crest_n: f32 = 40 in range::FRICTION_N,
        /// Number of spokes per turn: a whole number, so that the last one is followed by the first.
        number: u8 = 52,
    }
}

impl Kind for Spokes {
    type Coefficients = SpokesCoefficients;

    fn cost(&self) -> Cost {
        self.wave.cost() + const { measured_cost("spokes") }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.trough_n, self.crest_n])
    }

    fn prepare(&self, _layer: u8, _preparation: &mut Preparation) -> Result<SpokesCoefficients, Refusal> {
        let (wave, zero_turns) = CentredWave::new(self.wave);
        let number = f32::from(self.number);
        // Infinite without spokes, so that nothing fades.
        let per_narrow_m = core::f32::consts::TAU / (number * NARROW_M);
        Ok(SpokesCoefficients {
            wave,
            x_m: self.x_m,
            y_m: self.y_m,
            number,
            phase_turns: self.phase_turns + zero_turns,
            middle_n: 0.5 * (self.crest_n + self.trough_n),
            swing_n: 0.5 * (self.crest_n - self.trough_n),
            per_square_m: per_narrow_m * per_narrow_m,
        })
    }
}

/// `middle + swing min(1, per_square d^2) w(n a + phase)`, with `w` from -1 to 1, at the distance `d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SpokesCoefficients {
    wave: CentredWave,
    x_m: f32,
    y_m: f32,
    number: f32,
    phase_turns: f32,
    middle_n: f32,
    swing_n: f32,
    per_square_m: f32,
}

impl Evaluate for SpokesCoefficients {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        let [x_m, y_m] = context.inputs.place_m;
        let (x_m, y_m) = (x_m - self.x_m, y_m - self.y_m);
        let fade = (x_m * x_m + y_m * y_m) * self.per_square_m;
        // NaN, and thus no fading, in the centre without spokes.
        let swing_n = if fade < 1.0 { fade * self.swing_n } else { self.swing_n };
        self.middle_n + swing_n * self.wave.at(self.number * angle_turns(x_m, y_m) + self.phase_turns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::context::Inputs;
    use crate::{BitmapPool, Blend, Clicks, Layer, Record, Region, active::ActiveLayers};

    const MIDDLE_M: [f32; 2] = [0.05, 0.03];

    /// Friction of spokes from 0 to 1 N around [`MIDDLE_M`], at distances from it in m.
    fn at(wave: Wave, number: u8, [right_m, down_m]: [f32; 2]) -> f32 {
        let [x_m, y_m] = MIDDLE_M;
        let layer = Layer::Spokes(Spokes { wave, x_m, y_m, phase_turns: 0.2, trough_n: 0.0, crest_n: 1.0, number });
        let mut layers = ActiveLayers::EMPTY;
        let record = Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer };
        layers.push(&record, 40_000, &|_| None).unwrap();
        let mut inputs = Inputs::default();
        inputs.set_place([x_m + right_m, y_m + down_m], 0);
        let pool = Box::new(BitmapPool::new());
        layers.electric_friction_n(&inputs, &pool, &mut Clicks::NONE.clone())
    }

    /// To the left of the centre the angle jumps by a turn, but the friction does not.
    #[test]
    fn spokes_close_to_a_ring() {
        for number in [1, 7, 24, 255] {
            for wave in [Wave::Sine, Wave::Square { duty: 0.5 }, Wave::Triangle, Wave::Saw] {
                let [above, below] = [-1e-8, 1e-8].map(|down_m| at(wave, number, [-0.045, down_m]));
                assert!((above - below).abs() < 2e-4, "{number} {wave:?}: {above} {below}");
            }
        }
    }

    /// Without spokes, no width is below 1 mm, so nothing fades.
    #[test]
    fn no_spokes_are_the_wave_at_its_phase_everywhere() {
        for right_m in [0.0, 1e-5, 1e-3, 0.03] {
            assert_eq!(at(Wave::Square { duty: 0.5 }, 0, [right_m, 0.0]).to_bits(), 1.0_f32.to_bits(), "{right_m}");
        }
    }

    #[test]
    fn the_middle_has_the_mean_and_narrow_spokes_fade_to_it() {
        for wave in [Wave::Sine, Wave::Square { duty: 0.2 }, Wave::Triangle, Wave::Saw] {
            assert!((at(wave, 24, [0.0, 0.0]) - 0.5).abs() < 1e-6, "{wave:?}");
        }
        // Spokes of 1 mm lie on this circle.
        let radius_m = 24.0 * 1e-3 / core::f32::consts::TAU;
        let square = |part: f32| at(Wave::Square { duty: 0.5 }, 24, [part * radius_m, 0.0]);
        for (part, swing) in [(0.25, 0.0625), (0.5, 0.25), (0.9, 0.81), (1.01, 1.0), (5.0, 1.0)] {
            assert!(((square(part) - 0.5).abs() - 0.5 * swing).abs() < 1e-4, "{part}: {}", square(part));
        }
    }
}
