//! Reading of WAV files.

use std::io::BufReader;
use std::path::Path;

use hound::{SampleFormat, WavReader};

use super::StreamError;
use crate::input;

/// The sample rate, reduced to at most `max_hz`, and the samples of the first channel.
pub(super) fn read(path: &Path, max_hz: u32) -> Result<(u32, Vec<u16>), StreamError> {
    let failed = |source| StreamError::Wav { path: path.to_owned(), source };
    let file = input::open(path, input::WAV_MAX_BYTES).map_err(|error| failed(error.into()))?;
    let mut reader = WavReader::new(BufReader::new(file)).map_err(failed)?;
    let spec = reader.spec();
    let channels = usize::from(spec.channels.max(1));
    let samples: Vec<f64> = match spec.sample_format {
        SampleFormat::Float => {
            let samples: Result<Vec<f32>, _> = reader.samples().step_by(channels).collect();
            samples.map_err(failed)?.into_iter().map(|sample| 0.5 + 0.5 * f64::from(sample)).collect()
        }
        SampleFormat::Int => {
            let steps = (1_u64 << spec.bits_per_sample) - 1;
            let lowest = -(1_i64 << (spec.bits_per_sample - 1));
            let samples: Result<Vec<i32>, _> = reader.samples().step_by(channels).collect();
            let part = |sample| (i64::from(sample) - lowest) as f64 / steps as f64;
            samples.map_err(failed)?.into_iter().map(part).collect()
        }
    };
    if let Some(index) = samples.iter().position(|sample| !sample.is_finite()) {
        return Err(StreamError::NotANumber { path: path.to_owned(), index });
    }
    if samples.is_empty() || spec.sample_rate == 0 {
        return Err(StreamError::Empty { path: path.to_owned() });
    }
    let together = samples_together(spec.sample_rate, max_hz);
    Ok((spec.sample_rate / together, means(&samples, together as usize)))
}

/// The least number of samples to average into one such that the rate is at most `max_hz` and an integer.
fn samples_together(sample_hz: u32, max_hz: u32) -> u32 {
    let least = sample_hz.div_ceil(max_hz.max(1)).max(1);
    (least..=sample_hz).find(|together| sample_hz.is_multiple_of(*together)).unwrap_or(sample_hz)
}

/// Means of `together` samples each, where 1 becomes 65,535.
fn means(samples: &[f64], together: usize) -> Vec<u16> {
    samples
        .chunks(together)
        .map(|few| {
            let mean = few.iter().sum::<f64>() / few.len() as f64;
            (65_535.0 * mean.clamp(0.0, 1.0)).round() as u16
        })
        .collect()
}
