//! Samples for stream layers, from a WAV file or a pipe.

mod pipe;
#[cfg(test)]
mod tests;
mod wav;

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use frixel_play::Feed;
use thiserror::Error;

use pipe::Pipe;

/// Errors of the source of samples.
#[derive(Debug, Error)]
pub enum StreamError {
    /// The file does not exist, or is not a supported WAV file.
    #[error(
        "{} cannot be streamed ({source}): give a WAV file of 8, 16, 24 or 32 bits, or of 32-bit floats",
        path.display()
    )]
    Wav {
        /// Path of the file.
        path: PathBuf,
        /// Error of the WAV reader.
        source: hound::Error,
    },
    /// The file has no samples.
    #[error("{} has no samples: there is nothing to stream", path.display())]
    Empty {
        /// Path of the file.
        path: PathBuf,
    },
    /// A floating-point sample is not a number.
    #[error("sample {index} of {} is not a number: export the file again", path.display())]
    NotANumber {
        /// Path of the file.
        path: PathBuf,
        /// Index of the sample in the first channel, from zero.
        index: usize,
    },
    /// The sample rate is zero, or above the tick rate of the board.
    #[error("a sample rate of {sample_hz} Hz cannot be played: use 1 to {tick_hz} Hz, the board's tick rate")]
    Rate {
        /// Requested sample rate, in samples per second.
        sample_hz: u32,
        /// Tick rate of the board, in ticks per second.
        tick_hz: u32,
    },
    /// Reading the pipe failed.
    #[error("the samples on standard input cannot be read ({0}): the stream ends here")]
    Pipe(io::Error),
}

/// Reads the first channel of a WAV file. Its lowest value becomes 0 and its highest 65,535, so silence is half way
/// between low and high friction.
///
/// If the file has more samples per second than the board has ticks, two or more samples are averaged into one;
/// [`Feed::settings`] returns the resulting rate.
///
/// Also returns notes on the file, one sentence each.
pub fn wav(path: &Path, tick_hz: u32) -> Result<(Feed, Vec<String>), StreamError> {
    let wav::Wav { sample_hz, samples, notes } = wav::read(path, tick_hz)?;
    Ok((Feed::of(samples, sample_hz), notes))
}

/// Reads raw samples, two bytes each, little-endian, from a pipe in a separate thread.
///
/// If `waits` is true, an empty pipe blocks the play, which suits a board in virtual time. Otherwise the board runs
/// out of samples.
pub(crate) fn raw(
    input: impl Read + Send + 'static,
    sample_hz: u32,
    tick_hz: u32,
    waits: bool,
) -> Result<Feed, StreamError> {
    if sample_hz == 0 || sample_hz > tick_hz {
        return Err(StreamError::Rate { sample_hz, tick_hz });
    }
    let mut pipe = Pipe::open(input, waits).map_err(StreamError::Pipe)?;
    Ok(Feed::fetched(sample_hz, move |samples, len| Ok(pipe.fetch(samples, len).map_err(StreamError::Pipe)?)))
}
