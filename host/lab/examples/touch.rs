//! A custom touch source: places from any pointer, with the rate, latency and losses of a measured touchscreen. Prints
//! the error of the felt friction with it and with a bundled source.
//!
//! ```sh
//! cargo run -p frixel-lab --example touch
//! ```
#![allow(clippy::print_stdout, reason = "it is a program")]

use std::collections::BTreeMap;
use std::error::Error;
use std::f64::consts::TAU;

use frixel_hil_sim::{Point, RigConfig, Stroke, TouchConfig};
use frixel_play::{Simulation, TO_THE_END, simulate};
use frixel_scene::{Scene, compile};

const SCENE: &str = "version = 1\n[[layer]]\nkind = \"grating\"\nwavelength_mm = 10\nlow_n = 0.0\nhigh_n = 0.1\n";
/// Time between two places of the pointer, s.
const PERIOD_S: f64 = 2e-3;
const SECONDS: f64 = 2.0;

/// The places of a pointer: here a finger that goes back and forth once a second, and is lifted for 0.2 s in between.
fn places() -> Vec<(f64, Option<Point>)> {
    let place = |number: u32| {
        let t_s = PERIOD_S * f64::from(number);
        let is_down = !(0.9..1.1).contains(&t_s);
        (t_s, is_down.then(|| Point { x_m: 0.06 - 0.04 * (TAU * t_s).cos(), y_m: 0.04 }))
    };
    (0..=(SECONDS / PERIOD_S) as u32).map(place).collect()
}

/// Root mean square of felt minus reference friction under the finger with this touch source, mN.
fn error_mn(touch: TouchConfig) -> Result<f64, Box<dyn Error>> {
    let mut rig = RigConfig::default();
    rig.world.touch = touch;
    let scene = Scene::parse(SCENE, "grating.toml", &BTreeMap::<String, Vec<u8>>::new())?;
    let program = compile(&scene, &rig.board.limits, rig.board.tick_hz)?;
    let simulation = Simulation::of_stroke(rig, Stroke::through(&places())?, 1);
    let error = simulate(&program, &simulation, None, TO_THE_END)?.recorder.summary().friction_error;
    Ok(1e3 * error.ok_or("the finger was never down")?.rms_n)
}

fn main() -> Result<(), Box<dyn Error>> {
    // As measured with a camera: 250 reports a second, 4 ms late, steps of 0.1 mm, one report in fifty lost.
    let own = TouchConfig {
        rate_hz: 250.0,
        latency_s: 4e-3,
        jitter_rms_s: 0.2e-3,
        step_m: 0.1e-3,
        lost_share: 0.02,
        ..TouchConfig::IDEAL
    };
    let bundled = TouchConfig::bundled("100").ok_or("there is no such source")?;
    for (name, touch) in [("own", own), ("100", bundled)] {
        println!("{name}: {:.1} mN rms error", error_mn(touch)?);
    }
    Ok(())
}
