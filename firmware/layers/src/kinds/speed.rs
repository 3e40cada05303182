//! A curve over sliding speed: linear between its points, and constant outside.

use frixel_wire::message::{ConfigRefusal, Refusal};
use frixel_wire::scene::{CURVE_POINTS_MAX, SceneError};

use crate::context::Context;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind};
use crate::measured;
use crate::parameters::{parameters, range, within};
use crate::point::{Point, check_count, points_of};
use crate::prepare::Preparation;
use crate::region::{ActiveRegion, Region};
use crate::square_root::square_root;

parameters! {
    /// A curve over sliding speed: linear between its points, and constant outside.
    pub struct Speed {
        /// Its first point among the scene's: speed in m/s, and friction in N or a factor. Speeds ascend.
        first: u8 = 52,
        /// Number of its points, 2 to [`CURVE_POINTS_MAX`](frixel_wire::scene::CURVE_POINTS_MAX).
        count: u8 = 53,
    }
}

impl Kind for Speed {
    type Coefficients = Self;

    fn check_structure(&self, _region: &Region, point_count: u8, record: u8) -> Result<(), SceneError> {
        check_count(self.first, self.count, 2..=CURVE_POINTS_MAX, point_count, record)
    }

    /// Speeds must ascend.
    fn check_relations(&self, points: &[Point], layer: u8) -> Result<(), ConfigRefusal> {
        let mut min_m_per_s = range::SPEED_M_PER_S.min as f32;
        let max_m_per_s = range::SPEED_M_PER_S.max as f32;
        for point in points_of(points, self.first, self.count) {
            within(range::SPEED_M_PER_S.field, point.x, min_m_per_s, max_m_per_s, layer)?;
            range::FRICTION_N.check(point.y, layer)?;
            min_m_per_s = point.x + range::SPEED_STEP_MIN_M_PER_S as f32;
        }
        Ok(())
    }

    fn cost(&self) -> Cost {
        measured::SPEED + measured::SPEED_POINT * u32::from(self.count)
    }

    fn bounds(&self, points: &[Point]) -> Interval<f32> {
        Interval::of(points_of(points, self.first, self.count).iter().map(|point| point.y))
    }

    fn prepare(&self, _layer: u8, _preparation: &mut Preparation) -> Result<Self, Refusal> {
        Ok(*self)
    }
}

impl Evaluate for Speed {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        let [x, y] = context.inputs.velocity_m_per_s;
        let speed_m_per_s = square_root(x * x + y * y);
        let [start, rest @ ..] = points_of(context.tables.points(), self.first, self.count) else { return 0.0 };
        let mut before = start;
        if !(speed_m_per_s > before.x) {
            return before.y;
        }
        for point in rest {
            if speed_m_per_s < point.x {
                return before.y + (speed_m_per_s - before.x) / (point.x - before.x) * (point.y - before.y);
            }
            before = point;
        }
        before.y
    }
}
