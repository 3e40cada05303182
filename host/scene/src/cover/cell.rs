//! Cells of the screen, and the part of a cell that a layer covers.

use crate::reference::{Shape, edges};

/// A rectangle of the screen, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    pub(crate) left_m: f64,
    pub(crate) top_m: f64,
    pub(crate) right_m: f64,
    pub(crate) bottom_m: f64,
}

/// Coverage of a cell by a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Coverage {
    None,
    Part,
    Whole,
}

impl Cell {
    /// The rectangle of a region, from its top left corner.
    pub(crate) fn of_region(x_m: f32, y_m: f32, width_m: f32, height_m: f32) -> Self {
        let (left_m, top_m) = (f64::from(x_m), f64::from(y_m));
        Self { left_m, top_m, right_m: left_m + f64::from(width_m), bottom_m: top_m + f64::from(height_m) }
    }

    pub(crate) fn corners(self) -> [(f64, f64); 4] {
        let Self { left_m, top_m, right_m, bottom_m } = self;
        [(left_m, top_m), (right_m, top_m), (left_m, bottom_m), (right_m, bottom_m)]
    }

    pub(crate) fn middle(self) -> (f64, f64) {
        (f64::midpoint(self.left_m, self.right_m), f64::midpoint(self.top_m, self.bottom_m))
    }

    /// The point of the cell nearest to a place.
    pub(crate) fn nearest_to(self, x_m: f64, y_m: f64) -> (f64, f64) {
        (x_m.clamp(self.left_m, self.right_m), y_m.clamp(self.top_m, self.bottom_m))
    }

    /// Whether the line from one place to another crosses the inside of the cell.
    fn is_crossed(self, (x1_m, y1_m): (f64, f64), (x2_m, y2_m): (f64, f64)) -> bool {
        // The part of the line, from 0 to 1, that lies between opposite sides.
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (start, end, low, high) in
            [(x1_m, x2_m, self.left_m, self.right_m), (y1_m, y2_m, self.top_m, self.bottom_m)]
        {
            let step = end - start;
            if step.abs() > 0.0 {
                let (one, other) = ((low - start) / step, (high - start) / step);
                from = from.max(one.min(other));
                to = to.min(one.max(other));
            } else if start <= low || start >= high {
                return false;
            }
        }
        from < to
    }
}

impl Coverage {
    pub(super) fn of(shape: &Shape, cell: Cell) -> Self {
        let (x_m, y_m) = cell.middle();
        let middle = shape.covers(x_m, y_m);
        match shape {
            // Cells are cut along the edges of rectangles, so no rectangle's edge crosses a cell.
            Shape::Everywhere | Shape::Rectangle(_) => {
                if middle {
                    Self::Whole
                } else {
                    Self::None
                }
            }
            Shape::Ellipse { middle_m, .. } => {
                let nearest = cell.nearest_to(middle_m.0, middle_m.1);
                if cell.corners().into_iter().all(|(x_m, y_m)| shape.covers(x_m, y_m)) {
                    Self::Whole
                } else if shape.covers(nearest.0, nearest.1) {
                    Self::Part
                } else {
                    Self::None
                }
            }
            Shape::Polygon(vertices) => {
                if edges(vertices).any(|(from, to)| cell.is_crossed(from, to)) {
                    Self::Part
                } else if middle {
                    Self::Whole
                } else {
                    Self::None
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CELL: Cell = Cell { left_m: 1.0, top_m: 1.0, right_m: 3.0, bottom_m: 2.0 };

    #[test]
    fn polygons_cover_all_some_or_nothing() {
        for (vertices, expected) in [
            (vec![(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)], Coverage::Whole),
            (vec![(1.0, 1.0), (3.0, 1.0), (3.0, 2.0), (1.0, 2.0)], Coverage::Whole),
            (vec![(0.0, 0.0), (9.0, 0.0), (0.0, 9.0)], Coverage::Whole),
            (vec![(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)], Coverage::Part),
            (vec![(2.0, 1.2), (2.2, 1.4), (1.9, 1.5)], Coverage::Part),
            (vec![(0.0, 1.4), (5.0, 1.45), (5.0, 1.5)], Coverage::Part),
            (vec![(3.0, 0.0), (4.0, 0.0), (4.0, 4.0), (3.0, 4.0)], Coverage::None),
            (vec![(0.0, 0.0), (2.0, 0.5), (3.5, 0.9), (4.0, 0.0)], Coverage::None),
        ] {
            assert_eq!(Coverage::of(&Shape::Polygon(vertices.clone()), CELL), expected, "{vertices:?}");
        }
    }

    #[test]
    fn ellipses_cover_all_some_or_nothing() {
        for (middle_m, half_axes_m, expected) in [
            ((2.0, 1.5), (2.0, 1.0), Coverage::Whole),
            ((2.0, 1.5), (1.0, 0.5), Coverage::Part),
            ((0.0, 1.5), (1.5, 0.2), Coverage::Part),
            ((0.0, 0.0), (1.3, 1.3), Coverage::None),
        ] {
            assert_eq!(Coverage::of(&Shape::Ellipse { middle_m, half_axes_m }, CELL), expected);
        }
    }
}
