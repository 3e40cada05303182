//! A line with a ridge or a well along it, and a click when the finger crosses it.

use frixel_wire::message::Refusal;

use crate::click::Click;
use crate::clicks::ClickNumber;
use crate::context::Context;
use crate::cosine::{cosine, direction};
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::parameters::{parameters, range};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::ActiveRegion;

parameters! {
    /// A line with a ridge or a well along it, and a click when the finger crosses it.
    pub struct Edge {
        /// x of a point on the line, m.
        x_m: f32 = 24 in range::SHAPE_PLACE_M,
        /// y of the same point, m.
        y_m: f32 = 28 in range::SHAPE_PLACE_M,
        /// Direction across the line, from x towards y, in turns.
        angle_turns: f32 = 32 in range::ANGLE_TURNS,
        /// Width of the ridge, which falls off as a raised cosine on both sides, m.
        width_m: f32 = 36 in range::SHAPE_WIDTH_M,
        /// Electric friction beside the ridge, N.
        level_n: f32 = 40 in range::FRICTION_N,
        /// Electric friction on the line, N.
        ridge_n: f32 = 44 in range::FRICTION_N,
        /// Pulse when the line is crossed.
        click: Click = 48,
    }
}

impl Kind for Edge {
    type Coefficients = EdgeCoefficients;

    fn cost(&self) -> Cost {
        const { measured_cost("edge") }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.level_n, self.ridge_n]).plus(self.click.bounds())
    }

    fn click(&self) -> Option<Click> {
        Some(self.click)
    }

    fn table_bytes(&self) -> usize {
        self.click.table_bytes()
    }

    fn prepare(&self, layer: u8, preparation: &mut Preparation) -> Result<EdgeCoefficients, Refusal> {
        let (across_x, across_y) = direction(self.angle_turns);
        Ok(EdgeCoefficients {
            across_x,
            across_y,
            distance_m: across_x * self.x_m + across_y * self.y_m,
            half_width_m: 0.5 * self.width_m,
            turns_per_m: 1.0 / self.width_m,
            level_n: self.level_n,
            swing_n: 0.5 * (self.ridge_n - self.level_n),
            click: self.click.prepare(layer, preparation)?,
        })
    }
}

/// `level + swing (1 + cos(2 pi d / width))` where the distance `d` is at most half the width, `level` elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EdgeCoefficients {
    across_x: f32,
    across_y: f32,
    distance_m: f32,
    half_width_m: f32,
    turns_per_m: f32,
    level_n: f32,
    swing_n: f32,
    click: Option<ClickNumber>,
}

impl Evaluate for EdgeCoefficients {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        let [x_m, y_m] = context.inputs.place_m;
        let beyond_m = self.across_x * x_m + self.across_y * y_m - self.distance_m;
        let click_n = self.click.map_or(0.0, |click| click.across(beyond_m >= 0.0, context));
        if beyond_m.abs() >= self.half_width_m {
            return self.level_n + click_n;
        }
        self.level_n + self.swing_n * (1.0 + cosine(beyond_m * self.turns_per_m)) + click_n
    }
}
