//! A line with a ridge or a well along it.

use super::click::ClickNumber;
use super::{Around, direction};
use crate::turns;

/// `level + swing (1 + cos(2 pi d / width))` where the distance `d` is at most half the width, `level` elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    across_x: f32,
    across_y: f32,
    distance_m: f32,
    half_width_m: f32,
    turns_per_m: f32,
    level_n: f32,
    swing_n: f32,
    click: Option<ClickNumber>,
}

impl Edge {
    pub(super) fn new(
        [x_m, y_m]: [f32; 2],
        angle_turns: f32,
        width_m: f32,
        [level_n, ridge_n]: [f32; 2],
        click: Option<ClickNumber>,
    ) -> Self {
        let (across_x, across_y) = direction(angle_turns);
        Self {
            across_x,
            across_y,
            distance_m: across_x * x_m + across_y * y_m,
            half_width_m: 0.5 * width_m,
            turns_per_m: 1.0 / width_m,
            level_n,
            swing_n: 0.5 * (ridge_n - level_n),
            click,
        }
    }

    #[inline(never)]
    pub(super) fn electric_friction_n(&self, around: &mut Around) -> f32 {
        let [x_m, y_m] = around.moment.place_m;
        let beyond_m = self.across_x * x_m + self.across_y * y_m - self.distance_m;
        let click_n = self.click.map_or(0.0, |click| click.across(beyond_m >= 0.0, around));
        if beyond_m.abs() >= self.half_width_m {
            return self.level_n + click_n;
        }
        self.level_n + self.swing_n * (1.0 + turns::cosine(beyond_m * self.turns_per_m)) + click_n
    }
}
