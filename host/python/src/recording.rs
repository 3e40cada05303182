//! Recordings: columns as arrays, and as Parquet.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

use frixel_felt::recorder::Marker;
use frixel_lab::recording::{
    Column, Field, Kind, Metadata, PlayOptions, Recording, SourceFile, Values, play_fields as fields,
};
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::{Deserialize, Serialize};

use super::error::raised;
use super::scene::NamedFiles;
use super::signals::interruptible;

/// How a play was made, beside its scene: with it, a recording is played again. Python keeps it as JSON.
#[derive(Serialize, Deserialize)]
pub(crate) struct Made {
    pub(crate) metadata: Metadata,
    /// Texts of finger, screen, touch source and stroke.
    pub(crate) files: BTreeMap<String, String>,
    pub(crate) markers: Vec<Marker>,
}

/// Name, unit and meaning of each column of a play.
#[pyfunction]
pub(crate) fn play_fields() -> Vec<(String, String, String)> {
    fields().into_iter().map(|field| (field.name, field.unit, field.meaning)).collect()
}

/// Columns as arrays by their names: numbers, not a number where nothing is known, and lists of texts.
pub(crate) fn columns<'py>(py: Python<'py>, fields: &[Field], values: Vec<Values>) -> PyResult<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    for (field, values) in fields.iter().zip(values) {
        let numbers: Vec<f64> = match values {
            Values::Numbers(values) => values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect(),
            Values::Integers(values) => values.into_iter().map(|value| value.map_or(f64::NAN, f64::from)).collect(),
            Values::Texts(values) => {
                let texts: Vec<String> = values.into_iter().map(Option::unwrap_or_default).collect();
                columns.set_item(&field.name, texts)?;
                continue;
            }
        };
        columns.set_item(&field.name, numbers.into_pyarray(py))?;
    }
    Ok(columns)
}

/// The values of a column of this kind.
fn values(kind: Kind, column: &Bound<'_, PyAny>) -> PyResult<Values> {
    Ok(match kind {
        Kind::Number => Values::Numbers(numbers(column)?.collect()),
        Kind::Integer => Values::Integers(numbers(column)?.map(|value| value.map(|value| value as i32)).collect()),
        Kind::Text => Values::Texts(column.extract::<Vec<String>>()?.into_iter().map(Some).collect()),
    })
}

fn numbers(column: &Bound<'_, PyAny>) -> PyResult<impl Iterator<Item = Option<f64>>> {
    let column: PyReadonlyArray1<f64> = column.extract()?;
    Ok(column.as_array().to_vec().into_iter().map(|value| value.is_finite().then_some(value)))
}

/// Writes a play as Parquet, as `frixel play --record` does. `made` is what [`super::simulator::simulate`] or
/// [`super::device::Device`] says of it.
#[pyfunction]
pub(crate) fn write_parquet(
    py: Python<'_>,
    path: PathBuf,
    columns: Bound<'_, PyDict>,
    scene: String,
    files: NamedFiles,
    made: &str,
    participant: Option<String>,
) -> PyResult<()> {
    let failed = |error: &dyn std::fmt::Display| {
        raised(py, "FrixelError", (format!("{}: this file cannot be written ({error})", path.display()),))
    };
    let mut taken = Vec::new();
    for field in fields() {
        let Some(column) = columns.get_item(&field.name)? else {
            return Err(failed(&format!("the recording has no column {}", field.name)));
        };
        taken.push(Column { values: values(field.kind, &column)?, field });
    }
    let made: Made = serde_json::from_str(made).map_err(|error| failed(&error))?;
    let own = made.files.iter().map(|(name, text)| (name.clone(), text.as_bytes()));
    let of_scene = files.iter().map(|(name, bytes)| (format!("{}{name}", PlayOptions::OF_SCENE), bytes.as_slice()));
    let files = SourceFile::all(own.chain(of_scene));
    let metadata = Metadata { scene, files, markers: made.markers, participant, ..made.metadata };
    let recording = Recording { metadata, columns: taken, is_cut_off: false };
    let file = File::create(&path).map_err(|error| failed(&error))?;
    let written = py.detach(|| recording.write_parquet(BufWriter::new(file)));
    written.map_err(|error| failed(&error))
}

/// Plays a recording, the bytes of its file, again, and compares it. Messages call the file `name`. Returns the number
/// of its rows.
#[pyfunction]
pub(crate) fn replay(py: Python<'_>, recording: Vec<u8>, name: &str) -> PyResult<usize> {
    let replayed = interruptible(py, |goes_on| {
        let recorded = Recording::read_parquet(recording).map_err(|error| format!(": {error}"))?;
        let played = recorded.replay(&mut || goes_on());
        let played = played.map_err(|error| format!(" cannot be played again: {error}"))?;
        match recorded.first_difference(&played) {
            None => Ok(recorded.rows()),
            Some(difference) => Err(format!(
                " plays other bits: {difference}; the file was changed, or this machine computes differently"
            )),
        }
    })?;
    replayed.map_err(|sentence| raised(py, "PlayError", (format!("{name}{sentence}"),)))
}
