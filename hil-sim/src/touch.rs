//! The touch source: a touchscreen that samples the finger periodically, and reports it with latency, jitter, noise and
//! quantisation. Some reports are lost, and others bunched.

use std::collections::VecDeque;

use frixel_session::Touch;

use crate::error::{OutOfRange, above_zero, zero_to_one, zero_to_ten};
use crate::random::{Purpose, Random};
use crate::stroke::FingerState;

/// Jitter is truncated at this many standard deviations.
const JITTER_LIMIT: f64 = 3.0;

/// Configuration of a touch source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchConfig {
    /// Reports per second, above 0 and at most one per tick.
    pub rate_hz: f64,
    /// Latency from sample to arrival at the board, as stated by the source, in seconds: 0 to 10.
    pub latency_s: f64,
    /// Gaussian position noise in each axis, rms, in metres: 0 to 10.
    pub noise_rms_m: f64,
    /// Standard deviation of the Gaussian jitter of the latency, in seconds: 0 to 10. It is not reported to the board.
    ///
    /// Jitter is truncated at three standard deviations, which leaves 98.7 % of the deviation. A report never arrives
    /// before its sample, nor before the previous report.
    pub jitter_rms_s: f64,
    /// Fraction of lost reports, from 0 to 1: 4 to 28 % of the intervals between the reports of a surface-haptic tablet
    /// were at least double (about 1,300 recorded strokes).
    pub lost_share: f64,
    /// Fraction of reports delayed until one tick before the next report, from 0 to 1.
    pub bunched_share: f64,
    /// Pauses per second in which every report is lost, from 0 to 10. Their duration is uniformly distributed up to
    /// `pause_max_s`.
    pub pause_rate_hz: f64,
    /// Longest pause, in seconds: 0 to 10. The recorded strokes had gaps of up to 140 ms.
    pub pause_max_s: f64,
    /// Position resolution in each axis, in metres: 0 (unlimited) to 10. The recorded strokes had 0.18 mm, the pixel of
    /// the tablet.
    pub step_m: f64,
}

impl TouchConfig {
    /// An infrared frame or a fast touch panel without losses: 100 Hz, 10 ms of latency, 0.02 mm of noise, 0.5 ms of
    /// jitter.
    pub const IDEAL: Self = Self {
        rate_hz: 100.0,
        latency_s: 10e-3,
        noise_rms_m: 0.02e-3,
        jitter_rms_s: 0.5e-3,
        lost_share: 0.0,
        bunched_share: 0.0,
        pause_rate_hz: 0.0,
        pause_max_s: 0.0,
        step_m: 0.0,
    };

    /// The same source with the reports of the recorded strokes: one in eight is lost, one in thirty is bunched with
    /// the next (both within the 4 to 28 % of double intervals), a pause of up to 120 ms every ten seconds (gaps of up
    /// to 140 ms including adjacent losses), and a resolution of 0.18 mm.
    pub const REALISTIC: Self = Self {
        lost_share: 0.12,
        bunched_share: 0.03,
        pause_rate_hz: 0.1,
        pause_max_s: 0.12,
        step_m: 0.18e-3,
        ..Self::IDEAL
    };

    /// The name of [`Self::REALISTIC`] among the bundled sources.
    pub const REALISTIC_NAME: &'static str = "100";

    /// The bundled source of a name, which is its number of reports per second: `100` with a latency of 10 ms, which is
    /// [`Self::REALISTIC`]; `200` with 5 ms; `500` with 3 ms. Their jitter is 5 % of the period; losses, noise and
    /// resolution are the same.
    pub fn bundled(name: &str) -> Option<Self> {
        let (_, rate_hz, latency_s) = BUNDLED.into_iter().find(|(bundled, ..)| *bundled == name)?;
        Some(Self { rate_hz, latency_s, jitter_rms_s: 0.05 / rate_hz, ..Self::REALISTIC })
    }

