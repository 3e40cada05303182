//! Studies of many simulated fingers. Cells and results cross as the JSON that `frixel sweep` keeps.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use frixel_lab::sweep::{Cell, CellError, CellResult, Plan, PlanError, Source, Study, json};
use frixel_scene::Scene as ParsedScene;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rayon::ThreadPoolBuilder;
use serde::de::DeserializeOwned;

use super::error::{parameter_error, raised, scene_error};
use super::scene::{NamedFiles, ReadFiles};
use super::signals::interruptible;

/// Files by their names.
type NamedBytes<'py> = BTreeMap<&'static str, Bound<'py, PyBytes>>;

/// An exception that a plan's mistake can become.
struct Raised(PyErr);

impl From<PlanError> for Raised {
    fn from(error: PlanError) -> Self {
        Self(Python::attach(|py| parameter_error(py, error)))
    }
}

/// The cells of a plan, which messages call `name`. `scenes` has the texts and files of scenes that are not files in
/// `folder`.
#[pyfunction]
pub(crate) fn sweep_cells(
    py: Python<'_>,
    plan: &str,
    name: &str,
    folder: PathBuf,
    scenes: BTreeMap<String, (String, NamedFiles)>,
) -> PyResult<Vec<String>> {
    let plan = Plan::parse(plan, name).map_err(|error| parameter_error(py, error))?;
    let source = |name: &str| match scenes.get(name) {
        Some((text, files)) => Ok(Source { name: name.to_owned(), text: text.clone(), files: files.clone() }),
        None => source_in(py, &folder, name).map_err(Raised),
    };
    let text = |what, name: &str| {
        let path = folder.join(name);
        let advice = "give its file, from the plan's folder, or a bundled one";
        let unreadable = |error| Raised(parameter_error(py, format!("{what} {}: {error}; {advice}", path.display())));
        fs::read_to_string(&path).map_err(unreadable)
    };
    let cells = plan.cells(source, text).map_err(|Raised(error)| error)?;
    for cell in cells.iter().filter(|cell| cell.person == 1) {
        py.detach(|| cell.check()).map_err(|error| exception(py, cell, error))?;
    }
    Ok(cells.iter().map(json).collect())
}

/// A scene file with the files that it names.
fn source_in(py: Python<'_>, folder: &Path, name: &str) -> PyResult<Source> {
    let path = folder.join(name);
    let unreadable =
        |error| parameter_error(py, format!("the scene {} cannot be read ({error}): check the path", path.display()));
    let bytes = fs::read(&path).map_err(unreadable)?;
    let files = ReadFiles::new(path.parent().map(Path::to_owned), NamedFiles::new());
    ParsedScene::parse_bytes(&bytes, name, &files).map_err(|error| scene_error(py, &error))?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    Ok(Source { name: name.to_owned(), text, files: files.into_read() })
}

/// Plays a cell. Returns its result.
#[pyfunction]
pub(crate) fn play_cell(py: Python<'_>, cell: &str) -> PyResult<String> {
    let cell: Cell = read(py, cell, "a cell is a text that `sweep.cells` has made")?;
    // Cells are played side by side, and each on one thread.
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.map_err(|error| raised(py, "PlayError", (format!("no thread could be started: {error}"),)))?;
    let played = interruptible(py, |goes_on| pool.install(|| cell.play_while(goes_on)))?;
    played.map(|result| json(&result)).map_err(|error| exception(py, &cell, error))
}

/// Puts results together. Returns lines for a person, and the files that `frixel sweep` writes.
#[pyfunction]
pub(crate) fn study_files(py: Python<'_>, results: Vec<String>) -> PyResult<(Vec<String>, NamedBytes<'_>)> {
    let expected = "a result is a text that `sweep.play` has made";
    let results =
        results.iter().map(|result| read::<CellResult>(py, result, expected)).collect::<PyResult<Vec<_>>>()?;
    let (summary, files) = py.detach(|| {
        let study = Study::new(results);
        (study.summary(), study.files())
    });
    let files = files.map_err(|error| raised(py, "FrixelError", (error.to_string(),)))?;
    Ok((summary, files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect()))
}

fn read<T: DeserializeOwned>(py: Python<'_>, text: &str, expected: &str) -> PyResult<T> {
    serde_json::from_str(text).map_err(|error| parameter_error(py, format!("{expected}, and this one is not: {error}")))
}

fn exception(py: Python<'_>, cell: &Cell, error: CellError) -> PyErr {
    match error {
        CellError::Compile(error) => scene_error(py, &error),
        error => parameter_error(py, format!("{}: {error}", cell.title())),
    }
}
