//! Playing to the simulated board in this process.

use std::path::PathBuf;

use frixel::output::{Report, Trace, write_felt_svg, write_scene_png};
use frixel::player::{Simulation, Stage, simulate};
use frixel::rigs::Recorder;
use frixel::scene::{Program, Scene, compile};
use frixel_hil_sim::RigConfig;

use super::super::stroke::stroke;
use super::{Bars, CommandError, PlayArgs, tell_notes, write_felt_csv};

pub(super) fn play(args: &PlayArgs) -> Result<(Report, Vec<PathBuf>), CommandError> {
    let rig = RigConfig::default();
    let program = compile(&Scene::load(&args.scene)?, &rig.board.limits, rig.board.tick_hz)?;
    tell_notes(&program);
    let (width_m, height_m) = (program.header.screen_width_m, program.header.screen_height_m);
    let stroke = stroke(args.stroke.as_deref(), width_m.into(), height_m.into(), args.seconds)?;
    let simulation = Simulation {
        rig,
        seconds: args.seconds.unwrap_or(stroke.duration_s()),
        stroke,
        seed: args.seed,
        ticks_per_row: rig.board.tick_hz.div_ceil(args.csv_hz),
    };
    let mut bars = Bars::default();
    let simulated = simulate(&program, &simulation, &mut |stage| match stage {
        Stage::Upload(progress) => bars.upload(progress),
        Stage::Play(part) => bars.play(part),
    })?;
    bars.finish();
    let metrics = simulated.recorder.metrics().summary();
    let report = Report::new("sim", &metrics, &program.reach, &simulated.counters, Some(simulated.realtime_factor));
    Ok((report, write_files(args, &program, &simulated.recorder)?))
}

/// Writes `felt.csv`, `felt.svg` and `scene.png`.
fn write_files(args: &PlayArgs, program: &Program, recorder: &Recorder) -> Result<Vec<PathBuf>, CommandError> {
    let rows = recorder.rows();
    let csv = write_felt_csv(&args.out, rows)?;
    let mut trace = Trace::new();
    for row in rows {
        trace.push(row);
    }
    let title = args.scene.display().to_string();
    let svg = args.out.join("felt.svg");
    write_felt_svg(&svg, &title, &trace, &program.reach)?;
    let png = args.out.join("scene.png");
    write_scene_png(&png, &title, program, &trace)?;
    Ok(vec![csv, svg, png])
}