    /// The names of the bundled sources.
    pub fn bundled_names() -> impl Iterator<Item = &'static str> {
        BUNDLED.into_iter().map(|(name, ..)| name)
    }

    /// Checks the range of every number.
    fn check(&self, tick_hz: f64) -> Result<(), OutOfRange> {
        let rate_hz = above_zero("touch rate_hz", self.rate_hz)?;
        if rate_hz > tick_hz {
            return Err(OutOfRange { name: "touch rate_hz", expected: "at most the tick rate", found: rate_hz });
        }
        let latency_s = zero_to_ten("touch latency_s", self.latency_s)?;
        if latency_s * tick_hz >= f64::from(u32::MAX) {
            return Err(OutOfRange { name: "touch latency_s", expected: "below 2^32 ticks", found: latency_s });
        }
        zero_to_ten("touch noise_rms_m", self.noise_rms_m)?;
        zero_to_ten("touch jitter_rms_s", self.jitter_rms_s)?;
        zero_to_one("touch lost_share", self.lost_share)?;
        zero_to_one("touch bunched_share", self.bunched_share)?;
        zero_to_ten("touch pause_rate_hz", self.pause_rate_hz)?;
        zero_to_ten("touch pause_max_s", self.pause_max_s)?;
        zero_to_ten("touch step_m", self.step_m)?;
        Ok(())
    }

    /// The same source without losses and with unlimited resolution.
    #[must_use]
    pub fn without_losses(self) -> Self {
        Self { lost_share: 0.0, bunched_share: 0.0, pause_rate_hz: 0.0, pause_max_s: 0.0, step_m: 0.0, ..self }
    }
}

/// Name, reports per second and latency in seconds of the bundled sources.
const BUNDLED: [(&str, f64, f64); 3] =
    [(TouchConfig::REALISTIC_NAME, 100.0, 10e-3), ("200", 200.0, 5e-3), ("500", 500.0, 3e-3)];

impl Default for TouchConfig {
    /// [`Self::IDEAL`].
    fn default() -> Self {
        Self::IDEAL
    }
}

/// Outcome of a report.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ReportOutcome {
    Arrives,
    WaitsForNext,
    Lost,
}

/// The touch source.
///
/// It samples at whole ticks. The first sample without a finger reports the lift; there are no more reports until the
/// finger touches again.
#[derive(Clone, Debug)]
pub(crate) struct TouchSource {
    config: TouchConfig,
    tick_hz: f64,
    phase_ticks: f64,
    latency_ticks: u32,
    noise: Random,
    jitter: Random,
    losses: Random,
    pause_until_tick: f64,
    samples: u64,
    next_sample_tick: u64,
    finger_was_down: bool,
    /// Reports with their tick of arrival, in the order of their samples, in which they also arrive.
    under_way: VecDeque<(u64, Touch)>,
    /// A report delayed until the next one.
    waiting: Option<Touch>,
    arrived: Option<Touch>,
}

impl TouchSource {
    /// A touch source whose first sample is at a random time within the first report period.
    pub(crate) fn new(config: &TouchConfig, tick_hz: u32, seed: u64) -> Result<Self, OutOfRange> {
        let tick_hz = f64::from(tick_hz);
        config.check(tick_hz)?;
        let phase_ticks = Random::new(seed, Purpose::ReportPhase).uniform() * (tick_hz / config.rate_hz);
        Ok(Self {
            config: *config,
            tick_hz,
            phase_ticks,
            latency_ticks: libm::round(config.latency_s * tick_hz) as u32,
            noise: Random::new(seed, Purpose::PlaceNoise),
            jitter: Random::new(seed, Purpose::ReportJitter),
            losses: Random::new(seed, Purpose::LostReports),
            pause_until_tick: 0.0,
            samples: 0,
            next_sample_tick: phase_ticks as u64,
            finger_was_down: false,
            under_way: VecDeque::new(),
            waiting: None,
            arrived: None,
        })
    }

