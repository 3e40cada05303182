//! Recordings: columns as arrays, and as Parquet.

use std::collections::BTreeMap;

use frixel_felt::recorder::Marker;
use frixel_lab::recording::{
    Column, Field, Kind, LaterScene, Metadata, Recording, SourceFile, Values, check_length, play_fields as fields,
};
use frixel_lab::simulate::PlayOptions;
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde::{Deserialize, Serialize};

use super::error::raised;
use super::scene::NamedFiles;
use super::signals::interruptible;

/// Origin of a play, apart from its scene: what a replay of its recording needs. Python keeps it as JSON.
#[derive(Serialize, Deserialize)]
pub(crate) struct Made {
    pub(crate) metadata: Metadata,
    /// Finger, screen, touch source and stroke.
    pub(crate) files: BTreeMap<String, SourceFile>,
    pub(crate) later_scenes: Vec<LaterScene>,
    pub(crate) markers: Vec<Marker>,
}

/// Name, unit and meaning of each column of a play.
#[pyfunction]
pub(crate) fn play_fields() -> Vec<(String, String, String)> {
    fields().into_iter().map(|field| (field.name, field.unit, field.meaning)).collect()
}

/// Columns by their names: arrays of numbers, with NaN for unknown values, and lists of texts.
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

/// A play as Parquet, the bytes of the file that `frixel play --record` writes. `made` is the [`Made`] that
/// [`super::simulator::simulate`] or [`super::device::Device`] returned.
#[pyfunction]
pub(crate) fn parquet<'py>(
    py: Python<'py>,
    columns: Bound<'_, PyDict>,
    scene: String,
    files: NamedFiles,
    made: &str,
    participant: Option<String>,
) -> PyResult<Bound<'py, PyBytes>> {
    let failed = |error: &dyn std::fmt::Display| {
        raised(py, "FrixelError", (format!("this recording cannot be written ({error})"),))
    };
    let mut taken = Vec::new();
    for field in fields() {
        let Some(column) = columns.get_item(&field.name)? else {
            return Err(failed(&format!("the recording has no column {}", field.name)));
        };
        taken.push(Column { values: values(field.kind, &column)?, field });
    }
    let made: Made = serde_json::from_str(made).map_err(|error| failed(&error))?;
    let Made { metadata, files: own, later_scenes, markers } = made;
    let participant = participant.or(metadata.participant);
    let (kept, hashed): (BTreeMap<_, _>, BTreeMap<_, _>) =
        own.into_iter().partition(|(_, file)| file.bytes().is_some());
    let own: BTreeMap<String, Vec<u8>> =
        kept.iter().filter_map(|(name, file)| Some((name.clone(), file.bytes()?))).collect();
    let own = own.iter().map(|(name, bytes)| (name.clone(), bytes.as_slice()));
    let of_scene = files.iter().map(|(name, bytes)| (format!("{}{name}", PlayOptions::OF_SCENE), bytes.as_slice()));
    let files = SourceFile::all(own.chain(of_scene)).into_iter().chain(hashed).collect();
    let metadata = Metadata { scene, files, later_scenes, markers, participant, ..metadata };
    let recording = Recording { metadata, columns: taken, is_cut_off: false };
    check_length(recording.rows() as u64, recording.columns.len()).map_err(|error| failed(&error))?;
    let mut bytes = Vec::new();
    py.detach(|| recording.write_parquet(&mut bytes)).map_err(|error| failed(&error))?;
    Ok(PyBytes::new(py, &bytes))
}

/// A finger or a screen in place of the scene's own: the text of its file, and its name.
type Profile = Option<(Option<String>, String)>;
/// The contents of a recording: columns, text of the scene, files that it names, finger and screen, [`Made`], and
/// whether the file was cut off.
type Read<'py> = (Bound<'py, PyDict>, String, NamedFiles, [Profile; 2], String, bool);

/// Reads the recording of a play from the bytes of its file. `name` is its name in messages.
#[pyfunction]
pub(crate) fn read_parquet<'py>(py: Python<'py>, recording: Vec<u8>, name: &str) -> PyResult<Read<'py>> {
    let failed = |error: &dyn std::fmt::Display| raised(py, "PlayError", (format!("{name}: {error}"),));
    let Recording { metadata, columns: read, is_cut_off } =
        interruptible(py, |goes_on| Recording::read_parquet(recording, goes_on))?.map_err(|error| failed(&error))?;
    let (found, values): (Vec<Field>, Vec<Values>) =
        read.into_iter().map(|Column { field, values }| (field, values)).unzip();
    if found != fields() {
        return Err(failed(&"this is not a recording of a play: read the table with pandas.read_parquet"));
    }
    // A recording that `Device.record` made has no options.
    let options: Option<PlayOptions> = serde_json::from_value(metadata.play.clone()).ok();
    let profile = |name: fn(PlayOptions) -> Option<String>, file: &str| -> Profile {
        let text = metadata.files.get(file).and_then(SourceFile::bytes).and_then(|bytes| String::from_utf8(bytes).ok());
        Some((text, options.clone().and_then(name)?))
    };
    let profiles = [
        profile(|options| options.finger, PlayOptions::FINGER),
        profile(|options| options.screen, PlayOptions::SCREEN),
    ];
    let mut files = metadata.files.clone();
    let of_scene =
        files.extract_if(PlayOptions::OF_SCENE.to_owned().., |name, _| name.starts_with(PlayOptions::OF_SCENE));
    let named = |(name, file): (String, SourceFile)| {
        Some((name.strip_prefix(PlayOptions::OF_SCENE)?.to_owned(), file.bytes()?))
    };
    let of_scene: NamedFiles = of_scene.filter_map(named).collect();
    let (scene, later_scenes, markers) =
        (metadata.scene.clone(), metadata.later_scenes.clone(), metadata.markers.clone());
    let made = Made { metadata, files, later_scenes, markers };
    let made = serde_json::to_string(&made).map_err(|error| failed(&error))?;
    Ok((columns(py, &found, values)?, scene, of_scene, profiles, made, is_cut_off))
}

/// Plays a recording again from the bytes of its file, and compares it bit by bit. `name` is its name in messages.
/// Returns the number of rows.
#[pyfunction]
pub(crate) fn replay(py: Python<'_>, recording: Vec<u8>, name: &str) -> PyResult<usize> {
    let replayed = interruptible(py, |goes_on| {
        let recorded = Recording::read_parquet(recording, goes_on).map_err(|error| format!(": {error}"))?;
        let played = recorded.replay(goes_on);
        let played = played.map_err(|error| format!(" cannot be played again: {error}"))?;
        match recorded.first_difference(&played) {
            None => Ok(recorded.rows()),
            Some(difference) => Err(format!(
                " does not play the same bits: {difference}; the file was changed, or this machine computes differently"
            )),
        }
    })?;
    replayed.map_err(|sentence| raised(py, "PlayError", (format!("{name}{sentence}"),)))
}
