//! The touch source: a touchscreen that samples the finger periodically, and reports it with latency, jitter and
//! noise.

use std::collections::VecDeque;

use frixel_session::Touch;

use crate::error::{OutOfRange, above_zero, zero_to_ten};
use crate::random::{Purpose, Random};
use crate::stroke::FingerState;

/// Jitter is truncated at this many standard deviations.
const JITTER_LIMIT: f64 = 3.0;

/// Configuration of a touch source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchConfig {
    /// Reports a second, above 0 and at most one a tick.
    pub rate_hz: f64,
    /// Time from the sample to its arrival at the board, as stated by the source, in seconds: 0 to 10.
    pub latency_s: f64,
    /// Gaussian noise of the reported place in each axis, root mean square, in metres: 0 to 10.
    pub noise_rms_m: f64,
    /// Standard deviation of the Gaussian jitter of the arrival, in seconds: 0 to 10. It is not reported to the board.
    ///
    /// Draws beyond three standard deviations are repeated, which leaves 98.7 % of the deviation. A report never
    /// arrives before its sample, nor before the previous report.
    pub jitter_rms_s: f64,
}

impl Default for TouchConfig {
    /// An infrared frame or a fast touch panel: 100 Hz, 10 ms of latency, 0.02 mm of noise, 0.5 ms of jitter.
    fn default() -> Self {
        Self { rate_hz: 100.0, latency_s: 10e-3, noise_rms_m: 0.02e-3, jitter_rms_s: 0.5e-3 }
    }
}

/// A report on its way to the board.
#[derive(Clone, Copy, Debug)]
struct Report {
    arrival_tick: u64,
    touch: Touch,
}

/// The touch source.
///
/// It samples at whole ticks. The first sample without a finger reports the lift; there are no more reports until the
/// finger touches again.
#[derive(Clone, Debug)]
pub(crate) struct TouchSource {
    period_ticks: f64,
    phase_ticks: f64,
    latency_ticks: u32,
    jitter_rms_ticks: f64,
    noise_rms_m: f64,
    noise: Random,
    jitter: Random,
    samples: u64,
    next_sample_tick: u64,
    finger_was_down: bool,
    /// Reports in the order of their samples: each arrives before the next.
    under_way: VecDeque<Report>,
    arrived: Option<Touch>,
}

impl TouchSource {
    /// A touch source whose first sample comes at a random time within the first report period.
    pub(crate) fn new(config: &TouchConfig, tick_hz: u32, seed: u64) -> Result<Self, OutOfRange> {
        let tick_hz = f64::from(tick_hz);
        let rate_hz = above_zero("touch rate_hz", config.rate_hz)?;
        if rate_hz > tick_hz {
            return Err(OutOfRange { name: "touch rate_hz", expected: "at most the tick rate", found: rate_hz });
        }
        let latency_ticks = libm::round(zero_to_ten("touch latency_s", config.latency_s)? * tick_hz);
        if latency_ticks > f64::from(u32::MAX) {
            return Err(OutOfRange { name: "touch latency_s", expected: "below 2^32 ticks", found: config.latency_s });
        }
        let period_ticks = tick_hz / rate_hz;
        let phase_ticks = Random::new(seed, Purpose::ReportPhase).uniform() * period_ticks;
        Ok(Self {
            period_ticks,
            phase_ticks,
            latency_ticks: latency_ticks as u32,
            jitter_rms_ticks: zero_to_ten("touch jitter_rms_s", config.jitter_rms_s)? * tick_hz,
            noise_rms_m: zero_to_ten("touch noise_rms_m", config.noise_rms_m)?,
            noise: Random::new(seed, Purpose::PlaceNoise),
            jitter: Random::new(seed, Purpose::ReportJitter),
            samples: 0,
            next_sample_tick: phase_ticks as u64,
            finger_was_down: false,
            under_way: VecDeque::new(),
            arrived: None,
        })
    }

    /// Advances to `tick`, at which the finger is at `finger`. Must be called for every tick from 0.
    pub(crate) fn tick(&mut self, tick: u64, finger: Option<&FingerState>) {
        if tick >= self.next_sample_tick {
            self.sample(tick, finger);
        }
        self.arrived = match self.under_way.front() {
            Some(report) if report.arrival_tick <= tick => self.under_way.pop_front().map(|report| report.touch),
            _ => None,
        };
    }

    /// Returns the report that arrived at the current tick.
    pub(crate) fn arrived(&self) -> Option<Touch> {
        self.arrived
    }

    fn sample(&mut self, tick: u64, finger: Option<&FingerState>) {
        self.samples += 1;
        self.next_sample_tick = (self.phase_ticks + self.samples as f64 * self.period_ticks) as u64;
        // Drawn for every sample, so that lifts do not shift the noise of later samples.
        let x_noise_m = self.noise.gaussian() * self.noise_rms_m;
        let y_noise_m = self.noise.gaussian() * self.noise_rms_m;
        let jitter_ticks = self.jitter.gaussian_within(JITTER_LIMIT) * self.jitter_rms_ticks;
        let touch = match finger {
            Some(finger) => Touch::Down {
                x_m: (finger.x_m + x_noise_m) as f32,
                y_m: (finger.y_m + y_noise_m) as f32,
                age_ticks: self.latency_ticks,
            },
            None if self.finger_was_down => Touch::Up,
            None => return,
        };
        self.finger_was_down = finger.is_some();
        let delay_ticks = libm::round(f64::from(self.latency_ticks) + jitter_ticks).max(0.0) as u64;
        self.under_way.push_back(Report { arrival_tick: tick + delay_ticks, touch });
    }
}

#[cfg(test)]
mod tests;
