//! Reading of WAV files.

use std::io::Cursor;
use std::path::Path;

use frixel_lab::input::InputError;
use hound::{SampleFormat, WavReader};

use super::StreamError;
use crate::input;

/// Largest number of samples of a channel: 25 minutes at 44.1 kHz.
const FRAMES_MAX: u64 = 64 << 20;
/// Bytes of a chunk's name and length, and of the names of file and form before the first chunk.
const CHUNK_HEAD: usize = 8;
const FORM_HEAD: usize = 12;

/// The contents of a WAV file for a stream.
pub(super) struct Wav {
    /// The sample rate, reduced to at most that of the board's ticks.
    pub(super) sample_hz: u32,
    /// The samples of the first channel.
    pub(super) samples: Vec<u16>,
    /// Notes on the file, one sentence each.
    pub(super) notes: Vec<String>,
}

/// Reads a WAV file, reduced to at most `max_hz` samples a second.
pub(super) fn read(path: &Path, max_hz: u32) -> Result<Wav, StreamError> {
    let failed = |source| StreamError::Wav { path: path.to_owned(), source };
    let mut bytes = input::read(path, input::WAV_MAX_BYTES).map_err(|error| failed(error.into()))?;
    let mut notes = Vec::from_iter(correct_length(&mut bytes));
    let mut reader = WavReader::new(Cursor::new(bytes)).map_err(failed)?;
    let (spec, frames) = (reader.spec(), u64::from(reader.duration()));
    if frames > FRAMES_MAX {
        let too_many = InputError::TooMany { what: "samples in a channel", found: frames, max: FRAMES_MAX };
        return Err(failed(hound::Error::IoError(too_many.into())));
    }
    let together = samples_together(spec.sample_rate, max_hz);
    let channels = usize::from(spec.channels.max(1));
    let mut means = Means { together, ..Means::default() };
    match spec.sample_format {
        SampleFormat::Float => {
            for (index, sample) in reader.samples::<f32>().step_by(channels).enumerate() {
                let sample = f64::from(sample.map_err(failed)?);
                if !sample.is_finite() {
                    return Err(StreamError::NotANumber { path: path.to_owned(), index });
                }
                means.push(0.5 + 0.5 * sample);
            }
        }
        SampleFormat::Int => {
            let steps = (1_u64 << spec.bits_per_sample) - 1;
            let lowest = -(1_i64 << (spec.bits_per_sample - 1));
            for sample in reader.samples::<i32>().step_by(channels) {
                means.push((i64::from(sample.map_err(failed)?) - lowest) as f64 / steps as f64);
            }
        }
    }
    let beyond = means.beyond;
    let samples = means.finish();
    if samples.is_empty() || spec.sample_rate == 0 {
        return Err(StreamError::Empty { path: path.to_owned() });
    }
    if beyond > 0 {
        notes.push(format!(
            "{beyond} of {frames} samples are outside -1 to 1 and are clipped: export the file at a lower level"
        ));
    }
    Ok(Wav { sample_hz: spec.sample_rate / together, samples, notes })
}

/// Corrects the length of the samples in the header: a program that writes to a pipe leaves 0 or a number beyond the
/// end of the file. Returns a note if it was corrected.
fn correct_length(wav: &mut [u8]) -> Option<String> {
    let mut at = FORM_HEAD;
    let mut frame_bytes = 1;
    let (start, stated) = loop {
        let (name, len) = chunk(wav, at)?;
        let start = at + CHUNK_HEAD;
        match &name {
            b"data" => break (start, len),
            b"fmt " => {
                let align = wav.get(start + 12..start + 14)?.try_into().ok()?;
                frame_bytes = usize::from(u16::from_le_bytes(align)).max(1);
            }
            _ => {}
        }
        at = after(start, len)?;
    };
    let there = wav.len() - start;
    if stated > there || (stated == 0 && there > 0 && !are_chunks(wav, start)) {
        let whole = there - there % frame_bytes;
        let len = u32::try_from(whole).ok()?.to_le_bytes();
        wav.get_mut(start - 4..start)?.copy_from_slice(&len);
        return Some(format!(
            "its header states {stated} bytes of samples, as after writing to a pipe; all {whole} bytes in the file are \
             played"
        ));
    }
    None
}

/// Name and length of the chunk that begins here.
fn chunk(wav: &[u8], at: usize) -> Option<([u8; 4], usize)> {
    let head = wav.get(at..at + CHUNK_HEAD)?;
    let (name, len) = head.split_first_chunk::<4>()?;
    Some((*name, usize::try_from(u32::from_le_bytes(len.try_into().ok()?)).ok()?))
}

/// Offset of the next chunk, which is even.
fn after(start: usize, len: usize) -> Option<usize> {
    start.checked_add(len)?.checked_next_multiple_of(2)
}

/// Whether the rest of the file consists of whole chunks.
fn are_chunks(wav: &[u8], mut at: usize) -> bool {
    while let Some((_, len)) = chunk(wav, at) {
        let Some(next) = after(at + CHUNK_HEAD, len) else { return false };
        at = next;
    }
    at >= wav.len() && at <= wav.len() + 1
}

/// The least number of samples to average into one for an integer rate of at most `max_hz`.
fn samples_together(sample_hz: u32, max_hz: u32) -> u32 {
    let least = sample_hz.div_ceil(max_hz.max(1)).max(1);
    (least..=sample_hz).find(|together| sample_hz.is_multiple_of(*together)).unwrap_or(sample_hz.max(1))
}

/// Means of `together` samples each, where 1 becomes 65,535.
#[derive(Default)]
struct Means {
    together: u32,
    sum: f64,
    count: u32,
    means: Vec<u16>,
    /// Samples that are not from 0 to 1.
    beyond: u64,
}

impl Means {
    fn push(&mut self, sample: f64) {
        self.beyond += u64::from(!(0.0..=1.0).contains(&sample));
        self.sum += sample;
        self.count += 1;
        if self.count == self.together {
            self.end();
        }
    }

    fn end(&mut self) {
        let mean = self.sum / f64::from(self.count);
        self.means.push((65_535.0 * mean.clamp(0.0, 1.0)).round() as u16);
        (self.sum, self.count) = (0.0, 0);
    }

    /// The means, the last one of fewer samples.
    fn finish(mut self) -> Vec<u16> {
        if self.count > 0 {
            self.end();
        }
        self.means
    }
}
