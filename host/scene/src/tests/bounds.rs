//! Bounds of a kind's friction over a cell of the screen, and of a stack's over the screen.

use std::f32::consts::TAU;

use frixel_layers::{Interval, Layer, Record, Region, electric_friction_max_n};
use frixel_testkit::samples::samples;
use frixel_testkit::{Random, RandomScene};

use super::*;
use crate::cover::{Cell, PLACES_MAX, widened};
use crate::kinds::{Extremes, Field};
use crate::program::Bitmap;
use crate::reference::{Context, Reference};
use crate::target_range::TargetRange;

/// Cells of each sample.
const CELLS: usize = 200;
/// Places along each side of a cell.
const PLACES: usize = 33;
/// Friction below which excesses are not compared, N.
const FRICTION_MIN_N: f64 = 1e-4;
/// Largest excess of a bound over the friction found, relative to it. Stacks with a picture are not compared: its bound
/// does not depend on its samples.
const ABOVE_MAX: f64 = 0.42;
/// The same for half of the stacks: the header rounds up by as much as 1/128.
const ABOVE_MEDIAN: f64 = 0.008;

/// The range of the friction at places of a grid over the cell, its corners included.
fn found_n(field: &dyn Field, cell: Cell) -> Interval<f64> {
    let part = |number: usize| (number % PLACES) as f64 / (PLACES - 1) as f64;
    let at = |number: usize| {
        let x_m = cell.left_m + part(number) * (cell.right_m - cell.left_m);
        let y_m = cell.top_m + part(number / PLACES) * (cell.bottom_m - cell.top_m);
        field.at(&Context { x_m, y_m, ..Context::default() })
    };
    Interval::of((0..PLACES * PLACES).map(at))
}

#[test]
fn extremes_hold_all_over_a_cell() {
    for formula in samples().flat_map(|sample| sample.formulas) {
        let program = compile_text(&format!("version = 1\n{}", formula.toml)).expect(formula.name);
        let reference = Reference::new(&program);
        let mut random = Random::new(1);
        for piece in reference.pieces() {
            for _ in 0..CELLS {
                let side_m = f64::from(random.pick([3e-4_f32, 2e-3, 0.02]));
                let [left_m, top_m] = [random.between(0.0, 0.1), random.between(0.0, 0.06)].map(f64::from);
                let (right_m, bottom_m) = (left_m + side_m * f64::from(random.between(0.1, 1.0)), top_m + side_m);
                let cell = Cell { left_m, top_m, right_m, bottom_m };
                let (Extremes::Reached(extremes) | Extremes::Bounded(extremes)) = piece.extremes_in(cell);
                let found = found_n(&*piece.field, cell);
                let is_within = extremes.low <= found.low + 1e-12 && found.high <= extremes.high + 1e-12;
                assert!(is_within, "{}: {found:?} in {cell:?}, extremes {extremes:?}", formula.name);
            }
        }
    }
}

/// Random stacks of layers of all kinds.
pub(super) fn stacks() -> impl Iterator<Item = Program> {
    let empty = compile_layers("");
    let picture = Bitmap::new(3, 2, vec![0, 255, 100, 30, 0, 255]);
    (0..200).map(move |seed| {
        let RandomScene { header, records, points } = RandomScene::new(seed, picture.crc32);
        let (records, points) = (records.to_vec(), points.to_vec());
        Program { header, records, points, bitmaps: vec![picture.clone()], ..empty.clone() }
    })
}

/// The same stack without buttons, and with all regions the whole screen.
pub(super) fn everywhere(program: &Program) -> Program {
    let layers = program.records.iter().filter(|record| !matches!(record.layer, Layer::Button(_)));
    Program { records: layers.map(|record| Record { region: Region::Screen, ..*record }).collect(), ..program.clone() }
}

/// The largest friction that the header of a scene states, N.
fn bound_n(Program { header, records, points, .. }: &Program) -> f64 {
    f64::from(electric_friction_max_n(header, records, points).expect("a bound"))
}

/// The largest friction of the reference along a stroke that jumps all over the screen, N.
fn sampled_n(program: &Program, seed: u64) -> f64 {
    let mut random = Random::new(seed);
    let mut between = |low: f32, high: f32| f64::from(random.between(low, high));
    let mut stroke = Reference::new(program).along_stroke();
    let friction_n = (0..5_000).map(|number| {
        let turn = between(0.0, TAU);
        stroke.electric_friction_n(&Context {
            x_m: between(0.0, program.header.screen_width_m),
            y_m: between(0.0, program.header.screen_height_m),
            t_s: 1e-3 * f64::from(number),
            begun_s: 0.0,
            speed_m_per_s: between(0.0, 0.4),
            direction: [libm::cos(turn), libm::sin(turn)],
            stream: between(0.0, 1.0),
            stream_weight: between(0.0, 1.0).round(),
        })
    });
    friction_n.fold(0.0, f64::max)
}

#[test]
fn no_stack_asks_for_more_than_its_bound() {
    for (seed, program) in (0..).zip(stacks()) {
        for program in [&program, &everywhere(&program)] {
            let (sampled_n, bound_n) = (sampled_n(program, seed), bound_n(program));
            assert!(sampled_n <= bound_n, "stack {seed} asks for {sampled_n} N, with a bound of {bound_n} N");
        }
    }
}

/// The range reported by the compiler for the screen is at most the bound, and close to it.
#[test]
fn stacks_come_close_to_their_bounds() {
    let mut above = Vec::new();
    for (seed, program) in stacks().map(|program| everywhere(&program)).enumerate() {
        let (bound_n, nothing) = (bound_n(&program), Interval { low: 0.0, high: 0.0 });
        let found_n = widened(nothing, &program.header, Reference::new(&program).pieces(), PLACES_MAX).high;
        assert!(found_n <= bound_n, "stack {seed} is said to ask for {found_n} N, with a bound of {bound_n} N");
        let has_picture = program.records.iter().any(|record| record.layer.bitmap_crc32().is_some());
        if found_n > FRICTION_MIN_N && !has_picture {
            above.push(bound_n / found_n - 1.0);
        }
    }
    above.sort_by(f64::total_cmp);
    let [median, largest] = [above[above.len() / 2], above[above.len() - 1]];
    assert!(above.len() > 100 && median <= ABOVE_MEDIAN && largest <= ABOVE_MAX, "{median}, at most {largest}");
}

/// Stripes as wide as the places of the screen that are evaluated, each of them in the middle of a stripe's rise.
#[test]
fn a_target_range_has_what_lies_between_its_places() {
    let stripes = "[[layer]]\nkind = \"grating\"\nwavelength_mm = 0.2\nphase_deg = 180\nlow_n = 0.005\nhigh_n = 0.02\n";
    let TargetRange { least_n, most_n, .. } = TargetRange::of(&compile_layers(stripes));
    assert!((least_n - 0.255).abs() < 1e-6 && (most_n - 0.27).abs() < 1e-6, "{least_n} to {most_n}");
}
