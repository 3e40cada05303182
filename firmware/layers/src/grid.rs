//! A coarse grid over the screen: each cell has a bit for each layer that may act there. It allows a tick to evaluate
//! only the layers near the finger, and compiler and board to find the place with the highest cost.

use core::ops::RangeInclusive;

use crate::point::{Point, points_of};
use crate::region::Region;

/// Number of columns, and of rows, of the grid.
const SIDE: usize = 16;

/// A set of layers with a bit for each: layers 0 to 31, then layers 32 to 63.
pub type LayerSet = [u32; 2];

/// The layers that may act in each cell of the screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    columns_per_m: f32,
    rows_per_m: f32,
    cells: [LayerSet; SIDE * SIDE],
}

/// A cell of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Its centre, in m from the screen's left edge.
    pub x_m: f32,
    /// Its centre, in m from the screen's top edge.
    pub y_m: f32,
    /// The layers that may act there.
    pub layers: LayerSet,
}

impl Cell {
    /// Whether layer number `layer` may act there.
    pub fn has(&self, layer: u8) -> bool {
        let [first, others] = self.layers;
        let layers = u64::from(first) | u64::from(others) << u32::BITS;
        layers.checked_shr(u32::from(layer)).is_some_and(|from_it_on| from_it_on & 1 != 0)
    }
}

/// The set of the layers with these numbers. Numbers from 64 on are ignored.
pub fn layer_set(numbers: impl Iterator<Item = usize>) -> LayerSet {
    numbers.fold([0; 2], |[first, others], number| match number as u32 {
        number @ 0..32 => [first | 1 << number, others],
        number @ 32..64 => [first, others | 1 << (number - u32::BITS)],
        _ => [first, others],
    })
}

/// The numbers of the layers in a set, in ascending order.
pub fn layer_numbers([first, others]: LayerSet) -> impl Iterator<Item = usize> + Clone {
    let mut rest = u64::from(first) | u64::from(others) << u32::BITS;
    core::iter::from_fn(move || {
        let number = (rest != 0).then_some(rest.trailing_zeros() as usize);
        rest &= rest.wrapping_sub(1);
        number
    })
}

impl Grid {
    /// Number of cells.
    pub const CELLS: usize = SIDE * SIDE;

    /// A grid without layers, on a screen of size zero.
    pub const EMPTY: Self = Self { columns_per_m: 0.0, rows_per_m: 0.0, cells: [[0; 2]; SIDE * SIDE] };

    /// Removes all layers, and sets the size of the screen, in m.
    pub fn reset(&mut self, screen_width_m: f32, screen_height_m: f32) {
        self.columns_per_m = SIDE as f32 / screen_width_m;
        self.rows_per_m = SIDE as f32 / screen_height_m;
        self.cells.fill([0; 2]);
    }

    /// Adds layer `layer`, below 64, to every cell that its region may touch; `points` are the scene's. Places off the
    /// screen belong to the border cells.
    pub fn add(&mut self, layer: u8, region: &Region, points: &[Point]) {
        let bit = 1_u64.checked_shl(u32::from(layer)).unwrap_or(0);
        let bits = [bit as u32, (bit >> 32) as u32];
        let (columns, rows) = match *region {
            Region::Polygon { first, count } => {
                let vertices = points_of(points, first, count).iter();
                (
                    ends(vertices.clone().map(|vertex| index(vertex.x * self.columns_per_m))),
                    ends(vertices.map(|vertex| index(vertex.y * self.rows_per_m))),
                )
            }
            Region::Rectangle { x_m, y_m, width_m, height_m } | Region::Ellipse { x_m, y_m, width_m, height_m } => (
                // Both ends are computed like the finger's cell, so that rounding never misses a cell.
                index(x_m * self.columns_per_m)..=index((x_m + width_m) * self.columns_per_m),
                index(y_m * self.rows_per_m)..=index((y_m + height_m) * self.rows_per_m),
            ),
            Region::Screen => (0..=SIDE - 1, 0..=SIDE - 1),
        };
        for row in rows {
            for column in columns.clone() {
                if let Some(cell) = self.cells.get_mut(row * SIDE + column) {
                    *cell = join(*cell, bits);
                }
            }
        }
    }

    /// The layers that may act at a place, in m.
    #[inline]
    pub fn at(&self, x_m: f32, y_m: f32) -> LayerSet {
        let cell = index(y_m * self.rows_per_m) * SIDE + index(x_m * self.columns_per_m);
        self.cells.get(cell).copied().unwrap_or_default()
    }

    /// All cells, row by row.
    pub fn cells(&self) -> impl Iterator<Item = Cell> {
        self.cells.iter().enumerate().map(|(number, &layers)| Cell {
            x_m: ((number % SIDE) as f32 + 0.5) / self.columns_per_m,
            y_m: ((number / SIDE) as f32 + 0.5) / self.rows_per_m,
            layers,
        })
    }
}

fn join([first, others]: LayerSet, [more_first, more_others]: LayerSet) -> LayerSet {
    [first | more_first, others | more_others]
}

/// The range from the least to the largest of some indices.
fn ends(indices: impl Iterator<Item = usize> + Clone) -> RangeInclusive<usize> {
    indices.clone().min().unwrap_or_default()..=indices.max().unwrap_or_default()
}

/// Column or row of a place in units of cells, clamped to the grid.
#[inline]
fn index(place_cells: f32) -> usize {
    (place_cells as i32).clamp(0, SIDE as i32 - 1) as usize
}
