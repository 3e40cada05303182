//! Noise that masks what an electrode sounds like.

use std::io::Cursor;

use anyhow::{Result, anyhow};
use hound::{SampleFormat, WavSpec, WavWriter};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Duration, in seconds.
const DURATION_S: u32 = 60;
const SAMPLE_HZ: u32 = 44_100;

/// White noise, as a WAV file.
pub(super) fn wav(seed: u64) -> Result<Vec<u8>> {
    let spec = WavSpec { channels: 1, sample_rate: SAMPLE_HZ, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let failed = |error| anyhow!("the noise cannot be made ({error})");
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = WavWriter::new(&mut bytes, spec).map_err(failed)?;
    let mut random = Pcg64::seed_from_u64(seed);
    for _ in 0..DURATION_S * SAMPLE_HZ {
        // A quarter of full scale, which leaves room for any player's volume.
        writer.write_sample((random.next_u64() >> 48) as u16 as i16 / 4).map_err(failed)?;
    }
    writer.finalize().map_err(failed)?;
    Ok(bytes.into_inner())
}
