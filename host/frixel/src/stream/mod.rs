//! Samples for stream layers: reads them from a WAV file or a pipe, and sends them to a board as fast as it plays them.

mod pipe;
#[cfg(test)]
mod tests;
mod wav;

use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::Duration;

use thiserror::Error;

use frixel_driver::{Device, DeviceError, Link, StreamSettings, StreamStatus};
use pipe::Pipe;

use crate::rigs::RecordedLink;

/// Samples that are read ahead, before the board has room for them.
const AHEAD: usize = 2048;
/// Time for requests at the start of a stream, and for its fade, s.
const END_S: f64 = 0.05;

/// A source of samples for a board.
///
/// A sample is a `u16`: 0 stands for the layer's low friction, 65,535 for its high friction.
pub struct Feed {
    settings: StreamSettings,
    source: Source,
    pending: Vec<u16>,
    /// Time on the link's clock when the stream started.
    started_at: Option<Duration>,
    /// Time on the link's clock when the last sample was sent.
    ended_at: Option<Duration>,
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
        Ok(Self {
            settings: StreamSettings::new(sample_hz),
            source,
            pending: Vec::new(),
            started_at: None,
            ended_at: None,
        })
    }

    /// Creates a feed from samples in memory.
    pub fn of(samples: Vec<u16>, sample_hz: u32) -> Self {
        let settings = StreamSettings::new(sample_hz);
        Self { settings, source: Source::Samples(samples, 0), pending: Vec::new(), started_at: None, ended_at: None }
    }

    /// The sample rate and the start level.
    pub fn settings(&self) -> StreamSettings {
        self.settings
    }

    /// Starts the stream on a board that is playing, and sends the first samples.
    pub fn start<L: RecordedLink>(&mut self, device: &mut Device<L>) -> Result<(), FeedError> {
        device.link_mut().recorder_mut().stream_started(self.settings.sample_hz);
        device.start_stream(self.settings)?;
        self.started_at = Some(device.now());
        self.pump(device)
    }

    /// Sends as many samples as the board has room for, and ends the stream after the last one. Call this every few
    /// milliseconds.
    pub fn pump<L: RecordedLink>(&mut self, device: &mut Device<L>) -> Result<(), FeedError> {
        while self.ended_at.is_none() {
            let more = self.fetch()?;
            let sent = device.send_samples(&self.pending)?;
            let taken: Vec<u16> = self.pending.drain(..sent).collect();
            device.link_mut().recorder_mut().samples_sent(&taken);
            if !more && self.pending.is_empty() {
                self.ended_at = Some(device.now());
                device.link_mut().recorder_mut().stream_ended();
                device.end_stream()?;
            }
            if sent == 0 {
                break;
            }
        }
        Ok(())
    }

    /// Time that the stream takes from its start until it has faded out, if nothing delays it, in s; `None` for a pipe.
    pub fn duration_s(&self) -> Option<f64> {
        match &self.source {
            Source::Samples(samples, _) => Some(self.playing_s(samples.len() as u64, 0)),
            Source::Pipe(_) => None,
        }
    }

    /// Whether the board has played the last sample and has faded out.
    pub fn is_over<L: Link>(&self, device: &Device<L>) -> bool {
        let (Some(started_at), Some(ended_at)) = (self.started_at, self.ended_at) else { return false };
        let StreamStatus { sent, underruns, .. } = device.stream_status().unwrap_or_default();
        let since = |from: Duration| device.now().saturating_sub(from).as_secs_f64();
        since(started_at) >= self.playing_s(sent, underruns) && since(ended_at) >= self.playing_s(0, 0)
    }

    /// Time to play so many samples: the board fills its buffer to the start level first, and again after an underrun.
    fn playing_s(&self, samples: u64, underruns: u32) -> f64 {
        let StreamSettings { sample_hz, start_level } = self.settings;
        let filled = f64::from(start_level) * (1.0 + f64::from(underruns));
        (samples as f64 + filled) / f64::from(sample_hz) + END_S
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
