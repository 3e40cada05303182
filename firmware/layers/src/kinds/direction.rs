//! Friction that depends on the direction of the slide: one friction along an axis, another against it.

use frixel_wire::message::Refusal;

use crate::context::Context;
use crate::cosine::direction;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::parameters::{parameters, range};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::ActiveRegion;
use crate::square_root::square_root;

/// Speed below which the friction fades to the mean of both directions, m/s, since the estimated velocity of a nearly
/// resting finger has a random direction. Fingers that explore slowly move at about this speed.
const FADE_M_PER_S: f32 = 0.02;

parameters! {
    /// `against + (along - against) (1 + f c) / 2` with the cosine `c` of the angle between an axis and the finger's
    /// velocity. `f` is 1 from a speed of 20 mm/s on, and the speed over 20 mm/s below.
    pub struct Direction {
        /// Direction of the axis, from x towards y, in turns.
        angle_turns: f32 = 24 in range::ANGLE_TURNS,
        /// Electric friction of a finger that slides along the axis, N.
        along_n: f32 = 28 in range::FRICTION_N,
        /// Electric friction of a finger that slides the other way, N.
        against_n: f32 = 32 in range::FRICTION_N,
    }
}

impl Kind for Direction {
    type Coefficients = DirectionCoefficients;

    fn cost(&self) -> Cost {
        const { measured_cost("direction") }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.along_n, self.against_n])
    }

    fn prepare(&self, _layer: u8, _preparation: &mut Preparation) -> Result<DirectionCoefficients, Refusal> {
        let (axis_x, axis_y) = direction(self.angle_turns);
        Ok(DirectionCoefficients {
            axis_x,
            axis_y,
            middle_n: 0.5 * (self.along_n + self.against_n),
            swing_n: 0.5 * (self.along_n - self.against_n),
        })
    }
}

/// `middle + swing p`, with the component `p` from -1 to 1 of the velocity along the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DirectionCoefficients {
    axis_x: f32,
    axis_y: f32,
    middle_n: f32,
    swing_n: f32,
}

impl Evaluate for DirectionCoefficients {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        let [x, y] = context.inputs.velocity_m_per_s;
        let speed_m_per_s = square_root(x * x + y * y);
        let along_m_per_s = self.axis_x * x + self.axis_y * y;
        let part = along_m_per_s / if speed_m_per_s > FADE_M_PER_S { speed_m_per_s } else { FADE_M_PER_S };
        // Keeps the friction between both, even if the squares overflow or the velocity is NaN.
        let part = if part > -1.0 { if part < 1.0 { part } else { 1.0 } } else { -1.0 };
        self.middle_n + self.swing_n * part
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::context::Inputs;
    use crate::{BitmapPool, Blend, Clicks, Layer, Record, Region, active::ActiveLayers};

    /// Friction under a finger of this velocity, m/s.
    fn at(direction: Direction, velocity_m_per_s: [f32; 2]) -> f32 {
        let layer = Layer::Direction(direction);
        let mut layers = ActiveLayers::EMPTY;
        let record = Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer };
        layers.push(&record, 40_000, &|_| None).unwrap();
        let pool = Box::new(BitmapPool::new());
        let inputs = Inputs { velocity_m_per_s, ..Inputs::default() };
        layers.electric_friction_n(&inputs, &pool, &mut Clicks::NONE.clone())
    }

    /// 1 N along the axis, 0 N against it.
    fn part(angle_turns: f32, velocity_m_per_s: [f32; 2]) -> f32 {
        at(Direction { angle_turns, along_n: 1.0, against_n: 0.0 }, velocity_m_per_s)
    }

    /// A reversal passes through the mean of both, in steps proportional to those of the velocity.
    #[test]
    fn a_slow_finger_feels_the_mean_of_both() {
        for (speed, expected) in [(0.0, 0.5), (1e-30, 0.5), (1e-4, 0.5025), (-1e-4, 0.4975), (0.01, 0.75), (0.02, 1.0)]
        {
            assert!((part(0.0, [speed, 0.0]) - expected).abs() < 1e-6, "{speed}: {}", part(0.0, [speed, 0.0]));
        }
        let reversal = (-500..500).map(|number| part(0.0, [1e-4 * number as f32, 0.0]));
        let steps = reversal.clone().zip(reversal.skip(1)).map(|(before, after)| after - before);
        assert!(steps.clone().all(|step| (-1e-6..0.00251).contains(&step)), "{:?}", steps.reduce(f32::max));
    }

    #[test]
    fn every_velocity_stays_between_both_frictions() {
        let extremes = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, f32::MAX, f32::MIN, 2e19, 1e15, 1e-20, 1e-45, -0.0];
        for angle_turns in [0.0, 0.125, 0.25, -1.0] {
            for velocity in extremes.into_iter().flat_map(|x| extremes.map(|y| [x, y])) {
                let found = part(angle_turns, velocity);
                assert!((0.0..=1.0).contains(&found), "{angle_turns} {velocity:?}: {found}");
            }
        }
        // Where the squares overflow, the side is still the right one.
        assert!(part(0.0, [2e19, 0.0]) >= 1.0 && part(0.0, [f32::NEG_INFINITY, 0.0]) <= 0.0);
    }
}
