//! A stream, from the host's samples to the finger.

use std::f64::consts::TAU;
use std::time::Duration;

use frixel_driver::{Device, PollingLink, StreamSettings, ignore_progress};
use frixel_felt::recorder::{FeltRow, Recorder};
use frixel_hil_sim::{BoardMemory, Rig, RigConfig};
use frixel_play::Recorded as _;
use frixel_play::RigStream;
use frixel_scene::Program;

use super::cases::Path;
use super::{NATURAL_N, PERIOD_TICKS, compiled, stroke};

const SAMPLE_HZ: u32 = 2_000;
const WAVE_HZ: f64 = 20.0;
/// Ticks of the wave's period.
const WAVE_TICKS: usize = 2_000;
/// A fifth above what was measured.
const BOUND: f64 = 0.0017;

const LAYERS: &str = "[[layer]]\nkind = \"stream\"\nlow_n = 0.002\nhigh_n = 0.022\ngain = 1.1";

/// What a finger feels while a sine is streamed.
fn play(program: &Program) -> Vec<FeltRow> {
    let rig_config = RigConfig::default();
    let board = rig_config.board;
    let stroke = stroke(Path::Steady((5.0, 30.0), (115.0, 45.0)));
    let ticks = (stroke.duration_s() * f64::from(board.tick_hz)) as u64;
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &rig_config, stroke, 1).unwrap();
    let recorder = Recorder::new(program, &board.limits, board.tick_hz, ticks, 1).unwrap();
    let mut stream = RigStream::new(rig);
    *stream.recorder_mut() = recorder;
    let mut device = Device::connect(PollingLink::new(stream)).unwrap();
    frixel_play::start(&mut device, program, &mut ignore_progress).unwrap();
    device.start_stream(StreamSettings::new(SAMPLE_HZ)).unwrap();
    let sample = |number: u32| {
        let turns = WAVE_HZ * f64::from(number) / f64::from(SAMPLE_HZ);
        (65_535.0 * (0.5 + 0.5 * (TAU * turns).sin())).round() as u16
    };
    let samples: Vec<u16> = (0..3 * SAMPLE_HZ).map(sample).collect();
    let mut left = samples.as_slice();
    for _ in 0..240 {
        let sent = device.send_samples(left).unwrap();
        left = &left[sent..];
        device.wait(Duration::from_millis(5), &mut |_| {}).unwrap();
    }
    assert_eq!(device.stream_status().unwrap().underruns, 0);
    assert!(!left.is_empty(), "there were samples to the end");
    device.link_mut().stream_mut().recorder_mut().rows().to_vec()
}

/// Electric friction so many ticks after the wave began, mN.
fn expected_mn(ticks: usize) -> f64 {
    let turns = (ticks % WAVE_TICKS) as f64 / WAVE_TICKS as f64;
    1.1 * (2.0 + 20.0 * (0.5 + 0.5 * (TAU * turns).sin()))
}

/// Root mean square of felt less expected friction over carrier periods, in mN, for a wave that began so many ticks
/// before the rows.
fn error_mn(rows: &[FeltRow], began: usize) -> f64 {
    let mut squares = Vec::new();
    for (period, rows) in rows.chunks_exact(PERIOD_TICKS).enumerate() {
        let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / PERIOD_TICKS as f64;
        let felt_mn = mean(&mut rows.iter().map(|row| 1e3 * (row.felt_n.unwrap() - NATURAL_N)));
        let start = began + period * PERIOD_TICKS;
        squares.push((felt_mn - mean(&mut (start..start + PERIOD_TICKS).map(expected_mn))).powi(2));
    }
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// The same at the beginning that fits best: the stream's latency is not what is looked at here.
fn felt_error(program: &Program, range_mn: f64) -> f64 {
    let rows = play(program);
    // Once the stream has begun and faded in, and before the finger stops.
    let rows = &rows[8_000..40_000];
    (0..WAVE_TICKS).step_by(4).map(|began| error_mn(rows, began)).fold(f64::INFINITY, f64::min) / range_mn
}

#[test]
fn the_finger_feels_the_stream() {
    let program = compiled(LAYERS);
    let range_mn = 1e3 * program.reach.electric_friction_max_n;
    let error = felt_error(&program, range_mn);
    println!("{:32} {error:.5} of {BOUND}", "stream");
    assert!(error <= BOUND, "{error}");
    let mut dead = program;
    dead.header.voltage_max_v_rms = 1.0;
    assert!(felt_error(&dead, range_mn) > BOUND);
}
