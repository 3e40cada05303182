//! Samples for stream layers: reads them from a WAV file or a pipe, and sends them to a board as fast as it plays them.

mod pipe;
#[cfg(test)]
mod tests;
mod wav;

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use thiserror::Error;

use frixel_driver::{Device, DeviceError, Link, StreamSettings};
use pipe::Pipe;

/// Samples that are read ahead, before the board has room for them.
const AHEAD: usize = 2048;

/// A source of samples for a board.
///
/// A sample is a `u16`: 0 stands for the layer's low friction, 65,535 for its high friction.
pub struct Feed {
    settings: StreamSettings,
    source: Source,
    pending: Vec<u16>,
    ended: bool,
}

enum Source {
    /// All samples, and how many of them have been sent.
    Samples(Vec<u16>, usize),
    Pipe(Pipe),
}

/// Why samples are missing, or could not be streamed to their end.
#[derive(Debug, Error)]
pub enum FeedError {
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
    #[error("sample {index} of {} is not a number: export the file anew", path.display())]
    NotANumber {
        /// Path of the file.
        path: PathBuf,
        /// Index of the sample in the first channel, from zero.
        index: usize,
    },
    /// The sample rate is zero, or above the tick rate of the board.
    #[error(
        "a stream of {sample_hz} samples a second cannot be played: give 1 to {tick_hz}, the board's ticks a second"
    )]
    Rate {
        /// Requested sample rate, in samples per second.
        sample_hz: u32,
        /// Tick rate of the board, in ticks per second.
        tick_hz: u32,
    },
    /// Reading the pipe failed.
    #[error("the samples on standard input cannot be read ({0}): the stream ends here")]
    Pipe(io::Error),
    /// The board rejected a request, or stopped answering.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl Feed {
    /// Reads the first channel of a WAV file. Its lowest value becomes 0 and its highest 65,535, so silence is half way
    /// between low and high friction.
    ///
    /// If the file has more samples per second than the board has ticks, two or more samples are averaged into one;
    /// [`Self::settings`] returns the resulting rate.
    pub fn wav(path: &Path, tick_hz: u32) -> Result<Self, FeedError> {
        let (sample_hz, samples) = wav::read(path, tick_hz)?;
        Ok(Self::of(samples, sample_hz))
    }

    /// Reads raw samples, two bytes each, little-endian, from a pipe in a separate thread.
    ///
    /// If `waits` is true, an empty pipe blocks the play, which suits a board in virtual time. Otherwise the board runs
    /// out of samples.
    pub fn raw(
        input: impl Read + Send + 'static,
        sample_hz: u32,
        tick_hz: u32,
        waits: bool,
    ) -> Result<Self, FeedError> {
        if sample_hz == 0 || sample_hz > tick_hz {
            return Err(FeedError::Rate { sample_hz, tick_hz });
        }
        let source = Source::Pipe(Pipe::open(input, waits).map_err(FeedError::Pipe)?);
        Ok(Self { settings: StreamSettings::new(sample_hz), source, pending: Vec::new(), ended: false })
    }

    /// Creates a feed from samples in memory.
    pub fn of(samples: Vec<u16>, sample_hz: u32) -> Self {
        let settings = StreamSettings::new(sample_hz);
        Self { settings, source: Source::Samples(samples, 0), pending: Vec::new(), ended: false }
    }

    /// The sample rate and the start level.
    pub fn settings(&self) -> StreamSettings {
        self.settings
    }

    /// Starts the stream on a board that is playing, and sends the first samples.
    pub fn start<L: Link>(&mut self, device: &mut Device<L>) -> Result<(), FeedError> {
        device.start_stream(self.settings)?;
        self.pump(device)
    }

    /// Sends as many samples as the board has room for, and ends the stream after the last one. Call this every few
    /// milliseconds.
    pub fn pump<L: Link>(&mut self, device: &mut Device<L>) -> Result<(), FeedError> {
        while !self.ended {
            let more = self.fetch()?;
            let sent = device.send_samples(&self.pending)?;
            self.pending.drain(..sent);
            if !more && self.pending.is_empty() {
                self.ended = true;
                device.end_stream()?;
            }
            if sent == 0 {
                break;
            }
        }
        Ok(())
    }

    /// Reads samples from the source until [`AHEAD`] are pending. Returns whether there may be more.
    fn fetch(&mut self) -> Result<bool, FeedError> {
        let wanted = AHEAD.saturating_sub(self.pending.len());
        match &mut self.source {
            Source::Samples(samples, taken) => {
                let rest = samples.get(*taken..).unwrap_or_default();
                let piece = rest.get(..wanted).unwrap_or(rest);
                self.pending.extend_from_slice(piece);
                *taken += piece.len();
                Ok(*taken < samples.len())
            }
            Source::Pipe(pipe) => pipe.fetch(&mut self.pending, AHEAD).map_err(FeedError::Pipe),
        }
    }
}
