//! Rings around a centre: `trough + (crest - trough) w(k d - drift t)` at the distance `d`, with the wave `w` from 0 to
//! 1.

use frixel_wire::message::Refusal;

use crate::context::Context;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::parameters::{parameters, range};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::ActiveRegion;
use crate::square_root::square_root;
use crate::wave::{CentredWave, Phase, Wave};

parameters! {
    /// Rings: `trough + (crest - trough) w(k d - drift t)` at the distance `d` from the centre and the time `t` since
    /// power-on, with `w` between 0 and 1 and a period of one turn.
    pub struct Rings {
        /// Shape of the rings, from the centre outwards.
        wave: Wave = 44,
        /// x of the centre, m.
        x_m: f32 = 24 in range::SHAPE_PLACE_M,
        /// y of the centre, m.
        y_m: f32 = 28 in range::SHAPE_PLACE_M,
        /// Rings per metre, outwards.
        cycles_per_m: f32 = 32 in range::CYCLES_PER_M,
        /// Electric friction where the wave is 0, N.
        trough_n: f32 = 36 in range::FRICTION_N,
        /// Electric friction where the wave is 1, N.
        crest_n: f32 = 40 in range::FRICTION_N,
        /// Waves per second that pass a place, outwards; negative inwards.
        drift_hz: f32 = 48 in range::DRIFT_HZ,
    }
}

impl Kind for Rings {
    type Coefficients = RingsCoefficients;

    fn cost(&self) -> Cost {
        let rings = if self.drift_hz == 0.0 {
            const { measured_cost("rings") }
        } else {
            const { measured_cost("drifting_rings") }
        };
        self.wave.cost() + rings
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.trough_n, self.crest_n])
    }

    fn prepare(&self, _layer: u8, preparation: &mut Preparation) -> Result<RingsCoefficients, Refusal> {
        let (wave, zero_turns) = CentredWave::new(self.wave);
        Ok(RingsCoefficients {
            wave,
            x_m: self.x_m,
            y_m: self.y_m,
            cycles_per_m: self.cycles_per_m,
            phase: Phase::new(zero_turns, self.drift_hz, preparation.tick_hz),
            middle_n: 0.5 * (self.crest_n + self.trough_n),
            swing_n: 0.5 * (self.crest_n - self.trough_n),
        })
    }
}

/// `middle + swing w(k d + phase)`, with `w` from -1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RingsCoefficients {
    wave: CentredWave,
    x_m: f32,
    y_m: f32,
    cycles_per_m: f32,
    phase: Phase,
    middle_n: f32,
    swing_n: f32,
}

impl Evaluate for RingsCoefficients {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        // Computed first, since floats do not stay in registers across the call.
        let phase_turns = self.phase.at(context.inputs.tick);
        let [x_m, y_m] = context.inputs.place_m;
        let (x_m, y_m) = (x_m - self.x_m, y_m - self.y_m);
        let distance_m = square_root(x_m * x_m + y_m * y_m);
        self.middle_n + self.swing_n * self.wave.at(distance_m * self.cycles_per_m + phase_turns)
    }
}
