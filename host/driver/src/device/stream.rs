//! Streams: samples for the stream layers of the playing scene, sent as fast as the board plays them.

use std::time::Duration;

use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, STREAM_START_LEVEL_MAX};
use frixel_wire::payload::{SAMPLES_MAX, samples_frame};

use super::Device;
use crate::error::DeviceError;
use crate::exchange::StreamReport;
use crate::link::Link;

/// The name of streaming in error messages.
const STREAMING: &str = "stream";
/// Duration of the default start level, s: about the longest delay of a host by its operating system.
const START_S: f64 = 0.05;

/// Parameters of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamSettings {
    /// Samples per second, from 1 to the board's tick rate.
    pub sample_hz: u32,
    /// Samples buffered before the board starts to play, 1 to 800. Their duration is the stream's latency, and the
    /// longest pause of the host without an underrun.
    pub start_level: u16,
}

impl StreamSettings {
    /// Settings with a start level of 50 ms, or the largest one if the board's buffer is shorter.
    pub fn new(sample_hz: u32) -> Self {
        let level = (START_S * f64::from(sample_hz)).ceil();
        Self { sample_hz, start_level: level.clamp(1.0, f64::from(STREAM_START_LEVEL_MAX)) as u16 }
    }
}

/// The state of a stream, as of the board's last report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StreamStatus {
    /// Samples sent.
    pub sent: u64,
    /// Underruns, at each of which the board faded the stream out.
    pub underruns: u32,
    /// Runs of samples that the line lost.
    pub gaps: u32,
}

/// Progress of a stream.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StreamProgress {
    samples: u64,
    /// The board's first report. It counts from power-on, so later counts are relative to this report.
    first: Option<StreamReport>,
}

impl<L: Link> Device<L> {
    /// Starts a stream for the stream layers of the playing scene, in place of a current stream.
    ///
    /// Send the samples with [`Self::send_samples`], and call [`Self::wait`] between two calls.
    ///
    /// ```no_run
    /// # use std::time::Duration;
    /// # use frixel_driver::{Device, DeviceError, Link, StreamSettings};
    /// # fn play<L: Link>(board: &mut Device<L>, mut samples: &[u16]) -> Result<(), DeviceError> {
    /// board.start_stream(StreamSettings::new(8_000))?;
    /// while !samples.is_empty() {
    ///     let sent = board.send_samples(samples)?;
    ///     samples = &samples[sent..];
    ///     board.wait(Duration::from_millis(5), &mut |_| {})?;
    /// }
    /// board.end_stream()
    /// # }
    /// ```
    pub fn start_stream(&mut self, settings: StreamSettings) -> Result<(), DeviceError> {
        let StreamSettings { sample_hz, start_level } = settings;
        self.exchange.stream_begins = true;
        self.request(Command::StartStream { sample_hz, start_level })?;
        self.stream = Some(StreamProgress::default());
        Ok(())
    }

    /// Sends as many samples as the board has room for, and returns their number. A sample of 0 is the layer's low
    /// friction, 65,535 its high friction. Does not wait.
    ///
    /// Sends nothing if no stream is under way.
    pub fn send_samples(&mut self, samples: &[u16]) -> Result<usize, DeviceError> {
        self.exchange.receive(Duration::ZERO, STREAMING)?;
        let (Some(mut sent), Some(report)) = (self.stream, self.exchange.stream) else { return Ok(0) };
        sent.first.get_or_insert(report);
        let mut done = 0;
        for frame in samples.chunks(SAMPLES_MAX) {
            let index = sent.samples as u32;
            let room = report.limit.wrapping_sub(index) as i32;
            if room < frame.len() as i32 {
                break;
            }
            let mut buffer = [0; FRAME_MAX_LEN];
            let bytes = samples_frame(index, frame, &mut buffer)?;
            if self.exchange.send_bulk(bytes, STREAMING)?.is_none() {
                break;
            }
            sent.samples += frame.len() as u64;
            done += frame.len();
        }
        self.stream = Some(sent);
        Ok(done)
    }

    /// Ends the stream: the board plays the samples that it has, and fades out. This does not count as an underrun.
    pub fn end_stream(&mut self) -> Result<(), DeviceError> {
        self.request(Command::EndStream)
    }

    /// The state of the last stream; `None` before the first one.
    pub fn stream_status(&self) -> Option<StreamStatus> {
        let StreamProgress { samples, first } = self.stream?;
        let (Some(first), Some(now)) = (first, self.exchange.stream) else {
            return Some(StreamStatus { sent: samples, ..StreamStatus::default() });
        };
        Some(StreamStatus {
            sent: samples,
            underruns: now.underruns.wrapping_sub(first.underruns),
            gaps: now.gaps.wrapping_sub(first.gaps),
        })
    }
}
