//! Fits of a finger.

use frixel_lab::fit::{self, Data, FitError, Row, Settings, Summary};
use frixel_scene::Experiment;
use pyo3::prelude::*;

use super::error::raised;
use super::profile::ProfileText;

/// Measured rows, an object of `python/frixel/fitting.py`: columns of one length.
#[derive(FromPyObject)]
pub(crate) struct Rows {
    voltage_v_rms: Vec<f64>,
    normal_force_n: Vec<f64>,
    friction_n: Vec<f64>,
    time_s: Option<Vec<f64>>,
    stroke: Option<Vec<String>>,
    speed_mm_s: Option<Vec<f64>>,
}

impl Rows {
    fn rows(self) -> Vec<Row> {
        let Self { voltage_v_rms, normal_force_n, friction_n, time_s, stroke, speed_mm_s } = self;
        let at =
            |column: &Option<Vec<f64>>, index: usize| column.as_ref().and_then(|column| column.get(index).copied());
        let forces = voltage_v_rms.into_iter().zip(normal_force_n).zip(friction_n).enumerate();
        forces
            .map(|(index, ((voltage_v_rms, normal_force_n), friction_n))| Row {
                // Rows are counted as in a file, whose header is row 1.
                number: index as u64 + 2,
                voltage_v_rms,
                normal_force_n,
                friction_n,
                time_s: at(&time_s, index),
                stroke: stroke.as_ref().and_then(|stroke| stroke.get(index).cloned()),
                speed_mm_s: at(&speed_mm_s, index),
            })
            .collect()
    }
}

/// What to fit for, an object of `python/frixel/fitting.py`.
#[derive(FromPyObject)]
pub(crate) struct FitSettings {
    empirical: bool,
    voltage_v_rms: f64,
    normal_load_n: Option<f64>,
    without: Vec<String>,
    seed: u64,
    date: String,
    method: String,
    screen: ProfileText,
}

/// Fits a finger. Returns the summary as JSON, the summary in words, and the text of the finger's profile.
#[pyfunction]
pub(crate) fn fit_finger(py: Python<'_>, rows: Rows, settings: FitSettings) -> PyResult<(String, String, String)> {
    let screen = settings.screen.screen(py)?;
    let FitSettings { empirical, voltage_v_rms, normal_load_n, without, seed, date, method, screen: named } = settings;
    let coating_gap_m = 1e-6 * screen.coating_gap_um();
    let settings = Settings { voltage_v_rms, normal_load_n, coating_gap_m, without, seed };
    let screen = screen.name.unwrap_or_else(|| named.name().to_owned());
    let experiment = Experiment { date, method, screen: screen.clone() };
    let fitted = py.detach(|| {
        let data = Data::Recording(rows.rows());
        if empirical {
            let fit = fit::fit_empirical(data, &settings)?;
            return Ok((fit.json().to_string(), fit.words(), fit.profile(experiment).to_toml()));
        }
        let fit = fit::fit_data(data, &settings)?;
        let summary = serde_json::to_string(&Summary::from(&fit)).unwrap_or_default();
        Ok((summary, fit::words(&fit, &screen), fit::profile(&fit, experiment).to_toml()))
    });
    fitted.map_err(|error: FitError| raised(py, "FitError", (error.to_string(),)))
}
