//! The brick scene, from its file to the finger: the goals that `docs/inside/numbers.md` names.
//!
//! The reference is evaluated here a second time, from the picture as the compiler resampled it, and compared with that
//! of the recorder, so that the errors below are errors against the picture.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::path::Path;

use frixel::scene_file;
use frixel_felt::metrics::MetricsSummary;
use frixel_hil_sim::{Point, RigConfig, Stroke};
use frixel_play::{Simulated, Simulation, TO_THE_END, simulate};
use frixel_scene::{Program, compile};

const START: Point = Point { x_m: 0.004, y_m: 0.03 };
const END: Point = Point { x_m: 0.116, y_m: 0.045 };

fn brick(prediction: bool) -> Program {
    let rig = RigConfig::default();
    let scene = scene_file::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/brick.toml")).unwrap();
    let mut program = compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap();
    program.header.prediction = prediction;
    program
}

/// The touch source that the goals are for: 100 Hz, 10 ms late, noise 0.02 mm rms, jitter 0.5 ms.
fn rig() -> RigConfig {
    let rig = RigConfig::default();
    let touch = &rig.world.touch;
    assert_eq!(
        (touch.rate_hz, touch.latency_s, touch.noise_rms_m, touch.jitter_rms_s),
        (100.0, 10e-3, 0.02e-3, 0.5e-3)
    );
    rig
}

fn constant_speed() -> Stroke {
    Stroke::constant_speed(START, END, 0.1).unwrap()
}

fn minimum_jerk() -> Stroke {
    Stroke::minimum_jerk(START, END, 1.2).unwrap()
}

fn play(program: &Program, rig: &RigConfig, stroke: Stroke, seed: u64) -> Simulated {
    let seconds = stroke.duration_s();
    let simulation = Simulation { rig: *rig, stroke, seconds, seed, ticks_per_row: 1, through_finger: false };
    simulate(program, &simulation, None, TO_THE_END).unwrap()
}

fn errors(prediction: bool, stroke: Stroke, seed: u64) -> MetricsSummary {
    play(&brick(prediction), &rig(), stroke, seed).recorder.summary()
}

/// Rms friction error as a part of the reachable electric range.
fn friction_error(summary: &MetricsSummary) -> f64 {
    summary.friction_error.unwrap().rms_n / brick(true).reach.electric_friction_max_n
}

/// Friction of black and of white in the scene, N.
const BLACK_WHITE_N: (f64, f64) = (-0.0985, 0.166);

/// Electric friction of the picture at a place, by the definition in docs/design/scenes.md and nothing else.
fn picture_n(program: &Program, x_m: f64, y_m: f64) -> f64 {
    let (left_m, top_m, pitch_m) = (0.010, 0.005, 0.4e-3);
    let (black_n, white_n) = BLACK_WHITE_N;
    let picture = &program.bitmaps[0];
    let (width, height) = (usize::from(picture.width), usize::from(picture.height));
    let (u, v) = ((x_m - left_m) / pitch_m, (y_m - top_m) / pitch_m);
    if u < 0.0 || v < 0.0 || u >= width as f64 || v >= height as f64 {
        return 0.0;
    }
    // Every sample is a tent of two pitches' width about its centre; at the border the last one goes on.
    let (mut level, mut weight) = (0.0, 0.0);
    for row in 0..height {
        for column in 0..width {
            let tent = |place: f64, index: usize, count: usize| {
                let place = place.clamp(0.5, count as f64 - 0.5);
                (1.0 - (place - 0.5 - index as f64).abs()).max(0.0)
            };
            let part = tent(u, column, width) * tent(v, row, height);
            level += part * f64::from(picture.samples[row * width + column]);
            weight += part;
        }
    }
    // The layer counts where it asks for more than bare glass.
    (black_n + (white_n - black_n) * level / weight / 255.0).max(0.0)
}

#[test]
fn the_reference_is_the_resampled_picture() {
    let program = brick(true);
    let simulated = play(&program, &rig(), constant_speed(), 1);
    let rows = simulated.recorder.rows();
    assert!(rows.len() > 44_000);
    let mut span_n = (f64::INFINITY, 0.0_f64);
    for row in rows.iter().step_by(997) {
        let (Some(x_mm), Some(y_mm), Some(reference_n)) = (row.x_mm, row.y_mm, row.reference_n) else { continue };
        let expected_n = 0.25 + picture_n(&program, 1e-3 * x_mm, 1e-3 * y_mm);
        // Four millionths of the range from black to white, for the places that the scene stores as f32.
        let tolerance_n = 4e-6 * (BLACK_WHITE_N.1 - BLACK_WHITE_N.0);
        assert!((reference_n - expected_n).abs() < tolerance_n, "({x_mm}, {y_mm}): {reference_n} is not {expected_n}");
        span_n = (span_n.0.min(reference_n), span_n.1.max(reference_n));
    }
    assert!(span_n.1 - span_n.0 > 50e-3, "the stroke crosses bricks and mortar: {span_n:?}");
}

#[test]
fn inversion_is_within_a_thousandth_of_the_range() {
    let range_n = brick(true).reach.electric_friction_max_n;
    for stroke in [constant_speed(), minimum_jerk()] {
        let error = errors(true, stroke, 1).inversion_error.unwrap();
        assert!(error.max_n <= 1e-3 * range_n, "{:e} of the range", error.max_n / range_n);
        assert!(error.max_n > 0.0, "the DAC has steps");
    }
}

#[test]
fn friction_is_felt_within_the_goals_and_prediction_is_why() {
    for (name, stroke, goal) in [("constant speed", constant_speed(), 0.05), ("minimum jerk", minimum_jerk(), 0.10)] {
        let (mut with_all, mut without_all) = (0.0, 0.0);
        for seed in 1..=5 {
            let with = friction_error(&errors(true, stroke.clone(), seed));
            assert!(with <= goal, "{name}, seed {seed}: {with}");
            with_all += with;
            without_all += friction_error(&errors(false, stroke.clone(), seed));
        }
        assert!(
            without_all >= 3.0 * with_all,
            "{name}: {without_all} without prediction, {with_all} with, of five seeds"
        );
    }
}

/// The checks above see an output that is not there: a volt gives less than a millionth of a newton.
#[test]
fn an_output_forced_to_zero_misses_every_goal() {
    let mut program = brick(true);
    program.header.voltage_max_v_rms = 1.0;
    for (stroke, goal) in [(constant_speed(), 0.05), (minimum_jerk(), 0.10)] {
        let summary = play(&program, &rig(), stroke, 1).recorder.summary();
        assert!(friction_error(&summary) > goal, "{}", friction_error(&summary));
        let range_n = program.reach.electric_friction_max_n;
        assert!(summary.inversion_error.unwrap().max_n > 1e-3 * range_n);
        assert!(summary.saturated_ticks > Some(0));
    }
}
