//! A curve over sliding speed: the only kind that reads speed.

use super::Around;
use crate::root::square_root;

/// Straight between its points, held outside of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Curve {
    first: u8,
    count: u8,
}

impl Curve {
    pub(super) fn new(first: u8, count: u8) -> Self {
        Self { first, count }
    }

    #[inline(never)]
    pub(super) fn electric_friction_n(&self, around: &Around) -> f32 {
        let points = around.tables.points();
        let [x, y] = around.moment.velocity_m_per_s;
        let speed_m_per_s = square_root(x * x + y * y);
        let first = usize::from(self.first);
        let Some([start, rest @ ..]) = points.get(first..first + usize::from(self.count)) else { return 0.0 };
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
