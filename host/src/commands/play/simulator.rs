//! Playing to the simulated board in this process.

use std::time::Instant;

use frixel::device::{Device, Link};
use frixel::output::{felt_svg, scene_png};
use frixel::rigs::{Recorder, SimLink};
use frixel::scene::{Program, Scene, compile};
use frixel_hil_sim::{BoardMemory, Rig, RigConfig};

use super::super::stroke::stroke;
use super::{CommandError, PlayArgs, Summary, pass, start, tell_notes, write_felt_csv};

/// What is played beyond the last recorded tick, so that the recorder has seen it.
const MARGIN_S: f64 = 5e-3;

pub(super) fn play(args: &PlayArgs) -> Result<Summary, CommandError> {
    let config = RigConfig::default();
    let (limits, tick_hz) = (&config.board.limits, config.board.tick_hz);
    let program = compile(&Scene::load(&args.scene)?, limits, tick_hz)?;
    tell_notes(&program);
    let (width_m, height_m) = (program.header.screen_width_m, program.header.screen_height_m);
    let stroke = stroke(args.stroke.as_deref(), width_m.into(), height_m.into(), args.seconds)?;
    let seconds = args.seconds.unwrap_or(stroke.duration_s());
    let ticks = (seconds * f64::from(tick_hz)).round() as u64;

    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, stroke, args.seed)?;
    let recorder = Recorder::new(&program, limits, tick_hz, ticks, tick_hz.div_ceil(args.csv_hz))?;
    let begin = Instant::now();
    let mut device = Device::connect(SimLink::new(rig, recorder))?;
    start(&mut device, &program)?;
    pass(&mut device, Some(seconds + MARGIN_S), &mut |device, step| {
        device.wait(step, &mut |_| {})?;
        Ok(false)
    })?;
    device.stop()?;
    device.disarm()?;
    let wall_s = begin.elapsed().as_secs_f64();

    let counters = device.counters();
    let link = device.into_link();
    let realtime_factor = link.now().as_secs_f64() / wall_s;
    let (_, recorder) = link.into_parts();
    let files = write_files(args, &program, &recorder)?;
    Ok(Summary::of_simulator(&program, recorder.metrics(), counters, realtime_factor, files))
}

/// Writes `felt.csv`, `felt.svg` and `scene.png`.
fn write_files(
    args: &PlayArgs,
    program: &Program,
    recorder: &Recorder,
) -> Result<Vec<std::path::PathBuf>, CommandError> {
    let rows = recorder.rows();
    let csv = write_felt_csv(&args.out, rows)?;
    let svg = args.out.join("felt.svg");
    std::fs::write(&svg, felt_svg(rows)).map_err(CommandError::file(&svg))?;
    let png = args.out.join("scene.png");
    std::fs::write(&png, scene_png(program, rows)).map_err(CommandError::file(&png))?;
    Ok(vec![csv, svg, png])
}
