//! A stream from a WAV file through driver, line, board and amplifier to the finger, in virtual time.
//!
//! The reference of the recorder is compared, tick by tick, with straight lines between the file's samples in f64, and
//! with the friction that the board commands.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::f64::consts::TAU;
use std::path::Path;
use std::time::Duration;

use frixel::scene_file;
use frixel::stream;
use frixel_driver::{Device, PollingLink, StreamStatus, ignore_progress};
use frixel_felt::recorder::{FeltRow, Recorder};
use frixel_hil_sim::{BoardMemory, Point, Rig, RigConfig, Stroke};
use frixel_layers::{Blend, Layer, Record, Region, Stream};
use frixel_play::Recorded as _;
use frixel_play::RigStream;
use frixel_scene::{Program, compile};
use frixel_wire::fault::Flags;
use hound::{SampleFormat, WavSpec, WavWriter};

use crate::processes::bundled;

const SAMPLE_HZ: u32 = 4_000;
const TICK_HZ: f64 = 40_000.0;
const FADE_TICKS: f64 = 400.0;
const NATURAL_N: f64 = 0.25;
const LOW_N: f64 = 0.002;
const HIGH_N: f64 = 0.018;

/// The friction that a stream alone gives.
fn program() -> Program {
    let rig = RigConfig::default();
    let scene = scene_file::load(&bundled("constant.toml")).unwrap();
    let mut program = compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap();
    let layer = Layer::Stream(Stream { low_n: LOW_N as f32, high_n: HIGH_N as f32 });
    program.records = vec![Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer }];
    program
}

/// A second of two tones, as a 16-bit WAV has it.
pub(crate) fn tones() -> Vec<i16> {
    (0..SAMPLE_HZ)
        .map(|index| {
            let t_s = f64::from(index) / f64::from(SAMPLE_HZ);
            let value = 0.55 * (TAU * 37.0 * t_s).sin() + 0.4 * (TAU * 210.0 * t_s).cos();
            (32_767.0 * value).round() as i16
        })
        .collect()
}

pub(crate) fn write_wav(path: &Path, samples: &[i16]) {
    let spec = WavSpec { channels: 1, sample_rate: SAMPLE_HZ, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let mut writer = WavWriter::create(path, spec).unwrap();
    for sample in samples {
        writer.write_sample(*sample).unwrap();
    }
    writer.finalize().unwrap();
}

/// Total friction, `ticks` ticks after the first one that plays, from the file's samples and nothing else.
fn reference_n(samples: &[i16], ticks: f64) -> f64 {
    let value = |index: f64| (f64::from(samples[index as usize]) + 32_768.0) / 65_535.0;
    let place = (ticks - 1.0).max(0.0) * f64::from(SAMPLE_HZ) / TICK_HZ;
    let before = place.floor();
    let sample = value(before) + (place - before) * (value(before + 1.0) - value(before));
    let weight = ((ticks + 1.0) / FADE_TICKS).min(1.0);
    NATURAL_N + weight * (LOW_N + (HIGH_N - LOW_N) * sample)
}

fn is_dry(row: &FeltRow) -> bool {
    row.flags.unwrap().contains(Flags::STREAM_DRY)
}

/// Plays the tones under a sliding finger; the host sends nothing in `pause`, in milliseconds from the stream's start.
/// Returns a row per tick, and the board's reports of the stream.
fn play(pause_ms: std::ops::Range<u64>) -> (Vec<FeltRow>, StreamStatus) {
    let folder = tempfile::tempdir().unwrap();
    let wav = folder.path().join("tones.wav");
    write_wav(&wav, &tones());
    let program = program();
    let config = RigConfig::default();
    let stroke =
        Stroke::constant_speed(Point { x_m: 0.005, y_m: 0.03 }, Point { x_m: 0.115, y_m: 0.03 }, 0.05).unwrap();
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, stroke, 1).unwrap();
    let recorder = Recorder::new(&program, &config.board.limits, config.board.tick_hz, 80_000, 1).unwrap();
    let mut stream = RigStream::new(Box::new(rig));
    *stream.recorder_mut() = recorder;
    let mut device = Device::connect(PollingLink::new(stream)).unwrap();
    frixel_play::start(&mut device, &program, &mut ignore_progress).unwrap();
    device.wait(Duration::from_millis(100), &mut |_| {}).unwrap();
    let (mut feed, notes) = stream::wav(&wav, config.board.tick_hz).unwrap();
    assert!(notes.is_empty());
    feed.start(&mut device).unwrap();
    for step in 0..330 {
        device.wait(Duration::from_millis(5), &mut |_| {}).unwrap();
        if !pause_ms.contains(&(5 * step)) {
            feed.pump(&mut device).unwrap();
        }
    }
    let status = device.stream_status().unwrap();
    (device.link_mut().stream_mut().recorder_mut().rows().to_vec(), status)
}

