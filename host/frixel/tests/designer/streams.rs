//! `--stream` with a file.

use std::fs;
use std::path::Path;

use hound::{SampleFormat, WavSpec, WavWriter};
use tempfile::TempDir;

use super::{scene, succeed};

/// A second and a half of samples at 2 kHz, from the lowest to the highest value.
fn write_ramp(path: &Path) {
    let spec = WavSpec { channels: 1, sample_rate: 2_000, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let mut writer = WavWriter::create(path, spec).unwrap();
    for index in 0..3_000_i32 {
        writer.write_sample(i16::try_from(-30_000 + 20 * index).unwrap()).unwrap();
    }
    writer.finalize().unwrap();
}

/// A scene whose only layer plays a stream of up to 20 mN.
fn write_scene(path: &Path) {
    let constant = fs::read_to_string(scene("constant.toml")).unwrap();
    let (head, _) = constant.split_once("[[layer]]").unwrap();
    let layer = "[[layer]]\nname = \"radio\"\nkind = \"stream\"\nlow_n = 0\nhigh_n = 0.02\n";
    fs::write(path, format!("{head}{layer}")).unwrap();
}

#[test]
fn a_stream_ends_with_its_file_and_counts_as_wanted() {
    let folder = TempDir::new().unwrap();
    write_scene(&folder.path().join("scene.toml"));
    write_ramp(&folder.path().join("ramp.wav"));
    let (json, notes) = succeed(folder.path(), &["play", "scene.toml", "--stream", "ramp.wav", "--ideal", "--json"]);
    assert!(!notes.contains("nothing will be felt"), "{notes}");
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let seconds = json["ticks"].as_f64().unwrap() / 40_000.0;
    assert!((1.5..1.7).contains(&seconds), "{seconds} s");
    assert_eq!((json["stream_samples"].as_u64(), json["stream_underruns"].as_u64()), (Some(3_000), Some(0)));
    // The last sample is 29,980 of 32,767: 0.957 of 20 mN above 250 mN.
    let reference_max_n = json["reference_max_n"].as_f64().unwrap();
    assert!((reference_max_n - 0.2691).abs() < 3e-4, "{reference_max_n} N");
    let felt = fs::read_to_string(folder.path().join("frixel-out/felt.csv")).unwrap();
    let reference_n =
        |row: usize| -> f64 { felt.lines().nth(row).unwrap().split(',').nth(4).unwrap().parse().unwrap() };
    assert!(
        reference_n(800) > 0.255 && reference_n(1400) > reference_n(800) + 0.005,
        "{} {}",
        reference_n(800),
        reference_n(1400)
    );
    // The last rows are after the end of the stream, and with --seconds it ends earlier.
    let (json, _) =
        succeed(folder.path(), &["play", "scene.toml", "--stream", "ramp.wav", "--seconds", "0.5", "--json"]);
    assert!(json.contains("\"ticks\":20000,"), "{json}");
}
