//! A button: a face with a rim around it that fills its region, and a click when the finger slides in.

use frixel_wire::message::Refusal;
use frixel_wire::scene::SceneError;

use crate::click::Click;
use crate::clicks::ClickNumber;
use crate::context::Context;
use crate::cosine::cosine;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::parameters::{parameters, range};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::{ActiveRegion, Region};

parameters! {
    /// A button that fills its region, which is a rectangle or an ellipse.
    pub struct Button {
        /// Width of the rim inside the border, m: a raised cosine from border to face. An ellipse's rim is measured
        /// along its shorter half axis.
        rim_width_m: f32 = 24 in range::SHAPE_WIDTH_M,
        /// Electric friction in the middle of the rim, N.
        rim_n: f32 = 28 in range::FRICTION_N,
        /// Electric friction on the face, N.
        face_n: f32 = 32 in range::FRICTION_N,
        /// Pulse when the finger slides in.
        click: Click = 36,
    }
}

impl Kind for Button {
    type Coefficients = ButtonCoefficients;

    fn check_structure(&self, region: &Region, _point_count: u8, record: u8) -> Result<(), SceneError> {
        match region {
            Region::Rectangle { .. } | Region::Ellipse { .. } => Ok(()),
            Region::Screen | Region::Polygon { .. } => Err(SceneError::ButtonRegion { record }),
        }
    }

    fn cost(&self) -> Cost {
        const { measured_cost("button") }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.rim_n, self.face_n]).plus(self.click.bounds())
    }

    fn click(&self) -> Option<Click> {
        Some(self.click)
    }

    fn table_bytes(&self) -> usize {
        self.click.table_bytes()
    }

    fn prepare(&self, layer: u8, preparation: &mut Preparation) -> Result<ButtonCoefficients, Refusal> {
        Ok(ButtonCoefficients {
            rim_width_m: self.rim_width_m,
            turns_per_m: 1.0 / self.rim_width_m,
            face_n: self.face_n,
            swing_n: 0.5 * (self.rim_n - self.face_n),
            click: self.click.prepare(layer, preparation)?,
        })
    }
}

/// `face + swing (1 - cos(2 pi d / width))` where the depth `d` inside the border is at most the width, `face`
/// elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ButtonCoefficients {
    rim_width_m: f32,
    turns_per_m: f32,
    face_n: f32,
    swing_n: f32,
    click: Option<ClickNumber>,
}

impl Evaluate for ButtonCoefficients {
    #[inline]
    fn electric_friction_n(&self, region: &ActiveRegion, context: &mut Context) -> f32 {
        let click_n = self.click.map_or(0.0, |click| click.inside(context));
        let depth_m = region.depth_m(context.inputs);
        if depth_m >= self.rim_width_m {
            return self.face_n + click_n;
        }
        self.face_n + self.swing_n * (1.0 - cosine(depth_m * self.turns_per_m)) + click_n
    }
}
