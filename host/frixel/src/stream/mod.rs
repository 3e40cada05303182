//! Samples for stream layers: from a WAV file, or raw from a pipe, and on to a board as fast as it plays them.

mod pipe;
#[cfg(test)]
mod tests;
mod wav;

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use thiserror::Error;

use frixel_driver::{Device, DeviceError, Link, StreamSettings};
use pipe::Pipe;

/// Samples that are read from their source before the board has room for them.
const AHEAD: usize = 2048;

/// Samples on their way to a board.
///
/// A sample is a `u16`: 0 is the layer's low friction, 65,535 its high one.
pub struct Feed {
    settings: StreamSettings,
    source: Source,
    pending: Vec<u16>,
    ended: bool,
}

enum Source {
    /// All samples, and how many of them were taken.
    Samples(Vec<u16>, usize),
    Pipe(Pipe),
}

/// Why there are no samples to stream, or no more of them.
#[derive(Debug, Error)]
pub enum FeedError {
    /// The file is not there, or is no WAV file that can be read.
    #[error(
        "{} cannot be streamed ({source}): give a WAV file of 8, 16, 24 or 32 bits, or of 32-bit floats",
        path.display()
    )]
    Wav {
        /// The file.
        path: PathBuf,
        /// What the reader says.
        source: hound::Error,
    },
    /// The file has no samples.
    #[error("{} has no samples: there is nothing to stream", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// A float that is no number.
    #[error("sample {index} of {} is not a number: export the file anew", path.display())]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// Which sample, from zero, counted in the first channel.
        index: usize,
    },
    /// No samples a second, or more than the board plays.
    #[error(
        "a stream of {sample_hz} samples a second cannot be played: give 1 to {tick_hz}, the board's ticks a second"
    )]
    Rate {
        /// Samples a second that were requested.
        sample_hz: u32,
        /// The board's ticks a second.
        tick_hz: u32,
    },
    /// The pipe broke.
    #[error("the samples on standard input cannot be read ({0}): the stream ends here")]
    Pipe(io::Error),
    /// The board refused, or fell silent.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl Feed {
    /// The first channel of a WAV file, with its lowest value at 0 and its highest at 65,535: silence is half way
    /// between low and high friction.
    ///
    /// A file of more samples a second than the board has ticks is brought below that, each sample then the mean of two
    /// or more; [`Self::settings`] says what came out.
    pub fn wav(path: &Path, tick_hz: u32) -> Result<Self, FeedError> {
        let (sample_hz, samples) = wav::read(path, tick_hz)?;
        Ok(Self::of(samples, sample_hz))
    }

    /// Raw samples, two bytes each, little-endian, from a pipe that is read by a thread of its own.
    ///
    /// With `waits`, an empty pipe is waited for, as suits a board in virtual time. Otherwise the board runs dry.
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

    /// Samples that are all in memory.
    pub fn of(samples: Vec<u16>, sample_hz: u32) -> Self {
        let settings = StreamSettings::new(sample_hz);
        Self { settings, source: Source::Samples(samples, 0), pending: Vec::new(), ended: false }
    }

    /// Sample rate and start level.
    pub fn settings(&self) -> StreamSettings {
        self.settings
    }

    /// Starts the stream on a board that plays, and sends the first samples.
    pub fn start<L: Link>(&mut self, device: &mut Device<L>) -> Result<(), FeedError> {
        device.start_stream(self.settings)?;
        self.pump(device)
    }

    /// Sends what the board has room for, and ends the stream behind the last sample. Call this every few milliseconds.
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
