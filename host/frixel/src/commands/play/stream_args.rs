//! `--stream`: the source of the samples for stream layers.

use std::io::stdin;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;
use frixel_play::Feed;

use crate::stream;

use super::super::argument::RARE;
use super::super::terminal::note;
use super::Target;

/// The name of standard input.
const STANDARD_INPUT: &str = "-";

#[derive(Clone, Debug, Args)]
pub(super) struct StreamArgs {
    /// Samples of stream layers: a WAV file, or `-` for 16-bit little-endian standard input.
    #[arg(long, value_name = "FILE.wav")]
    stream: Option<PathBuf>,
    /// Sample rate of standard input, in Hz.
    #[arg(long, value_name = "HZ", help_heading = RARE)]
    stream_hz: Option<u32>,
}

impl StreamArgs {
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
    pub(super) fn open(&self, tick_hz: u32, target: Target) -> Result<Option<Feed>> {
        let waits = target == Target::Sim;
        match (&self.stream, self.stream_hz) {
            (None, None) => Ok(None),
            (None, Some(_)) => {
                bail!("--stream-hz is the sample rate of standard input: put --stream - before it, or leave it out")
            }
            (Some(_), Some(sample_hz)) if self.is_standard_input() => {
                Ok(Some(stream::raw(stdin(), sample_hz, tick_hz, waits)?))
            }
            (Some(_), None) if self.is_standard_input() => {
                bail!("samples on standard input have no rate of their own: put --stream-hz beside --stream -")
            }
            (Some(path), Some(_)) => bail!("{} has a sample rate of its own: leave --stream-hz out", path.display()),
            (Some(path), None) => {
                let (feed, notes) = stream::wav(path, tick_hz)?;
                for sentence in notes {
                    note(format_args!("{}: {sentence}", path.display()));
                }
                Ok(Some(feed))
            }
        }
    }
}
