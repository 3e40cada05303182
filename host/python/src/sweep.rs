//! Studies of many simulated fingers. Cells and results cross as the JSON of `frixel sweep`.

use std::collections::BTreeMap;
use std::path::PathBuf;

use frixel_lab::sweep::{
    Cell, CellError, CellResult, CellResultError, Plan, PlanError, PlanFileError, Study, Sweep, json,
};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rayon::ThreadPoolBuilder;

use super::error::{parameter_error, raised, scene_error, scene_error_of};
use super::scene::NamedFiles;
use super::signals::interruptible;

/// Files by their names.
type NamedBytes<'py> = BTreeMap<&'static str, Bound<'py, PyBytes>>;

/// An exception, to which a plan's error converts.
struct Raised(PyErr);

impl From<PlanError> for Raised {
    fn from(error: PlanError) -> Self {
        Self(Python::attach(|py| parameter_error(py, error)))
    }
}

impl From<PlanFileError> for Raised {
    fn from(error: PlanFileError) -> Self {
        Self(Python::attach(|py| match error {
            PlanFileError::Mistakes(mistakes) => scene_error(py, &mistakes),
            error @ PlanFileError::Unreadable { .. } => parameter_error(py, error),
        }))
    }
}

/// The cells of a plan. `name` is its name in messages. `scenes` has the texts and files of scenes that are not files
/// in `folder`.
#[pyfunction]
pub(crate) fn sweep_cells(
    py: Python<'_>,
    plan: &[u8],
    name: &str,
    folder: PathBuf,
    scenes: BTreeMap<String, (String, NamedFiles)>,
) -> PyResult<Vec<String>> {
    let cells = interruptible(py, |goes_on| -> Result<Vec<String>, Raised> {
        let plan = Plan::parse(plan, name)?;
        let sweep = Sweep::in_folder(plan, &folder, &scenes)?;
        for number in sweep.samples().into_iter().take_while(|_| goes_on().is_continue()) {
            let cell = sweep.cell(number)?;
            cell.check()
                .map_err(|error| Raised(Python::attach(|py| exception(py, &sweep.blame(&cell, &error), error))))?;
        }
        let numbers = (0..sweep.index().cells()).take_while(|_| goes_on().is_continue());
        numbers.map(|number| Ok(json(&sweep.cell(number)?))).collect()
    })?;
    cells.map_err(|Raised(error)| error)
}

/// Plays a cell. Returns its result.
#[pyfunction]
pub(crate) fn play_cell(py: Python<'_>, cell: &str) -> PyResult<String> {
    let no_cell =
        |error: serde_json::Error| parameter_error(py, format!("expected a cell made by `sweep.cells`: {error}"));
    let cell: Cell = serde_json::from_str(cell).map_err(no_cell)?;
    // Callers play cells in parallel, each on one thread.
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|error| raised(py, "PlayError", (format!("no thread could be started: {error}"),)))?;
    let played = interruptible(py, |goes_on| pool.install(|| cell.play(goes_on)))?;
    played.map(|result| result.to_json()).map_err(|error| exception(py, &cell.subject(&error), error))
}

/// Merges results, without checks for signals. Returns the summary's lines, and the files that `frixel sweep` writes.
#[pyfunction]
pub(crate) fn study_files(py: Python<'_>, results: Vec<String>) -> PyResult<(Vec<String>, NamedBytes<'_>)> {
    let study = py.detach(|| {
        let results = results.iter().map(|result| CellResult::from_json(result));
        let study = Study::new(results.collect::<Result<Vec<_>, _>>()?);
        Ok((study.summary(), study.files()))
    });
    let no_result =
        |error: CellResultError| parameter_error(py, format!("expected a result made by `sweep.play`: {error}"));
    let (summary, files) = study.map_err(no_result)?;
    let files = files.map_err(|error| raised(py, "FrixelError", (error.to_string(),)))?;
    Ok((summary, files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect()))
}

fn exception(py: Python<'_>, subject: &str, error: CellError) -> PyErr {
    match error {
        CellError::Compile(error) => scene_error_of(py, subject, &error),
        error => parameter_error(py, format!("{subject}: {error}")),
    }
}
