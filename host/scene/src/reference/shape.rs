//! The shapes of regions.

use frixel_layers::{Interval, Point, Region};

use crate::cover::Cell;

/// The shape of a layer's region, m.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Everywhere,
    /// Includes its left and top edges, excludes its right and bottom edges.
    Rectangle(Cell),
    /// Includes its border.
    Ellipse {
        middle_m: (f64, f64),
        half_axes_m: (f64, f64),
    },
    /// Even-odd rule. Includes left and top edges, excludes right and bottom ones.
    Polygon(Vec<(f64, f64)>),
}

impl Shape {
    pub(crate) fn new(region: Region, points: &[Point]) -> Self {
        match region {
            Region::Screen => Self::Everywhere,
            Region::Rectangle { x_m, y_m, width_m, height_m } => {
                Self::Rectangle(Cell::of_region(x_m, y_m, width_m, height_m))
            }
            Region::Ellipse { x_m, y_m, width_m, height_m } => {
                let half_axes_m = (0.5 * f64::from(width_m), 0.5 * f64::from(height_m));
                Self::Ellipse {
                    middle_m: (f64::from(x_m) + half_axes_m.0, f64::from(y_m) + half_axes_m.1),
                    half_axes_m,
                }
            }
            Region::Polygon { first, count } => {
                let own = points.iter().skip(usize::from(first)).take(usize::from(count));
                Self::Polygon(own.map(|point| (f64::from(point.x), f64::from(point.y))).collect())
            }
        }
    }

    pub(crate) fn covers(&self, x_m: f64, y_m: f64) -> bool {
        match self {
            Self::Everywhere => true,
            Self::Rectangle(Cell { left_m, top_m, right_m, bottom_m }) => {
                x_m >= *left_m && x_m < *right_m && y_m >= *top_m && y_m < *bottom_m
            }
            Self::Ellipse { middle_m, half_axes_m } => {
                let (x, y) = ((x_m - middle_m.0) / half_axes_m.0, (y_m - middle_m.1) / half_axes_m.1);
                x * x + y * y <= 1.0
            }
            Self::Polygon(vertices) => {
                // Count the edges to the right of the place.
                let passed = edges(vertices).filter(|((x1_m, y1_m), (x2_m, y2_m))| {
                    let between = (*y1_m > y_m) != (*y2_m > y_m);
                    between && x_m < x1_m + (y_m - y1_m) / (y2_m - y1_m) * (x2_m - x1_m)
                });
                passed.count() % 2 == 1
            }
        }
    }

    /// Left, top, right and bottom of the bounding rectangle, infinite for everywhere.
    pub(crate) fn bounds_m(&self) -> [f64; 4] {
        match self {
            Self::Everywhere => [f64::NEG_INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY],
            Self::Rectangle(Cell { left_m, top_m, right_m, bottom_m }) => [*left_m, *top_m, *right_m, *bottom_m],
            Self::Ellipse { middle_m: (x_m, y_m), half_axes_m: (a_m, b_m) } => {
                [x_m - a_m, y_m - b_m, x_m + a_m, y_m + b_m]
            }
            Self::Polygon(vertices) => {
                let x_m = Interval::of(vertices.iter().map(|(x_m, _)| *x_m));
                let y_m = Interval::of(vertices.iter().map(|(_, y_m)| *y_m));
                [x_m.low, y_m.low, x_m.high, y_m.high]
            }
        }
    }
}

/// The edges of a polygon, from each vertex to the next.
pub(crate) fn edges(vertices: &[(f64, f64)]) -> impl Iterator<Item = ((f64, f64), (f64, f64))> {
    vertices.iter().copied().zip(vertices.iter().copied().cycle().skip(1))
}
