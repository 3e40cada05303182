//! Fits of a finger.

use frixel_lab::fit::{self, FitError, Settings};
use frixel_lab::table::Reading;
use frixel_model::Waveform;
use frixel_scene::{Experiment, Screen};
use pyo3::prelude::*;

use super::error::raised;
use super::profile::ProfileText;
use super::signals::interruptible;

/// Options of the command in the sentences of a fit, and the Python arguments in their place.
const ARGUMENTS: [(&str, &str); 4] = [
    ("`frixel finger fit DATA.csv --law empirical`", "`law=\"empirical\"`"),
    ("--without", "`without`"),
    ("--voltage", "`voltage_v_rms`"),
    ("--load", "`normal_load_n`"),
];

/// Settings of a fit, an object of `python/frixel/fitting.py`.
#[derive(FromPyObject)]
pub(crate) struct FitSettings {
    empirical: bool,
    voltage_v_rms: f64,
    normal_load_n: Option<f64>,
    carrier_hz: f64,
    sine: bool,
    without: Vec<String>,
    seed: u64,
    date: String,
    method: String,
    screen: ProfileText,
}

/// Fits a finger to columns as CSV, with the reader and the validation of the command. Returns the summary as JSON, the
/// summary in words, and the text of the finger's profile.
#[pyfunction]
pub(crate) fn fit_finger(py: Python<'_>, csv: String, settings: FitSettings) -> PyResult<(String, String, String)> {
    let screen: Screen = settings.screen.read(py)?;
    let FitSettings { empirical, voltage_v_rms, normal_load_n, carrier_hz, sine, without, seed, .. } = settings;
    let FitSettings { date, method, screen: named, .. } = settings;
    let coating_gap_m = screen.coating_gap_m();
    let ripple = fit::measured_ripple(if sine { Waveform::Sine } else { Waveform::Square }, carrier_hz);
    let settings = Settings { voltage_v_rms, normal_load_n, coating_gap_m, ripple, without, seed };
    let screen = screen.name.unwrap_or_else(|| named.name().to_owned());
    let experiment = Experiment { date, method, screen: screen.clone() };
    let fitted = interruptible(py, |goes_on| {
        let Reading { value: data, understood } = fit::data(csv.as_bytes())?;
        let with_note = |words: String| match &understood {
            Some(understood) => format!("{words}  note: {understood}\n"),
            None => words,
        };
        if empirical {
            let fit = fit::fit_empirical(data, &settings, goes_on)?;
            return Ok((fit.json().to_string(), with_note(fit.words()), fit.profile(experiment).to_toml()));
        }
        let fit = fit::fit_data(data, &settings, goes_on)?;
        Ok((fit.json().to_string(), with_note(fit::words(&fit, &screen)), fit::profile(&fit, experiment).to_toml()))
    })?;
    fitted.map_err(|error: FitError| {
        let in_command = error.to_string();
        let sentence = ARGUMENTS.iter().fold(in_command, |text, (option, argument)| text.replace(option, argument));
        raised(py, "FitError", (sentence,))
    })
}
