//! The grid loses no layer.

use frixel_layers::{Cell, Grid, Point, Region};
use proptest::prelude::*;

#[test]
fn cells_have_their_centres() {
    let mut grid = Grid::EMPTY;
    grid.reset(0.16, 0.32);
    grid.add(40, &Region::Rectangle { x_m: 0.021, y_m: 0.041, width_m: 0.008, height_m: 0.018 }, &[]);
    let found: Vec<Cell> = grid.cells().filter(|cell| cell.layers != [0, 0]).collect();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].layers, [0, 1 << 8]);
    assert!((found[0].x_m - 0.025).abs() < 1e-6 && (found[0].y_m - 0.05).abs() < 1e-6, "{found:?}");
}

proptest! {
    /// A place inside a region is always in one of its cells, on the screen or off it.
    #[test]
    fn no_layer_is_lost(
        (width_m, height_m) in (1e-3_f32..2.0, 1e-3_f32..2.0),
        (x_m, y_m) in (-2.0_f32..2.0, -2.0_f32..2.0),
        (region_width_m, region_height_m) in (1e-6_f32..2.0, 1e-6_f32..2.0),
        (along, down) in (0.0_f32..=1.0, 0.0_f32..=1.0),
        layer in 0_u8..64,
    ) {
        let mut grid = Grid::EMPTY;
        grid.reset(width_m, height_m);
        grid.add(layer, &Region::Rectangle { x_m, y_m, width_m: region_width_m, height_m: region_height_m }, &[]);
        let [first, others] = grid.at(
            (x_m + along * region_width_m).clamp(x_m, x_m + region_width_m),
            (y_m + down * region_height_m).clamp(y_m, y_m + region_height_m),
        );
        prop_assert_eq!(u64::from(first) | u64::from(others) << 32, 1 << layer);
    }

    /// A place between two vertices of a polygon is always in one of the polygon's cells.
    #[test]
    fn no_polygon_is_lost(
        vertices in prop::collection::vec((-0.5_f32..1.5, -0.5_f32..1.5), 3..=32),
        (one, other) in (any::<prop::sample::Index>(), any::<prop::sample::Index>()),
        part in 0.0_f32..=1.0,
    ) {
        let points: Vec<Point> = [(9.0, 9.0)].iter().chain(&vertices).map(|&(x, y)| Point { x, y }).collect();
        let mut grid = Grid::EMPTY;
        grid.reset(1.0, 1.0);
        grid.add(3, &Region::Polygon { first: 1, count: vertices.len() as u8 }, &points);
        let ((x1, y1), (x2, y2)) = (vertices[one.index(vertices.len())], vertices[other.index(vertices.len())]);
        let between = |one: f32, other: f32| (one + part * (other - one)).clamp(one.min(other), one.max(other));
        prop_assert_eq!(grid.at(between(x1, x2), between(y1, y2)), [1 << 3, 0]);
    }
}
