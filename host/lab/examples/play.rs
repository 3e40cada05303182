//! Plays a scene file on the simulated board, under a simulated finger, in virtual time:
//!
//! ```sh
//! cargo run -p frixel-lab --example play scenes/brick.toml
//! ```
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "it is a program")]

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;
use std::{env, fs};

use frixel_hil_sim::{RigConfig, WorldOptions};
use frixel_lab::input::SceneFolder;
use frixel_lab::simulate::default_stroke;
use frixel_play::{Simulation, TO_THE_END, simulate};
use frixel_scene::{Scene, compile};

fn main() -> ExitCode {
    match play() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn play() -> Result<(), Box<dyn Error>> {
    let path = PathBuf::from(env::args().nth(1).ok_or("give the path of a scene, for example scenes/brick.toml")?);
    let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let scene = Scene::parse(&bytes, &path.display().to_string(), &SceneFolder::of(&path))?;

    // A program is compiled for the limits of one board: here the simulated one, in a world with noise and losses.
    let rig = RigConfig::default().with(&WorldOptions::default());
    let program = compile(&scene, &rig.board.limits, rig.board.tick_hz)?;
    let stroke = default_stroke(&program, None)?;
    let ticks_per_row = rig.board.tick_hz / 1000;
    let simulation = Simulation { ticks_per_row, ..Simulation::of_stroke(rig, stroke, 1) };
    let played = simulate(&program, &simulation, None, TO_THE_END)?;

    let rows = played.recorder.rows();
    let felt_n: Vec<f64> = rows.iter().filter_map(|row| row.felt_n).collect();
    let mean_n = felt_n.iter().sum::<f64>() / felt_n.len() as f64;
    let error = played.recorder.summary().friction_error.ok_or("the finger was never on the screen")?;
    println!("{} rows of a millisecond, {} layers", rows.len(), program.records.len());
    println!("{:.0} mN felt on average, with an rms error of {:.1} mN", 1e3 * mean_n, 1e3 * error.rms_n);
    Ok(())
}
