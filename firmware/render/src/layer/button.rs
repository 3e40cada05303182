//! A button: a face with a rim around it.

use frixel_wire::scene::Region;

use super::Moment;
use super::click::{Click, Clicks};
use crate::root::square_root;
use crate::turns;

/// `face + swing (1 - cos(2 pi d / width))` where the depth `d` inside the border is at most the width, `face` elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Button {
    shape: Shape,
    middle_x_m: f32,
    middle_y_m: f32,
    rim_width_m: f32,
    turns_per_m: f32,
    face_n: f32,
    swing_n: f32,
    click: Option<Click>,
}

/// What the depth is measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Rectangle { half_width_m: f32, half_height_m: f32 },
    Ellipse { per_half_width: f32, per_half_height: f32, shorter_half_axis_m: f32 },
}

impl Button {
    /// `None` in a region that a button cannot have.
    pub(super) fn new(
        region: Region,
        rim_width_m: f32,
        [rim_n, face_n]: [f32; 2],
        click: Option<Click>,
    ) -> Option<Self> {
        let (x_m, y_m, half_width_m, half_height_m, round) = match region {
            Region::Rectangle { x_m, y_m, width_m, height_m } => (x_m, y_m, 0.5 * width_m, 0.5 * height_m, false),
            Region::Ellipse { x_m, y_m, width_m, height_m } => (x_m, y_m, 0.5 * width_m, 0.5 * height_m, true),
            Region::Screen | Region::Polygon { .. } => return None,
        };
        let shape = if round {
            Shape::Ellipse {
                per_half_width: 1.0 / half_width_m,
                per_half_height: 1.0 / half_height_m,
                shorter_half_axis_m: half_width_m.min(half_height_m),
            }
        } else {
            Shape::Rectangle { half_width_m, half_height_m }
        };
        Some(Self {
            shape,
            middle_x_m: x_m + half_width_m,
            middle_y_m: y_m + half_height_m,
            rim_width_m,
            turns_per_m: 1.0 / rim_width_m,
            face_n,
            swing_n: 0.5 * (rim_n - face_n),
            click,
        })
    }

    /// Only where the finger is inside the region.
    #[inline]
    pub(super) fn electric_friction_n(&self, moment: &Moment, clicks: &mut Clicks) -> f32 {
        let click_n = self.click.as_ref().map_or(0.0, |click| click.inside(moment.tick, clicks));
        let depth_m = self.depth_m(moment.x_m - self.middle_x_m, moment.y_m - self.middle_y_m);
        if depth_m >= self.rim_width_m {
            return self.face_n + click_n;
        }
        self.face_n + self.swing_n * (1.0 - turns::cosine(depth_m * self.turns_per_m)) + click_n
    }

    #[inline]
    fn depth_m(&self, x_m: f32, y_m: f32) -> f32 {
        let depth_m = match self.shape {
            Shape::Rectangle { half_width_m, half_height_m } => {
                let (across_m, down_m) = (half_width_m - x_m.abs(), half_height_m - y_m.abs());
                if across_m < down_m { across_m } else { down_m }
            }
            Shape::Ellipse { per_half_width, per_half_height, shorter_half_axis_m } => {
                let (x, y) = (x_m * per_half_width, y_m * per_half_height);
                shorter_half_axis_m * (1.0 - square_root(x * x + y * y))
            }
        };
        // On the border rounding may make it less than nothing.
        if depth_m > 0.0 { depth_m } else { 0.0 }
    }
}
