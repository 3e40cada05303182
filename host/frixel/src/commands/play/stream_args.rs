//! `--stream`: where samples for stream layers come from.

use std::io::stdin;
use std::path::{Path, PathBuf};

use clap::Args;
use frixel_play::Feed;

use crate::stream;

use super::CommandError;
use super::target::Target;

/// The name of standard input.
const STANDARD_INPUT: &str = "-";

#[derive(Clone, Debug, Default, Args)]
pub(super) struct StreamArgs {
    /// Samples for the scene's stream layers: a WAV file, or `-` for raw ones on standard input, two bytes each,
    /// little-endian.
    #[arg(long, value_name = "FILE.wav")]
    stream: Option<PathBuf>,
    /// Sample rate of standard input, in Hz.
    #[arg(long, value_name = "HZ")]
    stream_hz: Option<u32>,
    /// The samples that a recording has.
    #[arg(skip)]
    recorded: Option<Box<RecordedStream>>,
}

/// What was streamed to the board of a recording.
#[derive(Clone, Debug)]
pub(super) struct RecordedStream {
    pub(super) sample_hz: u32,
    pub(super) samples: Vec<u16>,
    /// Whether the stream ended after the last of them.
    pub(super) is_ended: bool,
    /// Duration of the file that they came from, s; `None` for standard input.
    pub(super) file_s: Option<f64>,
}

impl StreamArgs {
    /// The stream of a recorded play.
    pub(super) fn of_recording(recorded: Option<RecordedStream>) -> Self {
        Self { recorded: recorded.map(Box::new), ..Self::default() }
    }

    pub(super) fn is_given(&self) -> bool {
        self.stream.is_some()
    }

    pub(super) fn is_standard_input(&self) -> bool {
        self.stream.as_deref() == Some(Path::new(STANDARD_INPUT))
    }

    /// The file of the samples, or the name of standard input.
    pub(super) fn file(&self) -> Option<&Path> {
        self.stream.as_deref()
    }

    /// Opens the source of the samples. The simulator waits when a pipe is empty; other boards run out of samples.
    pub(super) fn open(&self, tick_hz: u32, target: Target) -> Result<Option<Feed>, CommandError> {
        if let Some(recorded) = &self.recorded {
            return Ok(Some(recorded.feed()));
        }
        let waits = target == Target::Simulator;
        match (&self.stream, self.stream_hz) {
            (None, None) => Ok(None),
            (None, Some(_)) => Err(CommandError::StreamRateAlone),
            (Some(_), Some(sample_hz)) if self.is_standard_input() => {
                Ok(Some(stream::raw(stdin(), sample_hz, tick_hz, waits)?))
            }
            (Some(_), None) if self.is_standard_input() => Err(CommandError::StreamRateMissing),
            (Some(path), Some(_)) => Err(CommandError::StreamRateOfFile { path: path.clone() }),
            (Some(path), None) => Ok(Some(stream::wav(path, tick_hz)?)),
        }
    }

    /// Duration of the file of [`Self::open`], s; `None` without a file.
    pub(super) fn file_s(&self, feed: Option<&Feed>) -> Option<f64> {
        self.recorded.as_ref().map_or_else(|| feed.and_then(Feed::duration_s), |recorded| recorded.file_s)
    }
}

impl RecordedStream {
    /// Gives the samples as fast as the board takes them. Behind the last one comes the end of the stream, or, if the
    /// play ended before it, nothing.
    fn feed(&self) -> Feed {
        let Self { sample_hz, is_ended, .. } = *self;
        let mut samples = self.samples.clone().into_iter();
        Feed::fetched(sample_hz, move |pending, len| {
            pending.extend(samples.by_ref().take(len.saturating_sub(pending.len())));
            Ok(!is_ended || samples.len() > 0)
        })
    }
}
