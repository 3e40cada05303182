//! The part of the screen where a layer acts.

#[cfg(feature = "polygon")]
mod polygon;

use frixel_wire::bytes::{get_at, put_at};
use frixel_wire::hello::feature;
use frixel_wire::message::ConfigRefusal;
use frixel_wire::scene::{POLYGON_POINTS_MAX, SceneError};

use crate::context::{Context, Inputs, STEPS_PER_M, place_steps};
use crate::cost::Cost;
use crate::layout::{REGION_AT, REGION_NUMBERS_AT, RecordBytes};
use crate::measured;
use crate::parameters::{Parameter, UnknownForm, range};
use crate::point::{Point, check_count, points_of};

const SCREEN: u8 = 0;
const RECTANGLE: u8 = 1;
const ELLIPSE: u8 = 2;
pub(crate) const POLYGON: u8 = 3;

const POLYGON_FIRST_AT: usize = REGION_NUMBERS_AT;
const POLYGON_COUNT_AT: usize = REGION_NUMBERS_AT + 1;

/// The part of the screen where a layer acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// Everywhere.
    Screen,
    /// A rectangle parallel to the screen, including its left and top edges, excluding right and bottom ones.
    Rectangle {
        /// Left edge, m.
        x_m: f32,
        /// Top edge, m.
        y_m: f32,
        /// Width, m.
        width_m: f32,
        /// Height, m.
        height_m: f32,
    },
    /// The ellipse inscribed in a rectangle, including its border.
    Ellipse {
        /// Left end, m.
        x_m: f32,
        /// Top end, m.
        y_m: f32,
        /// Width, m.
        width_m: f32,
        /// Height, m.
        height_m: f32,
    },
    /// A polygon, by the even-odd rule, including left and top edges, excluding right and bottom ones. A place on an
    /// edge shared by two polygons is in exactly one of them.
    Polygon {
        /// Index of its first vertex among the scene's points, which are in m.
        first: u8,
        /// Number of vertices, 3 to [`POLYGON_POINTS_MAX`]; the last one is joined to the first.
        count: u8,
    },
}

impl Region {
    pub(crate) fn write(&self, record: &mut RecordBytes) {
        match *self {
            Self::Screen => put_at(record, REGION_AT, [SCREEN]),
            Self::Rectangle { x_m, y_m, width_m, height_m } => {
                put_at(record, REGION_AT, [RECTANGLE]);
                put_numbers(record, [x_m, y_m, width_m, height_m]);
            }
            Self::Ellipse { x_m, y_m, width_m, height_m } => {
                put_at(record, REGION_AT, [ELLIPSE]);
                put_numbers(record, [x_m, y_m, width_m, height_m]);
            }
            Self::Polygon { first, count } => {
                put_at(record, REGION_AT, [POLYGON]);
                put_at(record, POLYGON_FIRST_AT, [first]);
                put_at(record, POLYGON_COUNT_AT, [count]);
            }
        }
    }

    /// Reads the region of a record. A polygon is unknown without its feature.
    pub(crate) fn read(record: &RecordBytes, number: u8) -> Result<Self, SceneError> {
        let numbers = || -> Result<[f32; 4], UnknownForm> {
            let number = |number| f32::read(record, REGION_NUMBERS_AT + number * f32::LEN);
            Ok([number(0)?, number(1)?, number(2)?, number(3)?])
        };
        let [x_m, y_m, width_m, height_m] = numbers().unwrap_or_default();
        let [first] = get_at(record, POLYGON_FIRST_AT);
        let [count] = get_at(record, POLYGON_COUNT_AT);
        match get_at(record, REGION_AT) {
            [SCREEN] => Ok(Self::Screen),
            [RECTANGLE] => Ok(Self::Rectangle { x_m, y_m, width_m, height_m }),
            [ELLIPSE] => Ok(Self::Ellipse { x_m, y_m, width_m, height_m }),
            [POLYGON] if cfg!(feature = "polygon") => Ok(Self::Polygon { first, count }),
            [value] => Err(SceneError::UnknownChoice { record: number, offset: REGION_AT as u8, value }),
        }
    }

    /// The bit of [`feature`] needed for the region, or 0.
    pub(crate) fn feature(&self) -> u32 {
        if matches!(self, Self::Polygon { .. }) { feature::POLYGON } else { 0 }
    }

    /// Checks that a polygon's points are in the scene.
    pub(crate) fn check_structure(&self, point_count: u8, record: u8) -> Result<(), SceneError> {
        match *self {
            Self::Polygon { first, count } => check_count(first, count, 3..=POLYGON_POINTS_MAX, point_count, record),
            Self::Screen | Self::Rectangle { .. } | Self::Ellipse { .. } => Ok(()),
        }
    }

    /// Checks the ranges of the numbers; `points` are the scene's.
    pub(crate) fn check(&self, points: &[Point], layer: u8) -> Result<(), ConfigRefusal> {
        match *self {
            Self::Screen => Ok(()),
            Self::Rectangle { x_m, y_m, width_m, height_m } | Self::Ellipse { x_m, y_m, width_m, height_m } => {
                range::REGION_PLACE_M.check(x_m, layer)?;
                range::REGION_PLACE_M.check(y_m, layer)?;
                range::REGION_SIZE_M.check(width_m, layer)?;
                range::REGION_SIZE_M.check(height_m, layer)
            }
            Self::Polygon { first, count } => points_of(points, first, count).iter().try_for_each(|vertex| {
                range::VERTEX_M.check(vertex.x, layer)?;
                range::VERTEX_M.check(vertex.y, layer)
            }),
        }
    }

