//! Samples for stream layers, sent to a board as fast as it plays them.

use std::error::Error;
use std::time::Duration;

use frixel_driver::{Device, DeviceError, Link, StreamSettings, StreamStatus};
use frixel_felt::recorder::PlayListener as _;
use thiserror::Error;

use crate::recorded::Recorded;

/// Number of samples to read ahead, before the board has room for them.
const AHEAD: usize = 2048;
/// Time for requests at the start of a stream, and for its fade, s.
const END_S: f64 = 0.05;

/// A source of samples for a board.
///
/// A sample is a `u16`: 0 stands for the layer's low friction, 65,535 for its high friction.
pub struct Feed {
    settings: StreamSettings,
    fetch: Fetch,
    /// Number of samples, if it is known beforehand.
    samples: Option<u64>,
    pending: Vec<u16>,
    /// Time on the link's clock when the stream started.
    started_at: Option<Duration>,
    /// Time on the link's clock when the last sample was sent.
    ended_at: Option<Duration>,
}

/// Why a source of samples has failed.
type SourceError = Box<dyn Error + Send + Sync>;

/// Appends samples up to a given number, or as many as are available. Returns false after the last one.
type Fetch = Box<dyn FnMut(&mut Vec<u16>, usize) -> Result<bool, SourceError>>;

/// Why samples could not be streamed to their end.
#[derive(Debug, Error)]
pub enum FeedError {
    /// The source of the samples has failed.
    #[error(transparent)]
    Source(SourceError),
    /// The board refused a request, or stopped answering.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl Feed {
    /// Creates a feed from samples in memory.
    pub fn of(samples: Vec<u16>, sample_hz: u32) -> Self {
        let count = samples.len() as u64;
        let mut samples = samples.into_iter();
        let feed = Self::fetched(sample_hz, move |pending, len| {
            pending.extend(samples.by_ref().take(len.saturating_sub(pending.len())));
            Ok(samples.len() > 0)
        });
        Self { samples: Some(count), ..feed }
    }

    /// Creates a feed of samples that become available during the play.
    ///
    /// `fetch` appends samples up to the given number, or as many as are available. It returns false after the last
    /// one. If it waits for samples, the play waits as well, which suits a board in virtual time only.
    pub fn fetched(
        sample_hz: u32,
        fetch: impl FnMut(&mut Vec<u16>, usize) -> Result<bool, SourceError> + 'static,
    ) -> Self {
        let (settings, fetch) = (StreamSettings::new(sample_hz), Box::new(fetch));
        Self { settings, fetch, samples: None, pending: Vec::new(), started_at: None, ended_at: None }
    }

    /// The sample rate and the start level.
    pub fn settings(&self) -> StreamSettings {
        self.settings
    }

    /// Starts the stream on a board that is playing, and sends the first samples.
    pub fn start<L: Link + Recorded>(&mut self, device: &mut Device<L>) -> Result<(), FeedError> {
        device.link_mut().recorder_mut().stream_started(self.settings.sample_hz);
        device.start_stream(self.settings)?;
        self.started_at = Some(device.now());
        self.pump(device)
    }

    /// Sends as many samples as the board has room for, and ends the stream after the last one. Call this every few
    /// milliseconds.
    pub fn pump<L: Link + Recorded>(&mut self, device: &mut Device<L>) -> Result<(), FeedError> {
        while self.ended_at.is_none() {
            let more = (self.fetch)(&mut self.pending, AHEAD).map_err(FeedError::Source)?;
            let sent = device.send_samples(&self.pending)?;
            let taken: Vec<u16> = self.pending.drain(..sent).collect();
            if sent > 0 {
                device.link_mut().recorder_mut().samples_sent(&taken);
            }
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

    /// Duration of the stream until it has faded out, without delays, in s.
    ///
    /// `None` if the samples become available during the play.
    pub fn duration_s(&self) -> Option<f64> {
        self.samples.map(|samples| self.playing_s(samples, 0))
    }

    /// Whether the board has played the last sample and has faded out.
    pub fn is_over<L: Link>(&self, device: &Device<L>) -> bool {
        let (Some(started_at), Some(ended_at)) = (self.started_at, self.ended_at) else { return false };
        let StreamStatus { sent, underruns, .. } = device.stream_status().unwrap_or_default();
        let since = |from: Duration| device.now().saturating_sub(from).as_secs_f64();
        since(started_at) >= self.playing_s(sent, underruns) && since(ended_at) >= self.playing_s(0, 0)
    }

    /// Time to play so many samples, s: the board fills its buffer to the start level first, and again after an
    /// underrun.
    fn playing_s(&self, samples: u64, underruns: u32) -> f64 {
        let StreamSettings { sample_hz, start_level } = self.settings;
        let filled = f64::from(start_level) * (1.0 + f64::from(underruns));
        (samples as f64 + filled) / f64::from(sample_hz) + END_S
    }
}
