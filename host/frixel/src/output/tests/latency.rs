//! Friction error of the brick scene over the latency of the touch source: `docs/inside/latency.csv` and
//! `docs/inside/latency.svg`.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::scene_file;
use frixel_chart::{Axis, Chart, Line, Look, Mark, PALETTE, Panel, RGBColor};
use frixel_hil_sim::{Point, RigConfig, Stroke};
use frixel_play::{Simulation, TO_THE_END, simulate};
use frixel_scene::{Program, compile};
use frixel_testkit::golden;

const LATENCIES_MS: [u32; 10] = [5, 10, 15, 20, 25, 30, 35, 40, 45, 50];
const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];
/// Stroke, whether the tick predicts, colour.
const CURVES: [(&str, bool, RGBColor); 6] = [
    ("constant 100 mm/s", true, PALETTE[0]),
    ("minimum jerk", true, PALETTE[1]),
    ("constant 100 mm/s, no prediction", false, PALETTE[5]),
    ("minimum jerk, no prediction", false, PALETTE[4]),
    ("people, median 100 mm/s", true, PALETTE[2]),
    ("people, no prediction", false, PALETTE[3]),
];

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/inside").join(name)
}

/// The stroke of a curve; people differ from seed to seed.
fn stroke(name: &str, seed: u64) -> Stroke {
    let (start, end) = (Point { x_m: 0.004, y_m: 0.03 }, Point { x_m: 0.116, y_m: 0.045 });
    if name.starts_with("constant") {
        Stroke::constant_speed(start, end, 0.1).unwrap()
    } else if name.starts_with("people") {
        Stroke::human(0.12, 0.11, 1.5, Some(0.1), seed).unwrap()
    } else {
        Stroke::minimum_jerk(start, end, 1.2).unwrap()
    }
}

/// Errors in per cent of the reachable range.
struct Errors {
    /// Rms friction error, mean square over the seeds.
    friction_rms: f64,
    /// The largest rms friction error of a seed.
    friction_most: f64,
    /// Largest inversion error, the DAC's step included, over all ticks of all seeds.
    inversion_max: f64,
}

fn errors(program: &Program, name: &str, latency_ms: u32) -> Errors {
    let mut rig = RigConfig::default();
    rig.world.touch.latency_s = 1e-3 * f64::from(latency_ms);
    let summaries = SEEDS.map(|seed| {
        let stroke = stroke(name, seed);
        let simulation = Simulation { ticks_per_row: 40_000, ..Simulation::of_stroke(rig, stroke, seed) };
        simulate(program, &simulation, None, TO_THE_END).unwrap().recorder.summary()
    });
    let friction = summaries.iter().map(|summary| summary.friction_error.unwrap().rms_n);
    let inversion = summaries.iter().map(|summary| summary.inversion_error.unwrap().max_n);
    let percent = 100.0 / program.reach.electric_friction_max_n;
    Errors {
        friction_rms: percent * (friction.clone().map(|rms_n| rms_n * rms_n).sum::<f64>() / SEEDS.len() as f64).sqrt(),
        friction_most: percent * friction.fold(0.0, f64::max),
        inversion_max: percent * inversion.fold(0.0, f64::max),
    }
}

fn curves() -> Vec<Vec<Errors>> {
    let rig = RigConfig::default();
    let scene = scene_file::load(&path("../../scenes/brick.toml")).unwrap();
    let mut program = compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap();
    CURVES
        .iter()
        .map(|(name, prediction, _)| {
            program.header.prediction = *prediction;
            LATENCIES_MS.iter().map(|latency_ms| errors(&program, name, *latency_ms)).collect()
        })
        .collect()
}

fn csv(curves: &[Vec<Errors>]) -> String {
    let mut text =
        String::from("latency_ms,stroke,rms_error_percent_of_range,inversion_error_at_most_percent_of_range\n");
    for ((name, ..), curve) in CURVES.iter().zip(curves) {
        for (latency_ms, errors) in LATENCIES_MS.iter().zip(curve) {
            let Errors { friction_rms, inversion_max, .. } = errors;
            writeln!(text, "{latency_ms},\"{name}\",{friction_rms:.3},{inversion_max:.4}").unwrap();
        }
    }
    text
}

/// The goals of `docs/inside/numbers.md`, for reports that are 10 ms late.
fn hold_goals(curves: &[Vec<Errors>]) {
    let late = LATENCIES_MS.iter().position(|latency_ms| *latency_ms == 10).unwrap();
    for (stroke, goal_percent) in [("constant", 5.0), ("minimum jerk", 10.0)] {
        let found: Vec<&Errors> = CURVES
            .iter()
            .zip(curves)
            .filter(|((name, ..), _)| name.starts_with(stroke))
            .map(|(_, curve)| &curve[late])
            .collect();
        let [with, without] = found[..] else { panic!("with and without prediction") };
        assert!(with.friction_most <= goal_percent && without.friction_rms >= 3.0 * with.friction_rms, "{stroke}");
        assert!(with.inversion_max <= 0.1 && with.inversion_max > 0.0, "{stroke}: the DAC has steps");
    }
}

fn svg(curves: &[Vec<Errors>]) -> String {
    let mut panel = Panel::new(
        "",
        Axis::linear("latency of the touch source, ms (100 Hz, noise 0.02 mm rms, jitter 0.5 ms)", 0.0..52.0),
        Axis::linear("rms friction error, % of the reachable range", 0.0..30.0),
    );
    for ((name, _, colour), curve) in CURVES.iter().zip(curves) {
        let points = LATENCIES_MS.iter().map(|ms| f64::from(*ms)).zip(curve.iter().map(|errors| errors.friction_rms));
        panel.add(name, Look { line: Line::Solid, ..Look::mark(*colour, Mark::Disc) }, points.collect());
    }
    let mut chart = Chart::new(vec![panel], 1);
    chart.title = "Brick scene: friction error over touch latency, simulated".to_owned();
    chart.width = 760;
    chart.svg().unwrap()
}

#[test]
fn the_error_over_latency_in_the_docs_is_the_one_that_is_simulated() {
    let curves = curves();
    hold_goals(&curves);
    let files = [(path("latency.csv"), csv(&curves)), (path("latency.svg"), svg(&curves))];
    for (path, text) in files {
        golden::hold(&path, &text);
    }
}
