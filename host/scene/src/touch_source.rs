//! Reads the file of a touch source: rate, latency and reliability of a touchscreen's reports.

use std::fmt::{self, Display};

use frixel_hil_sim::TouchConfig;
use serde::Serialize;

use super::compile_error::CompileError;
use super::fields::{Fields, read_text};
use super::file_kind::FileKind;
use super::log::Log;
use super::profile::Profile;
use super::tables::touch_source as fields_of;

/// A touch source in the units and field names of its file.
///
/// ```
/// use frixel_scene::TouchSource;
/// let source = frixel_hil_sim::TouchConfig::bundled("200").map(|source| TouchSource::from(&source).to_string());
/// assert_eq!(source.as_deref(), Some("200 reports a second, 5 ms late, 12 % lost, places in steps of 0.18 mm"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TouchSource {
    /// Reports per second.
    pub reports_per_s: f64,
    /// Latency from sample to arrival, ms.
    pub latency_ms: f64,
    /// Jitter: standard deviation of the latency, ms.
    pub jitter_ms: f64,
    /// Position noise, rms, mm.
    pub noise_mm: f64,
    /// Position resolution, mm; 0 for unlimited.
    pub step_mm: f64,
    /// Fraction of the reports that never arrive.
    pub lost_share: f64,
    /// Fraction of the reports that arrive together with the next one.
    pub bunched_share: f64,
    /// Pauses per second.
    pub pauses_per_s: f64,
    /// Longest pause, ms.
    pub pause_max_ms: f64,
}

impl From<&TouchConfig> for TouchSource {
    fn from(source: &TouchConfig) -> Self {
        // Remove digits that result from converting units.
        let rounded = |value: f64| (1e9 * value).round() / 1e9;
        Self {
            reports_per_s: rounded(source.rate_hz),
            latency_ms: rounded(1e3 * source.latency_s),
            jitter_ms: rounded(1e3 * source.jitter_rms_s),
            noise_mm: rounded(1e3 * source.noise_rms_m),
            step_mm: rounded(1e3 * source.step_m),
            lost_share: source.lost_share,
            bunched_share: source.bunched_share,
            pauses_per_s: source.pause_rate_hz,
            pause_max_ms: rounded(1e3 * source.pause_max_s),
        }
    }
}

impl Display for TouchSource {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reports_per_s, latency_ms, lost_share, step_mm, .. } = self;
        write!(formatter, "{reports_per_s} reports a second, {latency_ms} ms late")?;
        match (1e4 * lost_share).round() / 1e2 {
            percent if percent > 0.0 => write!(formatter, ", {percent} % lost")?,
            _ => formatter.write_str(", none lost")?,
        }
        if *step_mm > 0.0 { write!(formatter, ", places in steps of {step_mm} mm") } else { Ok(()) }
    }
}

/// Reads touch sources.
///
/// ```
/// use frixel_hil_sim::TouchConfig;
/// use frixel_scene::Profile;
///
/// let text = "reports_per_s = 120\nlatency_ms = 8\nlost_share = 0.05\n";
/// let source = TouchConfig::parse(text, "panel.toml")?;
/// assert_eq!((source.rate_hz, source.latency_s, source.lost_share), (120.0, 8e-3, 0.05));
/// # Ok::<(), frixel_scene::CompileError>(())
/// ```
impl Profile for TouchConfig {
    const KIND: FileKind = FileKind::TouchSource;

    fn bundled_names() -> Vec<&'static str> {
        Self::bundled_names().collect()
    }

    fn bundled(name: &str) -> Option<Self> {
        Self::bundled(name)
    }

    fn parse(text: impl AsRef<[u8]>, name: &str) -> Result<Self, CompileError> {
        read_text(Self::KIND, text.as_ref(), name, read)
    }
}

fn read(mut fields: Fields, log: &mut Log) -> Option<TouchConfig> {
    let reports_per_s = fields.number(log, &fields_of::REPORTS_PER_S);
    let latency_ms = fields.number(log, &fields_of::LATENCY_MS);
    let mut optional = |field| fields.number_or_default(log, field);
    let jitter_ms = optional(&fields_of::JITTER_MS);
    let noise_mm = optional(&fields_of::NOISE_MM);
    let step_mm = optional(&fields_of::STEP_MM);
    let lost_share = optional(&fields_of::LOST_SHARE);
    let bunched_share = optional(&fields_of::BUNCHED_SHARE);
    let pause_rate_hz = optional(&fields_of::PAUSES_PER_S);
    let pause_max_ms = optional(&fields_of::PAUSE_MAX_MS);
    fields.close(log);
    Some(TouchConfig {
        rate_hz: reports_per_s?,
        latency_s: latency_ms? / 1e3,
        noise_rms_m: noise_mm / 1e3,
        jitter_rms_s: jitter_ms / 1e3,
        lost_share,
        bunched_share,
        pause_rate_hz,
        pause_max_s: pause_max_ms / 1e3,
        step_m: step_mm / 1e3,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_is_read_in_its_unit() {
        let text = "reports_per_s = 200\nlatency_ms = 5\njitter_ms = 0.25\nnoise_mm = 0.02\nstep_mm = 0.18\n\
                    lost_share = 0.12\nbunched_share = 0.03\npauses_per_s = 0.1\npause_max_ms = 120\n";
        let read = TouchConfig::parse(text, "touch.toml").expect("it reads");
        let bundled = TouchConfig::bundled("200").expect("it is bundled");
        let numbers = |source: TouchConfig| {
            let TouchConfig { rate_hz, latency_s, noise_rms_m, jitter_rms_s, .. } = source;
            let TouchConfig { lost_share, bunched_share, pause_rate_hz, pause_max_s, step_m, .. } = source;
            let path = [rate_hz, latency_s, noise_rms_m, jitter_rms_s];
            [path.as_slice(), &[lost_share, bunched_share, pause_rate_hz, pause_max_s, step_m]].concat()
        };
        for (found, expected) in numbers(read).into_iter().zip(numbers(bundled)) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found}, expected {expected}");
        }
    }
}
