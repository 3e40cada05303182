//! A finger at rest and a slow one, under touch sources with noise, steps and losses.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use crate::script;

use frixel_hil_sim::{Point, RigConfig, Stroke, TouchConfig};
use script::{HEADER, Script, constant, scene};

/// Long enough for the first ramp down: 50 ms of standstill, 10 ms of ramp, and the latency of the source.
const SETTLE_TICKS: u64 = 6_000;
const MEASURED_TICKS: u64 = 60_000;
const SEEDS: u64 = 12;

/// Reports at 60 Hz with the noise of [`TouchConfig::IDEAL`].
const SLOW_SOURCE: TouchConfig = TouchConfig { rate_hz: 60.0, ..TouchConfig::IDEAL };

/// Shares of the time in which a plate of constant friction drives the finger of `stroke`, one for each seed.
fn driven_shares(touch: TouchConfig, stroke: impl Fn(u64) -> Stroke) -> Vec<f64> {
    (0..SEEDS)
        .map(|seed| {
            let mut config = RigConfig::default();
            config.world.touch = touch;
            let mut script = Script::new(&config, stroke(seed), seed);
            script.play(&scene(&HEADER, &[constant(0.02)]));
            script.run(SETTLE_TICKS);
            let mut driven = 0_u64;
            for _ in 0..MEASURED_TICKS / 1_000 {
                // With it, the host's ping, which takes some ticks.
                script.run(1);
                driven += (0..1_000).filter(|_| script.step().status.telemetry.dac_code != 0).count() as u64;
            }
            driven as f64 / MEASURED_TICKS as f64
        })
        .collect()
}

/// Places that differ within a step of the source.
fn place(seed: u64) -> Point {
    Point { x_m: 0.03 + 0.173e-3 * seed as f64, y_m: 0.04 + 0.071e-3 * seed as f64 }
}

fn resting(seed: u64) -> Stroke {
    Stroke::still(place(seed), 10.0).unwrap()
}

fn sliding(speed_m_per_s: f64) -> impl Fn(u64) -> Stroke {
    move |seed| {
        let from = place(seed);
        let to = Point { x_m: from.x_m + 0.05, ..from };
        Stroke::constant_speed(from, to, speed_m_per_s).unwrap()
    }
}

#[test]
fn a_finger_at_rest_is_not_driven_unless_its_source_jumps_between_pixels() {
    for touch in [TouchConfig::IDEAL, SLOW_SOURCE] {
        let shares = driven_shares(touch, resting);
        assert!(shares.iter().all(|share| *share < 0.01), "{} Hz: {shares:?}", touch.rate_hz);
    }
    let shares = driven_shares(TouchConfig::REALISTIC, resting);
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    println!("driven at rest under steps of 0.18 mm: {mean:.3}");
    assert!(mean < 0.48, "steps of 0.18 mm: {shares:?}");
}

#[test]
fn a_slow_slide_is_driven_all_the_time() {
    for touch in [TouchConfig::IDEAL, SLOW_SOURCE] {
        for speed_m_per_s in [6e-3, 20e-3] {
            let shares = driven_shares(touch, sliding(speed_m_per_s));
            assert!(shares.iter().all(|share| *share > 0.99), "{speed_m_per_s} m/s: {shares:?}");
        }
    }
    // A pause of the source is a time without output; 0.94 is the seed with the longest.
    let shares = driven_shares(TouchConfig::REALISTIC, sliding(6e-3));
    assert!(shares.iter().all(|share| *share > 0.93), "{shares:?}");
}
