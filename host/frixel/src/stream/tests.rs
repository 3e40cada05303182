use std::io::Cursor;
use std::path::Path;

use hound::{SampleFormat, WavSpec, WavWriter};
use tempfile::tempdir;

use super::*;

const TICK_HZ: u32 = 40_000;

fn spec(channels: u16, sample_rate: u32, bits_per_sample: u16, sample_format: SampleFormat) -> WavSpec {
    WavSpec { channels, sample_rate, bits_per_sample, sample_format }
}

fn write<S: hound::Sample + Copy>(path: &Path, spec: WavSpec, samples: &[S]) {
    let mut writer = WavWriter::create(path, spec).unwrap();
    for sample in samples {
        writer.write_sample(*sample).unwrap();
    }
    writer.finalize().unwrap();
}

fn read(path: &Path) -> (u32, Vec<u16>) {
    let wav = wav::read(path, TICK_HZ).unwrap();
    (wav.sample_hz, wav.samples)
}

fn notes(path: &Path) -> Vec<String> {
    wav::read(path, TICK_HZ).unwrap().notes
}

/// Programs that write to a pipe cannot go back to the header.
#[test]
fn a_file_whose_length_is_not_known_plays_to_its_end() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("pipe.wav");
    let samples: Vec<i32> = (0..8_000).collect();
    write(&path, spec(2, 8_000, 16, SampleFormat::Int), &samples);
    let whole = std::fs::read(&path).unwrap();
    let data = whole.windows(4).position(|name| name == b"data").unwrap();
    let expected = read(&path);
    assert!(notes(&path).is_empty());
    for length in [0xffff_ffff_u32, 0, 0x7fff_f000, 20_000] {
        let mut changed = whole.clone();
        changed[data + 4..data + 8].copy_from_slice(&length.to_le_bytes());
        // Half a frame at the end is left out.
        changed.extend([1, 2, 3]);
        std::fs::write(&path, changed).unwrap();
        assert_eq!(read(&path), expected, "{length}");
        assert!(notes(&path)[0].contains("all 16000 bytes in the file are played"), "{:?}", notes(&path));
    }
    // A file without samples stays one, whatever else it has.
    let mut empty = whole[..data + 8].to_vec();
    empty[data + 4..].fill(0);
    empty.extend(b"LIST\x03\0\0\0abc\0");
    std::fs::write(&path, empty).unwrap();
    assert!(matches!(wav::read(&path, TICK_HZ), Err(StreamError::Empty { .. })));
}

#[test]
fn floats_beyond_full_scale_are_noted() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("loud.wav");
    write(&path, spec(1, 1_000, 32, SampleFormat::Float), &[-1.0_f32, 1.0, 7.0, -1.5]);
    assert_eq!(notes(&path), ["2 of 4 samples are outside -1 to 1 and are clipped: export the file at a lower level"]);
}

#[test]
fn every_depth_reaches_from_the_lowest_to_the_highest() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.wav");
    write(&path, spec(1, 8_000, 8, SampleFormat::Int), &[-128_i32, 0, 127]);
    assert_eq!(read(&path), (8_000, vec![0, 128 * 257, 65_535]));
    write(&path, spec(1, 8_000, 16, SampleFormat::Int), &[-32_768_i32, -1, 0, 1, 32_767]);
    assert_eq!(read(&path), (8_000, vec![0, 32_767, 32_768, 32_769, 65_535]));
    write(&path, spec(1, 1_000, 24, SampleFormat::Int), &[-8_388_608_i32, 0, 8_388_607]);
    assert_eq!(read(&path), (1_000, vec![0, 32_768, 65_535]));
    write(&path, spec(1, 1_000, 32, SampleFormat::Int), &[i32::MIN, 0, i32::MAX]);
    assert_eq!(read(&path), (1_000, vec![0, 32_768, 65_535]));
    write(&path, spec(1, 1_000, 32, SampleFormat::Float), &[-1.0_f32, -0.5, 0.0, 1.0, 7.0, -7.0]);
    assert_eq!(read(&path), (1_000, vec![0, 16_384, 32_768, 65_535, 65_535, 0]));
}

#[test]
fn of_several_channels_the_first_is_taken() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.wav");
    write(&path, spec(3, 100, 16, SampleFormat::Int), &[0_i32, 9, 9, 1, 9, 9, 2, 9, 9]);
    assert_eq!(read(&path), (100, vec![32_768, 32_769, 32_770]));
}

#[test]
fn more_samples_than_ticks_are_brought_below_them() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.wav");
    for (sample_hz, expected_hz) in [(40_000, 40_000), (44_100, 22_050), (48_000, 24_000), (96_000, 32_000)] {
        let samples: Vec<i32> = (0..600).collect();
        write(&path, spec(1, sample_hz, 16, SampleFormat::Int), &samples);
        let (found_hz, found) = read(&path);
        assert_eq!(found_hz, expected_hz);
        let together = sample_hz / expected_hz;
        assert_eq!(found.len() as u32, 600 / together);
        // A ramp of ones: the mean of n samples from k on is k + (n - 1) / 2.
        for (index, found) in found.into_iter().enumerate() {
            let expected = 32_768.0 + f64::from(together) * index as f64 + (f64::from(together) - 1.0) / 2.0;
            assert!((f64::from(found) - expected).abs() <= 0.5, "{found} is not {expected}");
        }
    }
}

#[test]
fn samples_that_are_none_or_no_numbers_give_one_sentence() {
    let folder = tempdir().unwrap();
    let message = |path: &Path| wav(path, TICK_HZ).err().unwrap().to_string();
    let path = folder.path().join("none.wav");
    write::<i32>(&path, spec(1, 8_000, 16, SampleFormat::Int), &[]);
    assert!(message(&path).contains("has no samples"));
    write(&path, spec(1, 8_000, 32, SampleFormat::Float), &[0.0, f32::NAN]);
    assert!(message(&path).contains("sample 1 of"));
}

#[test]
fn a_pipe_gives_little_endian_samples_and_drops_half_a_one() {
    let bytes: Vec<u8> = (0..5_000_u16).flat_map(u16::to_le_bytes).chain([7]).collect();
    let mut pipe = Pipe::open(Cursor::new(bytes), true).unwrap();
    let (mut found, mut len) = (Vec::new(), 2_048);
    while pipe.fetch(&mut found, len).unwrap() {
        len += 2_048;
    }
    assert_eq!(found, (0..5_000).collect::<Vec<u16>>());
}