/// Rows from the first tick that plays.
fn from_start(rows: &[FeltRow]) -> &[FeltRow] {
    let filling = rows.iter().position(is_dry).unwrap();
    let start = rows[filling..].iter().position(|row| !is_dry(row)).unwrap();
    &rows[filling + start..]
}

/// The recorder's reference is what this test computes by itself, and what the board commands.
#[test]
fn the_recorder_knows_what_is_streamed() {
    let samples = tones();
    for (pause_ms, dry_s) in [(0..0, 0.0), (300..310, 0.0), (300..800, 0.3)] {
        let (rows, status) = play(pause_ms.clone());
        assert_eq!(status.underruns, u32::from(dry_s > 0.0));
        let filling = rows.iter().position(is_dry).unwrap();
        assert!(
            rows[..filling].iter().all(|row| (row.reference_n.unwrap() - NATURAL_N).abs() < 1e-12),
            "nothing streams"
        );
        let played = from_start(&rows);
        if status.underruns == 0 {
            for (tick, row) in played[..10 * samples.len() - 20].iter().enumerate() {
                let expected_n = reference_n(&samples, tick as f64);
                assert!((row.reference_n.unwrap() - expected_n).abs() < 1e-9, "{tick}: {:?} N", row.reference_n);
            }
        }
        let as_commanded = |row: &FeltRow| (row.commanded_n.unwrap() - row.reference_n.unwrap()).abs() < 2e-7;
        let same = played.iter().filter(|row| as_commanded(row)).count();
        assert!(same * 100 > 95 * played.len(), "{same} of {} ticks, paused {pause_ms:?} ms", played.len());
        assert!(
            as_commanded(played.last().unwrap()) && played.last().unwrap().reference_n == Some(NATURAL_N),
            "it has faded"
        );
    }
}

/// The command as a process.
mod command {
    use super::*;
    use std::fs::File;

    use crate::processes::{frixel, said};

    const SCENE: &str = r#"
version = 1
screen = { width_mm = 120, height_mm = 80, coating = { thickness_um = 10, permittivity = 1 } }
finger = { radius_mm = 8, stiffness_pa_per_m = 1.8e7, friction_coefficient = 0.5, normal_load_n = 0.5, skin_gap_um = 0 }
[[layer]]
kind = "stream"
low_n = 0.002
high_n = 0.018
"#;

    /// A play of the scene above, with its samples from a file or from standard input: the JSON and felt.csv.
    fn stream(folder: &Path, out: &str, arguments: &[&str], input: File) -> (serde_json::Value, Vec<u8>) {
        let mut command = frixel();
        command.args(["play", "scene.toml", "--ideal", "--json", "--out", out]).args(arguments);
        let output = command.current_dir(folder).stdin(input).output().unwrap();
        assert!(output.status.success(), "{}", said(&output));
        (serde_json::from_slice(&output.stdout).unwrap(), std::fs::read(folder.join(out).join("felt.csv")).unwrap())
    }

    #[test]
    fn a_pipe_plays_what_a_file_plays() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("scene.toml"), SCENE).unwrap();
        write_wav(&path("tones.wav"), &tones());
        let raw: Vec<u8> = tones().iter().flat_map(|s| ((i32::from(*s) + 32_768) as u16).to_le_bytes()).collect();
        std::fs::write(path("raw"), raw).unwrap();
        let open = |name: &str| File::open(path(name)).unwrap();

        let (json, _) = stream(folder.path(), "whole", &["--stream", "tones.wav"], open("scene.toml"));
        let seconds = json["ticks"].as_f64().unwrap() / TICK_HZ;
        assert!((1.0..1.2).contains(&seconds), "{seconds} s: the play ends with its file");
        let of_file = ["--stream", "tones.wav", "--seconds", "1.5"];
        let (json, of_file) = stream(folder.path(), "file", &of_file, open("scene.toml"));
        assert_eq!([&json["stream_samples"], &json["stream_underruns"], &json["stream_gaps"]], [4_000, 0, 0]);
        // 7 % of the span were found, what a slow finger costs among them; of an output at zero it would be 50 %.
        let error_n = json["friction_error_rms_n"].as_f64().unwrap();
        assert!((1e-6..0.1 * (HIGH_N - LOW_N)).contains(&error_n), "{error_n} N rms");
        let raw = |hz| ["--stream", "-", "--stream-hz", hz, "--seconds", "1.5"];
        let (_, of_pipe) = stream(folder.path(), "pipe", &raw("4000"), open("raw"));
        assert!(of_file == of_pipe, "the two differ");
        let (_, of_other) = stream(folder.path(), "other", &raw("3000"), open("raw"));
        assert!(of_file != of_other, "the rate changes nothing");
    }
}
