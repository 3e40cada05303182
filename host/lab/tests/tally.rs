//! Outcomes of the fits of many people.

use std::fmt;

use frixel_lab::fit::{Estimate, Fit, FitError, Settings, Verdict, measured_ripple};
use frixel_model::Waveform;
use frixel_scene::Screen;

/// How `frixel finger fit` fits without options.
pub(super) fn settings() -> Settings {
    Settings {
        voltage_v_rms: 150.0,
        normal_load_n: None,
        coating_gap_m: Screen::example().coating_gap_m(),
        ripple: measured_ripple(Waveform::Square, 1e3),
        without: Vec::new(),
        seed: 1,
    }
}

/// Fits beside the truth.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) fitted: usize,
    pub(super) reasons: Vec<String>,
    /// Number of intervals that contain the truth.
    electric: usize,
    coefficient: usize,
    /// Number of fits whose model is in doubt.
    doubted: usize,
    /// Errors of electric friction, relative to the truth.
    errors: Vec<f64>,
    /// Half-widths of its intervals, relative to the truth.
    widths: Vec<f64>,
}

fn contains(estimate: &Estimate, truth: f64) -> bool {
    (estimate.low..=estimate.high).contains(&truth)
}

pub(super) fn is_doubted(fit: &Fit) -> bool {
    [fit.voltage_exponent, fit.load_exponent].iter().any(|exponent| exponent.verdict == Verdict::Doubted)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

impl Tally {
    /// Adds a fit; `truth` is the friction coefficient and the electric friction under a load.
    pub(super) fn add(&mut self, result: Result<Fit, FitError>, truth: impl Fn(f64) -> (f64, f64)) {
        match result {
            Ok(fit) => {
                let (coefficient, electric_n) = truth(fit.data.normal_load_n);
                self.fitted += 1;
                self.electric += usize::from(contains(&fit.electric_friction_n, electric_n));
                self.coefficient += usize::from(contains(&fit.friction_coefficient, coefficient));
                self.doubted += usize::from(is_doubted(&fit));
                let Estimate { value, low, high } = fit.electric_friction_n;
                self.errors.push(value / electric_n - 1.0);
                self.widths.push((high - low) / (2.0 * electric_n));
            }
            Err(error) => self.reasons.push(error.to_string()),
        }
    }

    pub(super) fn and(mut self, other: Self) -> Self {
        self.fitted += other.fitted;
        self.electric += other.electric;
        self.coefficient += other.coefficient;
        self.doubted += other.doubted;
        self.reasons.extend(other.reasons);
        self.errors.extend(other.errors);
        self.widths.extend(other.widths);
        self
    }

    pub(super) fn refused(&self) -> f64 {
        self.reasons.len() as f64 / (self.fitted + self.reasons.len()) as f64
    }

    pub(super) fn doubt(&self) -> f64 {
        self.doubted as f64 / self.fitted as f64
    }

    /// Share of the intervals of electric friction that contain the truth.
    pub(super) fn electric(&self) -> f64 {
        self.electric as f64 / self.fitted as f64
    }

    /// The same of the friction coefficient.
    pub(super) fn coefficient(&self) -> f64 {
        self.coefficient as f64 / self.fitted as f64
    }

    pub(super) fn bias(&self) -> f64 {
        mean(&self.errors)
    }

    pub(super) fn error_rms(&self) -> f64 {
        mean(&self.errors.iter().map(|error| error * error).collect::<Vec<_>>()).sqrt()
    }

    /// Median half-width of the intervals of electric friction.
    pub(super) fn half_width(&self) -> f64 {
        let mut widths = self.widths.clone();
        widths.sort_by(f64::total_cmp);
        widths.get(widths.len() / 2).copied().unwrap_or(f64::NAN)
    }

    /// Number of fits whose interval of electric friction, or of the friction coefficient, misses the truth.
    pub(super) fn missed(&self) -> (usize, usize) {
        (self.fitted - self.electric, self.fitted - self.coefficient)
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.fitted + self.reasons.len();
        write!(formatter, "{:5.1} % of {count} refused", 1e2 * self.refused())?;
        if self.fitted == 0 {
            return Ok(());
        }
        write!(
            formatter,
            "; bias {:+.2} %, rms {:.2} %, half-width {:.2} %; covers {:.1} % (coefficient {:.1} %); in doubt {:.1} %",
            1e2 * self.bias(),
            1e2 * self.error_rms(),
            1e2 * self.half_width(),
            1e2 * self.electric(),
            1e2 * self.coefficient(),
            1e2 * self.doubt(),
        )?;
        self.reasons.iter().try_for_each(|reason| write!(formatter, "\n    {reason}"))
    }
}
