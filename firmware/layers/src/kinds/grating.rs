//! Parallel stripes: `trough + (crest - trough) w(kx x + ky y + phase - drift t)`, with the wave `w` from 0 to 1.

use frixel_wire::message::Refusal;

use crate::context::Context;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::parameters::{parameters, range};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::ActiveRegion;
use crate::wave::{CentredWave, Phase, Wave};

parameters! {
    /// Stripes: `trough + (crest - trough) w(kx x + ky y + phase - drift t)` at the time `t` since power-on, with `w`
    /// between 0 and 1 and a period of one turn.
    pub struct Grating {
        /// Shape of the stripes.
        wave: Wave = 44,
        /// Cycles per metre along x.
        cycles_per_m_x: f32 = 24 in range::CYCLES_PER_M,
        /// Cycles per metre along y.
        cycles_per_m_y: f32 = 28 in range::CYCLES_PER_M,
        /// Phase, in turns.
        phase_turns: f32 = 32 in range::PHASE_TURNS,
        /// Electric friction where the wave is 0, N.
        trough_n: f32 = 36 in range::FRICTION_N,
        /// Electric friction where the wave is 1, N.
        crest_n: f32 = 40 in range::FRICTION_N,
        /// Waves per second that pass a place, in the direction in which the phase grows; negative against it.
        drift_hz: f32 = 48 in range::DRIFT_HZ,
    }
}

impl Kind for Grating {
    type Coefficients = GratingCoefficients;

    fn cost(&self) -> Cost {
        let at_rest = self.wave.cost();
        if self.drift_hz == 0.0 { at_rest } else { at_rest + const { measured_cost("drift") } }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.trough_n, self.crest_n])
    }

    fn prepare(&self, _layer: u8, preparation: &mut Preparation) -> Result<GratingCoefficients, Refusal> {
        let (wave, zero_turns) = CentredWave::new(self.wave);
        Ok(GratingCoefficients {
            wave,
            cycles_per_m_x: self.cycles_per_m_x,
            cycles_per_m_y: self.cycles_per_m_y,
            phase: Phase::new(self.phase_turns + zero_turns, self.drift_hz, preparation.tick_hz),
            middle_n: 0.5 * (self.crest_n + self.trough_n),
            swing_n: 0.5 * (self.crest_n - self.trough_n),
        })
    }
}

/// `middle + swing w(kx x + ky y + phase)`, with `w` from -1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct GratingCoefficients {
    wave: CentredWave,
    cycles_per_m_x: f32,
    cycles_per_m_y: f32,
    phase: Phase,
    middle_n: f32,
    swing_n: f32,
}

impl Evaluate for GratingCoefficients {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        // Computed first, since floats do not stay in registers across the call.
        let phase_turns = self.phase.at(context.inputs.tick);
        let [x_m, y_m] = context.inputs.place_m;
        let turns = x_m * self.cycles_per_m_x + y_m * self.cycles_per_m_y + phase_turns;
        self.middle_n + self.swing_n * self.wave.at(turns)
    }
}
