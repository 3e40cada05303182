//! Switches layers while a scene plays: a button that appears, a texture that fades, a click.
//!
//! ```sh
//! cargo run -p frixel-lab --example live
//! ```
//!
//! On a board at a serial port the same calls of `Player` do the same: only the `Device` is made otherwise.
#![allow(clippy::print_stdout, reason = "it is a program")]

use std::collections::BTreeMap;
use std::error::Error;
use std::time::Duration;

use frixel_driver::ignore_progress;
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{BoardMemory, Point, Rig, RigConfig, Stroke};
use frixel_play::{Player, connect};
use frixel_scene::{Scene, compile};

const SCENE: &str = r#"
version = 1
[[layer]]
name = "ground"
kind = "constant"
friction_n = 0.28
live = true
[[layer]]
name = "button"
kind = "constant"
friction_n = 0.34
live = true
start = "off"
"#;
/// The finger slides at 100 mm/s meanwhile.
const SECONDS: f64 = 1.0;

fn main() -> Result<(), Box<dyn Error>> {
    let rig = RigConfig::default();
    let (limits, tick_hz) = (&rig.board.limits, rig.board.tick_hz);
    let scene = Scene::parse(SCENE, "live.toml", &BTreeMap::<String, Vec<u8>>::new())?;
    let program = compile(&scene, limits, tick_hz)?;
    let stroke = Stroke::constant_speed(Point { x_m: 0.01, y_m: 0.04 }, Point { x_m: 0.11, y_m: 0.04 }, 0.1)?;
    let ticks = (SECONDS * f64::from(tick_hz)) as u64;
    let recorder = Recorder::new(&program, limits, tick_hz, ticks, tick_hz / 1000)?;

    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &rig, stroke, 1)?;
    let mut player = Player::recording(connect(Box::new(rig))?, recorder);
    player.start(program, 0, &mut ignore_progress)?;
    player.wait(Duration::from_millis(200))?;
    player.change_layer("button", Some(true), None)?;
    player.wait(Duration::from_millis(200))?;
    player.change_layer("button", Some(false), None)?;
    player.change_layer("ground", None, Some(0.5))?;
    player.wait(Duration::from_millis(200))?;
    // On for 50 ms.
    player.trigger("button", Some(0.05))?;
    player.wait(Duration::from_millis(200))?;
    player.stop()?;

    let recorder = player.into_recorder();
    for marker in recorder.markers() {
        println!("{:.2} s  {:?}", marker.t_s, marker.event);
    }
    for t_ms in [150, 350, 550, 620, 750] {
        let commanded_n = recorder.rows().get(t_ms).and_then(|row| row.commanded_n).ok_or("no row")?;
        println!("{:.2} s  {:.0} mN commanded", 1e-3 * t_ms as f64, 1e3 * commanded_n);
    }
    Ok(())
}
