//! Streams the values of a closure to a layer of a scene, as fast as the board plays them:
//!
//! ```sh
//! cargo run -p frixel-lab --example stream
//! ```
//!
//! The feed asks ahead, for up to 2,048 samples, before the board has room for them. So a closure knows how many
//! samples it gave, and not how many have been felt.
#![allow(clippy::print_stdout, reason = "it is a program")]

use std::cell::Cell;
use std::collections::BTreeMap;
use std::error::Error;
use std::f64::consts::TAU;
use std::rc::Rc;

use frixel_hil_sim::{Point, RigConfig, Stroke};
use frixel_play::Feed;
use frixel_play::{Simulation, TO_THE_END, simulate};
use frixel_scene::{Scene, compile};

const SCENE: &str = "version = 1\n[[layer]]\nkind = \"stream\"\nlow_n = 0.0\nhigh_n = 0.1\n";
const SAMPLE_HZ: u32 = 2000;
/// Half a second.
const SAMPLES: u32 = 1000;
/// Frequency of the friction, Hz.
const TONE_HZ: f64 = 20.0;

/// A sample from 0, the layer's low friction, to 65,535, its high one.
fn sample(number: u32) -> u16 {
    let t_s = f64::from(number) / f64::from(SAMPLE_HZ);
    (65_535.0 * (0.5 - 0.5 * (TAU * TONE_HZ * t_s).cos())).round() as u16
}

fn main() -> Result<(), Box<dyn Error>> {
    let rig = RigConfig::default();
    let scene = Scene::parse(SCENE, "stream.toml", &BTreeMap::<String, Vec<u8>>::new())?;
    let program = compile(&scene, &rig.board.limits, rig.board.tick_hz)?;
    let stroke = Stroke::constant_speed(Point { x_m: 0.01, y_m: 0.04 }, Point { x_m: 0.11, y_m: 0.04 }, 0.1)?;

    let given = Rc::new(Cell::new(0));
    let count = Rc::clone(&given);
    let feed = Feed::fetched(SAMPLE_HZ, move |samples, wanted| {
        while samples.len() < wanted && count.get() < SAMPLES {
            samples.push(sample(count.get()));
            count.set(count.get() + 1);
        }
        Ok(count.get() < SAMPLES)
    });
    let simulation = Simulation::of_stroke(rig, stroke, 1);
    let played = simulate(&program, &simulation, Some(feed), TO_THE_END)?;

    let status = played.stream.ok_or("nothing was streamed")?;
    println!("the closure gave {} samples, the board took {}", given.get(), status.sent);
    println!("{} underruns, {} gaps", status.underruns, status.gaps);
    let commanded_n: Vec<f64> = played.recorder.rows().iter().filter_map(|row| row.commanded_n).collect();
    let most_n = commanded_n.iter().copied().fold(0.0, f64::max);
    println!("commanded at most {:.0} mN", 1e3 * most_n);
    Ok(())
}
