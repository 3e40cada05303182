//! Playing to the simulated board in this process.

use std::ops::ControlFlow;
use std::path::PathBuf;

use frixel::output::{FeltCsv, FeltRow, OutputError, Report, Trace, write_felt_svg, write_scene_png};
use frixel::player::{Simulation, Stage, simulate_rows};
use frixel::scene_file;
use frixel_hil_sim::{RigConfig, Stroke};
use frixel_scene::{Program, compile};

use super::super::interrupt::Interrupt;
use super::super::stroke::{check_on_screen, stroke};
use super::live::open_feed;
use super::{
    Bars, CommandError, PlayArgs, Played, check_seconds, create_felt_csv, refuse_watch, tell_notes, ticks_per_row,
};

pub(super) fn play(args: &PlayArgs) -> Result<Played, CommandError> {
    refuse_watch(args)?;
    let rig = RigConfig::default();
    let ticks_per_row = ticks_per_row(args.csv_hz, rig.board.tick_hz)?;
    let program = compile(&scene_file::load(&args.scene)?, &rig.board.limits, rig.board.tick_hz)?;
    tell_notes(&program);
    let (stroke, seconds) = scene_stroke(args, &program, rig.board.tick_hz)?;
    let mut feed = open_feed(args, rig.board.tick_hz, true)?;
    let simulation = Simulation { rig, stroke, seconds, seed: args.seed, ticks_per_row };
    let interrupt = Interrupt::watch()?;
    let (csv, csv_path) = create_felt_csv(&args.out)?;
    let mut rows = Rows { csv, trace: Trace::new() };
    let mut write_error = None;
    let mut bars = Bars::default();
    let on_stage = &mut |stage| match stage {
        Stage::Upload(progress) => bars.upload(progress),
        Stage::Play(part) => bars.play(part),
    };
    let simulated = simulate_rows(&program, &simulation, feed.as_mut(), on_stage, &mut |new| {
        write_error = rows.take(new).err();
        if write_error.is_some() || interrupt.is_asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    bars.finish();
    write_error.map_or(Ok(()), Err)?;
    rows.csv.finish()?;
    let metrics = simulated.recorder.metrics().summary();
    if interrupt.is_asked() {
        let played_s = metrics.ticks as f64 / f64::from(rig.board.tick_hz);
        eprintln!("interrupted: what follows is of the first {played_s:.3} s of {:.3} s", simulation.seconds);
    }
    let report = Report::new("sim", &metrics, &program.reach, &simulated.counters, Some(simulated.realtime_factor))
        .with_stream(simulated.stream);
    let mut files = vec![csv_path];
    files.extend(draw(args, &program, &rows.trace)?);
    Ok(Played { report, files, failure: None })
}

/// Where the finger goes over a scene's screen, and for how many seconds to play.
pub(super) fn scene_stroke(args: &PlayArgs, program: &Program, tick_hz: u32) -> Result<(Stroke, f64), CommandError> {
    let (width_m, height_m) = (program.header.screen_width_m.into(), program.header.screen_height_m.into());
    let stroke = stroke(args.stroke.as_deref(), width_m, height_m, args.seconds)?;
    let seconds = args.seconds.unwrap_or(stroke.duration_s());
    check_seconds(seconds, tick_hz)?;
    if let Some(path) = &args.stroke {
        check_on_screen(path, &stroke, width_m, height_m, seconds)?;
    }
    Ok((stroke, seconds))
}

/// Where rows go while the scene plays.
pub(super) struct Rows {
    pub(super) csv: FeltCsv,
    pub(super) trace: Trace,
}

impl Rows {
    pub(super) fn take(&mut self, rows: &[FeltRow]) -> Result<(), OutputError> {
        for row in rows {
            self.csv.write(row)?;
            self.trace.push(row);
        }
        Ok(())
    }
}

/// Draws `felt.svg` and `scene.png`.
pub(super) fn draw(args: &PlayArgs, program: &Program, trace: &Trace) -> Result<[PathBuf; 2], CommandError> {
    let title = args.scene.display().to_string();
    let svg = args.out.join("felt.svg");
    write_felt_svg(&svg, &title, trace, &program.reach)?;
    let png = args.out.join("scene.png");
    write_scene_png(&png, &title, program, trace)?;
    Ok([svg, png])
}
