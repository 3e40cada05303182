//! The same friction everywhere.

use frixel_wire::message::Refusal;

use crate::context::Context;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::parameters::{parameters, range};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::ActiveRegion;

parameters! {
    /// The same friction everywhere.
    pub struct Constant {
        /// Electric friction, N.
        electric_friction_n: f32 = 24 in range::FRICTION_N,
    }
}

impl Kind for Constant {
    type Coefficients = Self;

    fn cost(&self) -> Cost {
        const { measured_cost("constant") }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.electric_friction_n])
    }

    fn prepare(&self, _layer: u8, _preparation: &mut Preparation) -> Result<Self, Refusal> {
        Ok(*self)
    }
}

impl Evaluate for Constant {
    const IN_LINE: bool = true;

    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, _context: &mut Context) -> f32 {
        self.electric_friction_n
    }
}
