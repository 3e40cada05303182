//! Random layers of every kind and form, in regions of every shape.

use frixel_layers::{Blend, Click, Constant, Header, Layer, Point, Record, Region};
use frixel_wire::scene::POLYGON_POINTS_MAX;

use crate::random::Random;
use crate::samples::{Draw, NewPoints, samples};

/// Largest electric friction for the finger of these scenes, N.
const REACH_N: f32 = 0.027;

/// Constant friction on the whole screen, for layers above to act on.
pub(crate) fn ground(random: &mut Random) -> Record {
    let layer = Layer::Constant(Constant { electric_friction_n: REACH_N * random.between(0.02, 0.6) });
    Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer }
}

/// A random layer above others; its points are added to `points`.
pub(crate) fn record(random: &mut Random, header: &Header, picture: u32, points: &mut NewPoints) -> Record {
    let blend = random.pick([Blend::Replace, Blend::Add, Blend::Add, Blend::Multiply, Blend::Max]);
    let amount = if blend == Blend::Multiply { factor } else { friction_n };
    let layer = layer(random, header, amount, picture, points);
    let region =
        if matches!(layer, Layer::Button(_)) { box_region(random, header) } else { region(random, header, points) };
    let gain = random.pick([1.0, 1.0, 1.0, 0.5, 0.7, 0.9, 1.7, -0.3, 0.0]);
    Record { region, blend, gain, layer }
}

/// Mostly within reach, and occasionally far beyond, below zero, or tiny.
fn friction_n(random: &mut Random) -> f32 {
    REACH_N * factor(random)
}

/// Mostly from 0 to 1, and occasionally far beyond, below zero, or tiny.
fn factor(random: &mut Random) -> f32 {
    match random.below(30) {
        0 => 0.0,
        1 => random.between(-1.0, 0.0),
        2 => random.between(1.0, 40.0),
        3 => random.between(0.0, 1e-4),
        _ => random.between(0.0, 1.0),
    }
}

/// A layer of any kind.
fn layer(
    random: &mut Random,
    header: &Header,
    amount: fn(&mut Random) -> f32,
    picture: u32,
    points: &mut NewPoints,
) -> Layer {
    let [one, other] = [amount(random), amount(random)];
    let click = Click { height_n: random.pick([0.0, one, other]), decay_s: random.pick([0.0, 1e-4, 0.02, 1.0]) };
    let turned = random.between(-1.0, 1.0);
    let number = random.below(samples().count() as u32) as usize;
    let mut draw = Draw { random, header, picture, amounts: [one, other], click, turned, amount, points };
    match samples().nth(number) {
        Some(sample) => (sample.random)(&mut draw),
        None => Layer::Constant(Constant { electric_friction_n: one }),
    }
}

fn region(random: &mut Random, header: &Header, points: &mut NewPoints) -> Region {
    match random.below(5) {
        0 => Region::Screen,
        1 => {
            let count = random.pick([3, 4, 5, 7, 10, 16, POLYGON_POINTS_MAX as u32]);
            let [width_m, height_m] = [header.screen_width_m, header.screen_height_m];
            // At any height, so that edges cross; some points are level with one another.
            let level_m = random.between(0.0, 1.0) * height_m;
            let vertices = (0..count).map(|_| Point {
                x: random.between(-0.2, 1.2) * width_m,
                y: if random.once_in(4) { level_m } else { random.between(-0.2, 1.2) * height_m },
            });
            let added = points.add(vertices);
            Region::Polygon { first: added.start, count: added.len() as u8 }
        }
        _ => box_region(random, header),
    }
}

/// From a hundredth of the screen to more than all of it, also beyond its edges.
fn box_region(random: &mut Random, header: &Header) -> Region {
    let mut along = |screen_m: f32| {
        let size_m = screen_m * random.pick([0.01, 0.1, 0.5, 0.9, 1.5]);
        (random.between(-0.5 * size_m, screen_m - 0.5 * size_m), size_m)
    };
    let ((x_m, width_m), (y_m, height_m)) = (along(header.screen_width_m), along(header.screen_height_m));
    if random.once_in(3) {
        Region::Ellipse { x_m, y_m, width_m, height_m }
    } else {
        Region::Rectangle { x_m, y_m, width_m, height_m }
    }
}
