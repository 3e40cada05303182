//! Every kind of layer, region and blend, from the scene file to the finger.
//!
//! The expected friction stands in `f64` beside each scene, from the file's own numbers and the words of
//! `docs/design/scenes.md`.
//! The library's evaluation has to agree with it, and what the simulated finger felt has to be near it: all lags
//! included, over means of a carrier period, within a bound that was measured and set a fifth above. A drive without
//! voltage must miss the same bound.
#![allow(clippy::unwrap_used, clippy::panic, unreachable_pub, reason = "part of a test, which may fail")]

mod cases;
mod expected;

use std::path::Path;
use std::time::Duration;

use cases::{Case, Path as StrokePath};
use expected::{At, Expected};
use frixel_driver::ignore_progress;
use frixel_felt::recorder::{FeltRow, Recorder};
use frixel_hil_sim::{BoardMemory, Point, Rig, RigConfig, Stroke};
use frixel_lab::input::SceneFolder;
use frixel_play::{Player, connect};
use frixel_scene::{Program, Scene, compile};

use crate::processes::HEAD;

/// Ticks of a carrier period.
const PERIOD_TICKS: usize = 40;
const TICK_S: f64 = 25e-6;
const NATURAL_N: f64 = 0.25;
/// Below this the board may take the finger to be still, mm/s.
const SLIDING_MM_S: f64 = 8.0;

fn compiled(layers: &str) -> Program {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let scene = Scene::parse(format!("{HEAD}{layers}"), "test.toml", &SceneFolder(scenes)).unwrap();
    let board = RigConfig::default().board;
    compile(&scene, &board.limits, board.tick_hz).unwrap_or_else(|error| panic!("{error}"))
}

fn stroke(path: StrokePath) -> Stroke {
    let point = |(x_mm, y_mm): (f64, f64)| Point { x_m: 1e-3 * x_mm, y_m: 1e-3 * y_mm };
    match path {
        StrokePath::Steady(from, to) => Stroke::constant_speed(point(from), point(to), 0.1).unwrap(),
        StrokePath::Person(from, to) => Stroke::minimum_jerk(point(from), point(to), 1.2).unwrap(),
    }
}

/// Every tick of a stroke that a finger makes on a board that plays, with the friction of the scene as reference.
fn play(program: &Program, path: StrokePath) -> Vec<FeltRow> {
    let (stroke, config) = (stroke(path), RigConfig::default());
    let ticks = (stroke.duration_s() * f64::from(config.board.tick_hz)).round() as u64;
    let recorder = Recorder::new(program, &config.board.limits, config.board.tick_hz, ticks, 1).unwrap();
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, stroke, 1).unwrap();
    let mut player = Player::recording(connect(Box::new(rig)).unwrap(), recorder);
    player.start(program.clone(), 0, &mut ignore_progress).unwrap();
    while player.recorder_mut().ticks_left() > 0 {
        player.step(Duration::MAX).unwrap();
    }
    player.into_recorder().take_rows()
}

/// Electric friction that the case expects at each row, in mN, when the stroke began so many ticks after power-on.
fn expected_mn(case: &Case, program: &Program, rows: &[FeltRow], start_ticks: usize) -> Vec<f64> {
    let range_mn = 1e3 * program.reach.electric_friction_max_n;
    let mut expected = Expected::new(range_mn, program.bitmaps.first());
    let at = |(number, row): (usize, &FeltRow)| At {
        x: row.x_mm.unwrap(),
        y: row.y_mm.unwrap(),
        t: (start_ticks + number) as f64 * TICK_S,
        speed: row.speed_mm_s.unwrap(),
    };
    rows.iter()
        .enumerate()
        .map(at)
        .map(|at| match case.of_place {
            Some(of_place) => of_place(at.x, at.y),
            None => (case.expected)(&mut expected, at),
        })
        .collect()
}

/// How many rows the library's evaluation is away from what is expected, by more than it may be.
fn disagreeing(case: &Case, rows: &[FeltRow], expected_mn: &[f64]) -> usize {
    let errors = rows.iter().zip(expected_mn);
    errors
        .filter(|(row, expected)| {
            let error_mn = 1e3 * (row.reference_n.unwrap() - NATURAL_N) - *expected;
            !(error_mn.abs() <= case.agreement_mn)
        })
        .count()
}

/// The ticks from power-on to the first row: those at which the time-based cases agree with the library.
fn start_ticks(case: &Case, program: &Program, rows: &[FeltRow]) -> usize {
    let some: Vec<FeltRow> = rows.iter().take(2_000).copied().collect();
    let away = |start: &usize| disagreeing(case, &some, &expected_mn(case, program, &some, *start));
    (0..case.repeats_after_ticks).min_by_key(away).unwrap()
}

/// Root mean square of felt less expected friction, over carrier periods in which the finger slides, as a part of the
/// range that can be reached.
fn felt_error(program: &Program, rows: &[FeltRow], expected_mn: &[f64]) -> f64 {
    let periods = rows.chunks_exact(PERIOD_TICKS).zip(expected_mn.chunks_exact(PERIOD_TICKS));
    let mut squares = Vec::new();
    // The estimator needs two reports before it knows the speed.
    for (rows, expected_mn) in periods.skip(40) {
        if rows.iter().any(|row| row.speed_mm_s.unwrap() < SLIDING_MM_S) {
            continue;
        }
        let felt_mn: f64 = rows.iter().map(|row| 1e3 * (row.felt_n.unwrap() - NATURAL_N)).sum();
        let expected_mn: f64 = expected_mn.iter().sum();
        squares.push(((felt_mn - expected_mn) / PERIOD_TICKS as f64).powi(2));
    }
    assert!(squares.len() > 500, "{}", squares.len());
    let mean_square = squares.iter().sum::<f64>() / squares.len() as f64;
    mean_square.sqrt() / (1e3 * program.reach.electric_friction_max_n)
}

fn check(case: &Case) -> Result<f64, String> {
    let program = compiled(case.layers);
    let rows = play(&program, case.path);
    let start = start_ticks(case, &program, &rows);
    let expected = expected_mn(case, &program, &rows, start);
    let away = disagreeing(case, &rows, &expected);
    if away > if case.jumps { rows.len() / 200 } else { 0 } {
        return Err(format!("{}: the library's evaluation is away at {away} of {} rows", case.name, rows.len()));
    }
    let error = felt_error(&program, &rows, &expected);
    if error > case.bound {
        return Err(format!("{}: felt {error:.5} of the range away, {} is the bound", case.name, case.bound));
    }
    let mut dead = program.clone();
    dead.header.voltage_max_v_rms = 1.0;
    let dead = felt_error(&program, &play(&dead, case.path), &expected);
    if dead <= case.bound {
        return Err(format!("{}: an output that is not there is {dead:.5} of the range away", case.name));
    }
    Ok(error)
}

#[test]
fn every_case_feels_like_its_formula() {
    let mut wrong = Vec::new();
    for case in cases::all() {
        match check(&case) {
            Ok(error) => println!("{:32} {error:.5} of {}", case.name, case.bound),
            Err(sentence) => wrong.push(sentence),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