    /// A touch source that samples from `tick` on, in place of another one, whose pending reports are lost. Its first
    /// sample reports the finger or its lift.
    pub(crate) fn from_tick(config: &TouchConfig, tick_hz: u32, seed: u64, tick: u64) -> Result<Self, OutOfRange> {
        let mut source = Self::new(config, tick_hz, seed)?;
        let passed = (tick as f64 - source.phase_ticks) / source.period_ticks();
        source.samples = libm::ceil(passed).max(0.0) as u64;
        source.next_sample_tick = source.sample_tick();
        source.finger_was_down = true;
        Ok(source)
    }

    fn period_ticks(&self) -> f64 {
        self.tick_hz / self.config.rate_hz
    }

    /// The tick of the next sample.
    fn sample_tick(&self) -> u64 {
        (self.phase_ticks + self.samples as f64 * self.period_ticks()) as u64
    }

    /// Advances to `tick`, at which the finger is at `finger`. Must be called for every tick from 0.
    pub(crate) fn tick(&mut self, tick: u64, finger: Option<&FingerState>) {
        if tick >= self.next_sample_tick {
            self.sample(tick, finger);
        }
        self.arrived = self.under_way.pop_front_if(|(arrival_tick, _)| *arrival_tick <= tick).map(|(_, touch)| touch);
    }

    /// Returns the report that arrived at the current tick.
    pub(crate) fn arrived(&self) -> Option<Touch> {
        self.arrived
    }

    fn sample(&mut self, tick: u64, finger: Option<&FingerState>) {
        self.samples += 1;
        self.next_sample_tick = self.sample_tick();
        // Drawn for every sample, so that lifts do not shift the noise of later samples.
        let x_noise_m = self.noise.gaussian() * self.config.noise_rms_m;
        let y_noise_m = self.noise.gaussian() * self.config.noise_rms_m;
        let jitter_ticks = self.jitter.gaussian_within(JITTER_LIMIT) * (self.config.jitter_rms_s * self.tick_hz);
        let outcome = self.draw_outcome(tick as f64);
        let touch = match finger {
            Some(finger) => Touch::Down {
                x_m: self.in_steps(finger.x_m + x_noise_m) as f32,
                y_m: self.in_steps(finger.y_m + y_noise_m) as f32,
                age_ticks: self.latency_ticks,
            },
            None if self.finger_was_down => Touch::Up,
            None => return,
        };
        self.finger_was_down = finger.is_some();
        let delay_ticks = libm::round(f64::from(self.latency_ticks) + jitter_ticks).max(0.0) as u64;
        match outcome {
            // A lift is reported repeatedly until it arrives.
            ReportOutcome::Arrives => self.send(tick + delay_ticks, touch),
            _ if touch == Touch::Up => self.send(tick + delay_ticks, touch),
            ReportOutcome::WaitsForNext => self.waiting = Some(touch),
            ReportOutcome::Lost => {}
        }
    }

    /// Sends a report, after the delayed one.
    fn send(&mut self, arrival_tick: u64, touch: Touch) {
        let reports = self.waiting.take().into_iter().chain([touch]);
        self.under_way.extend(reports.map(|touch| (arrival_tick, touch)));
    }

    /// Draws the outcome of a sample's report. The number of draws per sample is constant.
    fn draw_outcome(&mut self, tick: f64) -> ReportOutcome {
        let [lost, bunched, begins, length] = [(); 4].map(|()| self.losses.uniform());
        let TouchConfig { rate_hz, lost_share, bunched_share, pause_rate_hz, pause_max_s, .. } = self.config;
        if begins < pause_rate_hz / rate_hz && tick >= self.pause_until_tick {
            self.pause_until_tick = tick + length * (pause_max_s * self.tick_hz);
        }
        if tick < self.pause_until_tick || lost < lost_share {
            ReportOutcome::Lost
        } else if bunched < bunched_share {
            ReportOutcome::WaitsForNext
        } else {
            ReportOutcome::Arrives
        }
    }

    fn in_steps(&self, place_m: f64) -> f64 {
        let step_m = self.config.step_m;
        if step_m > 0.0 { libm::round(place_m / step_m) * step_m } else { place_m }
    }
}

#[cfg(test)]
mod tests;
