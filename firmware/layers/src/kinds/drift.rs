//! Gratings and rings that move. Their phase is a tick number times a step, modulo a turn, as that of a vibration: it
//! is as exact after 2^32 ticks as after one.

use frixel_wire::message::{ConfigRefusal, Refusal};

use super::grating::Grating;
use super::rings::Rings;
use crate::context::Context;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::layout::RecordBytes;
use crate::parameters::{Parameter, Parameters, UnknownForm, parameters, range};
use crate::point::Point;
use crate::prepare::{Preparation, steps_per_tick};
use crate::region::ActiveRegion;
use crate::wave::{GRATING_LEN, TURNS_PER_STEP};

parameters! {
    /// A grating that moves along the direction in which its phase grows.
    pub struct DriftingGrating {
        /// The grating at tick 0.
        grating: Grating = 24,
        /// Waves that pass a place in a second; negative where they move the other way.
        drift_hz: f32 = 48 in range::DRIFT_HZ,
    }
}

parameters! {
    /// Rings that move outwards.
    pub struct DriftingRings {
        /// The rings at tick 0.
        rings: Rings = 24,
        /// Waves that pass a place in a second; negative where they move inwards.
        drift_hz: f32 = 48 in range::DRIFT_HZ,
    }
}

/// The parameters of a kind at rest, at their own offsets.
macro_rules! parameter {
    ($($kind:ident),*) => { $(
        impl Parameter for $kind {
            const LEN: usize = GRATING_LEN;

            fn read(record: &RecordBytes, _offset: usize) -> Result<Self, UnknownForm> {
                Parameters::read(record)
            }

            fn write(&self, record: &mut RecordBytes, _offset: usize) {
                Parameters::write(self, record);
            }

            fn check(&self, layer: u8) -> Result<(), ConfigRefusal> {
                Parameters::check(self, layer)
            }
        }
    )* };
}

parameter!(Grating, Rings);

impl Kind for DriftingGrating {
    type Coefficients = Drifting<<Grating as Kind>::Coefficients>;

    fn cost(&self) -> Cost {
        self.grating.cost() + const { measured_cost("drift") }
    }

    fn bounds(&self, points: &[Point]) -> Interval<f32> {
        self.grating.bounds(points)
    }

    fn prepare(&self, layer: u8, preparation: &mut Preparation) -> Result<Self::Coefficients, Refusal> {
        let steps_per_tick = steps_per_tick(self.drift_hz, preparation.tick_hz);
        Ok(Drifting { at_rest: self.grating.prepare(layer, preparation)?, steps_per_tick })
    }
}

impl Kind for DriftingRings {
    type Coefficients = Drifting<<Rings as Kind>::Coefficients>;

    fn cost(&self) -> Cost {
        self.rings.wave.cost() + const { measured_cost("drifting_rings") }
    }

    fn bounds(&self, points: &[Point]) -> Interval<f32> {
        self.rings.bounds(points)
    }

    fn prepare(&self, layer: u8, preparation: &mut Preparation) -> Result<Self::Coefficients, Refusal> {
        let steps_per_tick = steps_per_tick(self.drift_hz, preparation.tick_hz);
        Ok(Drifting { at_rest: self.rings.prepare(layer, preparation)?, steps_per_tick })
    }
}

/// Coefficients with a phase that falls with time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drifting<C> {
    at_rest: C,
    /// Steps of 2^-32 turns, modulo a turn.
    steps_per_tick: u32,
}

/// Coefficients of a wave over the screen.
pub(crate) trait Shift: Evaluate {
    /// The same wave with a phase that is later by a part of a turn.
    fn shifted(self, turns: f32) -> Self;
}

impl<C: Shift> Evaluate for Drifting<C> {
    #[inline]
    fn electric_friction_n(&self, region: &ActiveRegion, context: &mut Context) -> f32 {
        // As a signed number, the phase is between -1/2 and 1/2 turn.
        let phase = context.inputs.tick.wrapping_mul(self.steps_per_tick) as i32;
        self.at_rest.shifted(phase as f32 * -TURNS_PER_STEP).electric_friction_n(region, context)
    }
}
