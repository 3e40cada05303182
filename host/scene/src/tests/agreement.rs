//! Boards evaluate a scene as the reference does.

use std::f32::consts::TAU;

use frixel_layers::{ActiveLayers, BitmapPool, Clicks, Inputs, StoredBitmap, StreamSample};
use frixel_testkit::Random;

use super::TICK_HZ;
use super::bounds::{everywhere, stacks};
use crate::Program;
use crate::reference::{Context, Reference, direction_of};

const TICKS: u32 = 2_000;
/// Largest difference, as a part of the stack's largest friction.
const DIFFERENCE_MAX: f64 = 1e-3;
/// Most of the 800,000 ticks at which board and reference may be on opposite sides of a jump. A square vibration whose
/// period is a whole number of ticks jumps on a tick.
const JUMPS_MAX: usize = 400;

/// Friction of the board and of the reference, N, under a finger that slides all over the screen and beyond its edges.
fn frictions_n(program: &Program, seed: u64) -> Vec<[f64; 2]> {
    let pool = Box::new(BitmapPool::new());
    let mut stored = Vec::new();
    for bitmap in &program.bitmaps {
        pool.write(0, &bitmap.samples);
        let (crc32, width, height) = (bitmap.crc32, bitmap.width, bitmap.height);
        stored.push(StoredBitmap { crc32, offset: 0, width, height });
    }
    let mut layers = Box::new(ActiveLayers::EMPTY);
    layers.begin(&program.header, program.points.iter().copied());
    for record in &program.records {
        let find_bitmap = |crc32| stored.iter().find(|bitmap| bitmap.crc32 == crc32).copied();
        layers.push(record, TICK_HZ, &find_bitmap).expect("a layer");
    }
    let mut clicks = Clicks::NONE;
    let mut reference = Reference::new(program).along_stroke();
    let mut random = Random::new(seed);
    let size_m = [program.header.screen_width_m, program.header.screen_height_m];
    let mut ends = [[0.0; 2]; 2];
    let mut velocity_m_per_s = [0.0; 2];
    let frictions = (0..TICKS).map(|tick| {
        let passed = (tick % 100) as f32 / 100.0;
        if tick % 100 == 0 {
            ends = [ends[1], size_m.map(|size_m| random.between(-0.05, 1.05) * size_m)];
            let (speed, turn) = (random.pick([0.0, 0.01, 0.1, 0.4]), random.between(0.0, TAU));
            velocity_m_per_s = [speed * turn.cos(), speed * turn.sin()];
        }
        let place_m = [0, 1].map(|axis| ends[0][axis] + passed * (ends[1][axis] - ends[0][axis]));
        let stream = StreamSample { value: random.between(0.0, 1.0), weight: random.pick([0.0, 0.3, 1.0]) };
        let mut inputs = Inputs::default();
        (inputs.velocity_m_per_s, inputs.stream) = (velocity_m_per_s, stream);
        inputs.set_place(place_m, tick);
        let found_n = layers.electric_friction_n(&inputs, &pool, &mut clicks);
        let [x_m, y_m] = place_m.map(f64::from);
        let velocity = velocity_m_per_s.map(f64::from);
        let expected_n = reference.electric_friction_n(&Context {
            x_m,
            y_m,
            t_s: f64::from(tick) / f64::from(TICK_HZ),
            begun_s: 0.0,
            speed_m_per_s: velocity[0].hypot(velocity[1]),
            direction: direction_of(velocity),
            stream: f64::from(stream.value),
            stream_weight: f64::from(stream.weight),
        });
        [f64::from(found_n), expected_n]
    });
    frictions.collect()
}

#[test]
fn boards_evaluate_random_stacks_as_the_reference_does() {
    let mut jumps = 0;
    for (seed, program) in (0..).zip(stacks()) {
        for program in [&program, &everywhere(&program)] {
            let frictions_n = frictions_n(program, seed);
            let largest_n = frictions_n.iter().map(|[_, expected_n]| expected_n.abs()).fold(0.0, f64::max);
            let difference_max_n = DIFFERENCE_MAX * largest_n;
            let is_away = |[found_n, expected_n]: &&[f64; 2]| !((found_n - expected_n).abs() <= difference_max_n);
            jumps += frictions_n.iter().filter(is_away).count();
        }
    }
    assert!(jumps <= JUMPS_MAX, "{jumps}");
}
