//! A button: a face with a rim around it.

use super::Around;
use super::click::ClickNumber;
use super::region::Region;
use crate::turns;

/// `face + swing (1 - cos(2 pi d / width))` where the depth `d` inside the border is at most the width, `face` elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Button {
    rim_width_m: f32,
    turns_per_m: f32,
    face_n: f32,
    swing_n: f32,
    click: Option<ClickNumber>,
}

impl Button {
    pub(super) fn new(rim_width_m: f32, [rim_n, face_n]: [f32; 2], click: Option<ClickNumber>) -> Self {
        Self { rim_width_m, turns_per_m: 1.0 / rim_width_m, face_n, swing_n: 0.5 * (rim_n - face_n), click }
    }

    /// Only where the finger is inside the region.
    #[inline(never)]
    pub(super) fn electric_friction_n(&self, region: &Region, around: &mut Around) -> f32 {
        let click_n = self.click.map_or(0.0, |click| click.inside(around));
        let depth_m = region.depth_m(around.moment);
        if depth_m >= self.rim_width_m {
            return self.face_n + click_n;
        }
        self.face_n + self.swing_n * (1.0 - turns::cosine(depth_m * self.turns_per_m)) + click_n
    }
}
