//! How long a tick of the world takes, by stroke: `cargo run --release -p frixel-hil-sim --example world_speed`.
//!
//! A square carrier of 1 kHz drives the ideal and the realistic world for a minute of virtual time. The sum of the
//! friction is printed so that the compiler cannot remove the work.
#![allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "it measures wall time")]

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use frixel_control::Drive;
use frixel_hil_sim::{Point, Stroke, World, WorldConfig, WorldOptions};
use frixel_wire::dac_code::DacCode;

const SECONDS: f64 = 60.0;

fn main() -> Result<(), Box<dyn Error>> {
    let left = Point { x_m: 0.0, y_m: 0.03 };
    let right = Point { x_m: 0.1 * SECONDS, y_m: 0.03 };
    let strokes = [
        ("constant speed", Stroke::constant_speed(left, right, 0.1)?),
        ("minimum jerk", Stroke::minimum_jerk(left, right, SECONDS)?),
        ("sweep", Stroke::sweep(0.1, 0.06, SECONDS)?),
        ("rows, 1 kHz", Stroke::through(&rows(SECONDS))?),
    ];
    for (name, stroke) in strokes {
        for (world, config) in
            [("ideal", WorldConfig::IDEAL), ("realistic", WorldConfig::IDEAL.with(&WorldOptions::default()))]
        {
            measure(&format!("{world}, {name}"), World::new(config, stroke.clone(), 1)?);
        }
    }
    Ok(())
}

fn measure(name: &str, mut world: World) {
    world.start_stroke();
    let ticks = (SECONDS * f64::from(WorldConfig::IDEAL.tick_hz)) as u64;
    let begin = Instant::now();
    let mut friction_n = 0.0;
    for tick in 0..ticks {
        black_box(world.sense());
        let dac_code = if (tick / 20).is_multiple_of(2) { 25_000 } else { -25_000 };
        friction_n +=
            world.apply(black_box(Drive { dac_code: DacCode::from_bits(dac_code), amplifier_enable: true })).friction_n;
    }
    let wall_s = begin.elapsed().as_secs_f64();
    println!(
        "{name:23} {:5.1} ns a tick, {:4.0} times real time, mean friction {:.6} N",
        1e9 * wall_s / ticks as f64,
        SECONDS / wall_s,
        friction_n / ticks as f64
    );
}

/// A finger that goes round in zigzags, a row every millisecond.
fn rows(seconds: f64) -> Vec<(f64, Option<Point>)> {
    let place = |row: u32| {
        let x_m = f64::from((row % 1600).min(1600 - row % 1600)) * 1e-4;
        (f64::from(row) * 1e-3, Some(Point { x_m, y_m: 0.03 }))
    };
    (0..=(seconds * 1000.0) as u32).map(place).collect()
}
