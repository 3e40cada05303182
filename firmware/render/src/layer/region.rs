//! Where a layer acts.

use frixel_wire::scene::{Point, Region as Record};

use super::{Around, Moment};

/// Rectangles are told apart in whole steps of 2^-28 m, 3.7 nm: a tick compares whole numbers sooner than those in `f32`.
/// Whatever a scene may name is within 4 m.
const STEPS_PER_M: f32 = (1 << 28) as f32;

/// A place in steps; held at the ends of the numbers.
#[inline]
pub(super) fn steps(place_m: f32) -> i32 {
    (place_m * STEPS_PER_M) as i32
}

/// A region, ready to be tested. Left and top edges belong to it, right and bottom ones do not; an ellipse's border
/// does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u8)]
pub(super) enum Region {
    Screen,
    Rectangle(Bounds),
    Ellipse {
        middle_x_m: f32,
        middle_y_m: f32,
        per_half_width: f32,
        per_half_height: f32,
    },
    #[cfg(feature = "polygon")]
    Polygon {
        first: u8,
        count: u8,
    },
}

/// A rectangle, in steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    left: i32,
    width: u32,
    top: i32,
    height: u32,
}

impl Bounds {
    fn new([x_m, y_m]: [f32; 2], [width_m, height_m]: [f32; 2]) -> Self {
        let (left, top) = (steps(x_m), steps(y_m));
        Self {
            left,
            width: steps(x_m + width_m).wrapping_sub(left) as u32,
            top,
            height: steps(y_m + height_m).wrapping_sub(top) as u32,
        }
    }

    #[inline]
    fn contain(&self, moment: &Moment) -> bool {
        let [right, down] = self.inside(moment);
        // What is to the left is, without a sign, farther to the right than any width.
        right < self.width && down < self.height
    }

    /// How far to the right of the left edge, and below the top one, in steps.
    #[inline]
    fn inside(&self, moment: &Moment) -> [u32; 2] {
        let [x, y] = moment.place_steps;
        [x.wrapping_sub(self.left) as u32, y.wrapping_sub(self.top) as u32]
    }
}

impl Region {
    /// `None` for a region that this firmware was built without. `points` are the scene's.
    pub(super) fn new(record: Record, points: &[Point]) -> Option<Self> {
        match record {
            Record::Screen => Some(Self::Screen),
            Record::Rectangle { x_m, y_m, width_m, height_m } => {
                Some(Self::Rectangle(Bounds::new([x_m, y_m], [width_m, height_m])))
            }
            Record::Ellipse { x_m, y_m, width_m, height_m } => Some(Self::Ellipse {
                middle_x_m: x_m + 0.5 * width_m,
                middle_y_m: y_m + 0.5 * height_m,
                per_half_width: 2.0 / width_m,
                per_half_height: 2.0 / height_m,
            }),
            #[cfg(feature = "polygon")]
            Record::Polygon { first, count } => {
                let vertices = polygon::vertices(points, first, count);
                (!vertices.is_empty()).then_some(Self::Polygon { first, count })
            }
            #[cfg(not(feature = "polygon"))]
            Record::Polygon { .. } => {
                let _ = points;
                None
            }
        }
    }

    #[inline]
    pub(super) fn contains(&self, around: &Around) -> bool {
        match self {
            Self::Screen => true,
            Self::Rectangle(bounds) => bounds.contain(around.moment),
            Self::Ellipse { middle_x_m, middle_y_m, per_half_width, per_half_height } => {
                let [x_m, y_m] = around.moment.place_m;
                let x = (x_m - middle_x_m) * per_half_width;
                let y = (y_m - middle_y_m) * per_half_height;
                x * x + y * y <= 1.0
            }
            #[cfg(feature = "polygon")]
            Self::Polygon { first, count } => polygon::contains(*first, *count, around),
        }
    }
}

#[cfg(feature = "edge")]
impl Region {
    /// How far inside its border a place is that it contains: from the nearest side of a rectangle, along the shorter
    /// half axis of an ellipse. Nothing of what has no such border.
    #[inline]
    pub(super) fn depth_m(&self, moment: &Moment) -> f32 {
        let [x_m, y_m] = moment.place_m;
        let depth_m = match self {
            Self::Rectangle(bounds) => {
                let [right, down] = bounds.inside(moment);
                let across = right.min(bounds.width.saturating_sub(right));
                let depth = across.min(down).min(bounds.height.saturating_sub(down));
                return depth as f32 * (1.0 / STEPS_PER_M);
            }
            Self::Ellipse { middle_x_m, middle_y_m, per_half_width, per_half_height } => {
                let x = (x_m - middle_x_m) * per_half_width;
                let y = (y_m - middle_y_m) * per_half_height;
                let shorter_per_m = if per_half_width > per_half_height { per_half_width } else { per_half_height };
                (1.0 - crate::root::square_root(x * x + y * y)) / shorter_per_m
            }
            #[cfg(feature = "polygon")]
            Self::Polygon { .. } => 0.0,
            Self::Screen => 0.0,
        };
        // On the border rounding may make it less than nothing.
        if depth_m > 0.0 { depth_m } else { 0.0 }
    }
}

#[cfg(feature = "polygon")]
mod polygon {
    use frixel_wire::scene::Point;

    use super::Around;

    pub(super) fn vertices(points: &[Point], first: u8, count: u8) -> &[Point] {
        let first = usize::from(first);
        points.get(first..first + usize::from(count)).unwrap_or_default()
    }

    /// Even-odd rule: whether a line towards larger x crosses the edges an odd number of times.
    ///
    /// Where an edge lies is computed from its upper end to its lower end, whichever is the first, so that two polygons
    /// with a common edge agree on it to the bit.
    #[inline(never)]
    pub(super) fn contains(first: u8, count: u8, around: &Around) -> bool {
        let vertices = vertices(around.tables.points(), first, count);
        let [x_m, y_m] = around.moment.place_m;
        let Some(mut before) = vertices.last() else { return false };
        let mut inside = false;
        for vertex in vertices {
            let down = vertex.y > y_m;
            if down != (before.y > y_m) {
                let (upper, lower) = if down { (before, vertex) } else { (vertex, before) };
                if (x_m - upper.x) * (lower.y - upper.y) < (y_m - upper.y) * (lower.x - upper.x) {
                    inside = !inside;
                }
            }
            before = vertex;
        }
        inside
    }
}
