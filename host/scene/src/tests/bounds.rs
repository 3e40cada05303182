//! Bounds of a kind's friction over a cell of the screen, from the samples of all kinds.

use frixel_layers::Interval;
use frixel_testkit::Random;
use frixel_testkit::samples::samples;

use super::*;
use crate::cover::Cell;
use crate::kinds::Field;
use crate::reference::{Context, Reference};

/// Cells of each sample.
const CELLS: usize = 200;
/// Places along each side of a cell.
const PLACES: usize = 33;

/// The range of the friction at places of a grid over the cell, its corners included.
fn found_n(field: &dyn Field, cell: Cell) -> Interval<f64> {
    let part = |number: usize| (number % PLACES) as f64 / (PLACES - 1) as f64;
    let at = |number: usize| {
        let x_m = cell.left_m + part(number) * (cell.right_m - cell.left_m);
        let y_m = cell.top_m + part(number / PLACES) * (cell.bottom_m - cell.top_m);
        field.at(&Context { x_m, y_m, ..Context::default() })
    };
    let all = (0..PLACES * PLACES).map(at).map(|friction_n| Interval::of([friction_n]));
    all.reduce(Interval::hull).expect("places")
}

#[test]
fn bounds_hold_all_over_a_cell() {
    for formula in samples().flat_map(|sample| sample.formulas) {
        let program = compile_text(&format!("version = 1\n{}", formula.words)).expect(formula.name);
        let reference = Reference::new(&program);
        let mut random = Random::new(1);
        for piece in reference.pieces() {
            for _ in 0..CELLS {
                let side_m = f64::from(random.pick([3e-4_f32, 2e-3, 0.02]));
                let [left_m, top_m] = [random.between(0.0, 0.1), random.between(0.0, 0.06)].map(f64::from);
                let (right_m, bottom_m) = (left_m + side_m * f64::from(random.between(0.1, 1.0)), top_m + side_m);
                let cell = Cell { left_m, top_m, right_m, bottom_m };
                let (found, bounds) = (found_n(&*piece.field, cell), piece.field.interval_in(cell));
                let is_within = bounds.low <= found.low + 1e-12 && found.high <= bounds.high + 1e-12;
                assert!(is_within, "{}: {found:?} in {cell:?}, bounds {bounds:?}", formula.name);
            }
        }
    }
}