    /// Largest number of core cycles of the test for the region, in addition to the test for a rectangle; `points` are
    /// the scene's.
    pub(crate) fn cost(&self, points: &[Point]) -> Cost {
        match *self {
            Self::Screen | Self::Rectangle { .. } => Cost::ZERO,
            Self::Ellipse { .. } => measured::ELLIPSE,
            Self::Polygon { first, count } => {
                let vertices = points_of(points, first, count);
                measured::POLYGON
                    + measured::POLYGON_EDGE * u32::from(count)
                    + measured::POLYGON_EDGE_LEVEL * edges_level_max(vertices)
            }
        }
    }
}

fn put_numbers(record: &mut RecordBytes, numbers: [f32; 4]) {
    for (number, value) in numbers.into_iter().enumerate() {
        value.write(record, REGION_NUMBERS_AT + number * f32::LEN);
    }
}

/// Largest number of a polygon's edges that a horizontal line crosses. Between two vertices, it is the number at the
/// upper one.
fn edges_level_max(vertices: &[Point]) -> u32 {
    vertices.iter().map(|vertex| edges_level(vertices, vertex.y)).max().unwrap_or(0)
}

/// Number of a polygon's edges that the horizontal line at `y_m` crosses: those with exactly one end below it.
fn edges_level(vertices: &[Point], y_m: f32) -> u32 {
    let mut was_below = vertices.last().is_some_and(|vertex| vertex.y > y_m);
    let mut count = 0;
    for vertex in vertices {
        let is_below = vertex.y > y_m;
        count += u32::from(is_below != was_below);
        was_below = is_below;
    }
    count
}

/// A region, prepared for testing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(u8)]
pub(crate) enum ActiveRegion {
    Screen,
    Rectangle(Sides),
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
pub(crate) struct Sides {
    left: i32,
    width: u32,
    top: i32,
    height: u32,
}

impl Sides {
    fn new([x_m, y_m]: [f32; 2], [width_m, height_m]: [f32; 2]) -> Self {
        let (left, top) = (place_steps(x_m), place_steps(y_m));
        Self {
            left,
            width: place_steps(x_m + width_m).wrapping_sub(left) as u32,
            top,
            height: place_steps(y_m + height_m).wrapping_sub(top) as u32,
        }
    }

    #[inline]
    fn contain(&self, inputs: &Inputs) -> bool {
        let [right, down] = self.inside(inputs);
        // A place to the left wraps around to a number larger than any width.
        right < self.width && down < self.height
    }

    /// Distance from the left and from the top edge, in steps.
    #[inline]
    fn inside(&self, inputs: &Inputs) -> [u32; 2] {
        let [x, y] = inputs.place_steps;
        [x.wrapping_sub(self.left) as u32, y.wrapping_sub(self.top) as u32]
    }
}

impl ActiveRegion {
    /// Computes the coefficients; `None` for a region whose feature is disabled.
    #[cfg_attr(feature = "polygon", allow(clippy::unnecessary_wraps, reason = "every region is on"))]
    pub(crate) fn new(region: &Region) -> Option<Self> {
        match *region {
            Region::Screen => Some(Self::Screen),
            Region::Rectangle { x_m, y_m, width_m, height_m } => {
                Some(Self::Rectangle(Sides::new([x_m, y_m], [width_m, height_m])))
            }
            Region::Ellipse { x_m, y_m, width_m, height_m } => Some(Self::Ellipse {
                middle_x_m: x_m + 0.5 * width_m,
                middle_y_m: y_m + 0.5 * height_m,
                per_half_width: 2.0 / width_m,
                per_half_height: 2.0 / height_m,
            }),
            #[cfg(feature = "polygon")]
            Region::Polygon { first, count } => Some(Self::Polygon { first, count }),
            #[cfg(not(feature = "polygon"))]
            Region::Polygon { .. } => None,
        }
    }

    /// Whether the finger is inside.
    #[inline]
    pub(crate) fn contains(&self, context: &Context) -> bool {
        match self {
            Self::Screen => true,
            Self::Rectangle(sides) => sides.contain(context.inputs),
            Self::Ellipse { middle_x_m, middle_y_m, per_half_width, per_half_height } => {
                let [x_m, y_m] = context.inputs.place_m;
                let x = (x_m - middle_x_m) * per_half_width;
                let y = (y_m - middle_y_m) * per_half_height;
                x * x + y * y <= 1.0
            }
            #[cfg(feature = "polygon")]
            Self::Polygon { first, count } => polygon::contains(*first, *count, context),
        }
    }

    /// Distance of the finger from the border, inwards: from the nearest side of a rectangle, along the shorter half
    /// axis of an ellipse. Zero in a region without such a border.
    #[cfg_attr(not(feature = "edge"), allow(dead_code, reason = "only buttons have a rim"))]
    #[inline]
    pub(crate) fn depth_m(&self, inputs: &Inputs) -> f32 {
        let [x_m, y_m] = inputs.place_m;
        let depth_m = match self {
            Self::Rectangle(sides) => {
                let [right, down] = sides.inside(inputs);
                let across = right.min(sides.width.saturating_sub(right));
                let depth = across.min(down).min(sides.height.saturating_sub(down));
                return depth as f32 * (1.0 / STEPS_PER_M);
            }
            Self::Ellipse { middle_x_m, middle_y_m, per_half_width, per_half_height } => {
                let x = (x_m - middle_x_m) * per_half_width;
                let y = (y_m - middle_y_m) * per_half_height;
                let shorter_per_m = if per_half_width > per_half_height { per_half_width } else { per_half_height };
                (1.0 - crate::square_root::square_root(x * x + y * y)) / shorter_per_m
            }
            #[cfg(feature = "polygon")]
            Self::Polygon { .. } => 0.0,
            Self::Screen => 0.0,
        };
        // At the border, rounding may make the depth negative.
        if depth_m > 0.0 { depth_m } else { 0.0 }
    }
}
