//! Where a layer acts.

use frixel_wire::scene::{Point, Region as Record};

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

/// A rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    left_m: f32,
    top_m: f32,
    right_m: f32,
    bottom_m: f32,
}

impl Bounds {
    #[inline]
    fn contain(&self, x_m: f32, y_m: f32) -> bool {
        x_m >= self.left_m && x_m < self.right_m && y_m >= self.top_m && y_m < self.bottom_m
    }
}

impl Region {
    /// `None` for a region that this firmware was built without. `points` are the scene's.
    pub(super) fn new(record: Record, points: &[Point]) -> Option<Self> {
        match record {
            Record::Screen => Some(Self::Screen),
            Record::Rectangle { x_m, y_m, width_m, height_m } => Some(Self::Rectangle(Bounds {
                left_m: x_m,
                top_m: y_m,
                right_m: x_m + width_m,
                bottom_m: y_m + height_m,
            })),
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
    pub(super) fn contains(&self, [x_m, y_m]: [f32; 2], points: &[Point]) -> bool {
        match self {
            Self::Screen => true,
            Self::Rectangle(bounds) => bounds.contain(x_m, y_m),
            Self::Ellipse { middle_x_m, middle_y_m, per_half_width, per_half_height } => {
                let x = (x_m - middle_x_m) * per_half_width;
                let y = (y_m - middle_y_m) * per_half_height;
                x * x + y * y <= 1.0
            }
            #[cfg(feature = "polygon")]
            Self::Polygon { first, count } => polygon::contains(polygon::vertices(points, *first, *count), x_m, y_m),
            #[cfg(not(feature = "polygon"))]
            #[allow(unreachable_patterns, reason = "points belong to polygons")]
            _ => points.is_empty(),
        }
    }
}

#[cfg(feature = "edge")]
impl Region {
    /// How far inside its border a place is that it contains: from the nearest side of a rectangle, along the shorter
    /// half axis of an ellipse. Nothing of what has no such border.
    #[inline]
    pub(super) fn depth_m(&self, [x_m, y_m]: [f32; 2]) -> f32 {
        let less = |one: f32, other: f32| if one < other { one } else { other };
        let depth_m = match self {
            Self::Rectangle(Bounds { left_m, top_m, right_m, bottom_m }) => {
                less(less(x_m - left_m, right_m - x_m), less(y_m - top_m, bottom_m - y_m))
            }
            Self::Ellipse { middle_x_m, middle_y_m, per_half_width, per_half_height } => {
                let x = (x_m - middle_x_m) * per_half_width;
                let y = (y_m - middle_y_m) * per_half_height;
                let shorter_per_m = -less(-per_half_width, -per_half_height);
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

    pub(super) fn vertices(points: &[Point], first: u8, count: u8) -> &[Point] {
        let first = usize::from(first);
        points.get(first..first + usize::from(count)).unwrap_or_default()
    }

    /// Even-odd rule: whether a line towards larger x crosses the edges an odd number of times.
    ///
    /// Where an edge lies is computed from its upper end to its lower end, whichever is the first, so that two polygons
    /// with a common edge agree on it to the bit.
    #[inline(never)]
    pub(super) fn contains(vertices: &[Point], x_m: f32, y_m: f32) -> bool {
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
