//! Conversion of errors to the exceptions of `python/frixel/errors.py`.

use std::fmt::Display;

use frixel_model::ParameterError;
use frixel_scene::{CompileError, Diagnostic};
use pyo3::prelude::*;
use pyo3::types::PyList;

/// The module that has the exceptions.
const MODULE: &str = "frixel.errors";

/// The exception for a refused value.
pub(crate) fn parameter_error(py: Python<'_>, error: impl Display) -> PyErr {
    raised(py, "ParameterError", (error.to_string(),))
}

/// The exception for a refused parameter of the contact model.
pub(crate) fn model_error(error: ParameterError) -> PyErr {
    Python::attach(|py| parameter_error(py, error))
}

/// The exception for the mistakes of a scene, or of a file that it names.
pub(crate) fn scene_error(py: Python<'_>, error: &CompileError) -> PyErr {
    scene_exception(py, error.to_string(), error)
}

/// The same about a subject.
pub(crate) fn scene_error_of(py: Python<'_>, subject: &str, error: &CompileError) -> PyErr {
    scene_exception(py, format!("{subject}: {error}"), error)
}

fn scene_exception(py: Python<'_>, message: String, error: &CompileError) -> PyErr {
    let mistakes = error.diagnostics.iter().map(|diagnostic| mistake(py, diagnostic)).collect::<PyResult<Vec<_>>>();
    match mistakes.and_then(|mistakes| PyList::new(py, mistakes)) {
        Ok(mistakes) => raised(py, "SceneError", (message, mistakes)),
        Err(error) => error,
    }
}

fn mistake<'py>(py: Python<'py>, diagnostic: &Diagnostic) -> PyResult<Bound<'py, PyAny>> {
    let Diagnostic { file, line, column, text, .. } = diagnostic;
    let class = py.import(MODULE)?.getattr("Mistake")?;
    class.call1((file, line, column, text, diagnostic.nearest(), diagnostic.sentence()))
}

/// An exception of the class with this name.
pub(crate) fn raised<'py>(py: Python<'py>, class: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let exception = py.import(MODULE).and_then(|module| module.getattr(class)).and_then(|class| class.call1(arguments));
    exception.map_or_else(|error| error, PyErr::from_value)
}
