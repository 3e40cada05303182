//! Fingers, screens and touch sources, as texts.

use frixel_hil_sim::TouchConfig;
use frixel_scene::{CompileError, FingerProfile, Nearest, Screen, parse_touch_source};
use pyo3::prelude::*;

use super::error::{parameter_error, scene_error};

/// A profile as Python has it: the text of its file with the file's name, or the name of a bundled one.
#[derive(FromPyObject)]
pub(crate) struct ProfileText {
    text: Option<String>,
    name: String,
}

impl ProfileText {
    /// The name of a bundled profile.
    pub(crate) fn bundled_name(&self) -> Option<&str> {
        if self.text.is_none() { Some(&self.name) } else { None }
    }

    /// The text of its file; `None` of a bundled one.
    pub(crate) fn text(&self) -> Option<&str> {
        self.text.as_deref()
    }

    /// The finger.
    pub(crate) fn finger(&self, py: Python<'_>) -> PyResult<FingerProfile> {
        self.read(py, "finger", FingerProfile::bundled, FingerProfile::bundled_names(), FingerProfile::parse)
    }

    /// The screen.
    pub(crate) fn screen(&self, py: Python<'_>) -> PyResult<Screen> {
        self.read(py, "screen", Screen::bundled, Screen::bundled_names(), Screen::parse)
    }

    /// The touch source.
    pub(crate) fn touch_source(&self, py: Python<'_>) -> PyResult<TouchConfig> {
        self.read(py, "touch source", TouchConfig::bundled, TouchConfig::bundled_names(), parse_touch_source)
    }

    /// What messages call it.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    fn read<T>(
        &self,
        py: Python<'_>,
        what: &str,
        bundled: fn(&str) -> Option<T>,
        bundled_names: impl Iterator<Item = &'static str>,
        parse: fn(&str, &str) -> Result<T, CompileError>,
    ) -> PyResult<T> {
        let Self { text, name } = self;
        match text {
            Some(text) => parse(text, name).map_err(|error| scene_error(py, &error)),
            None => bundled(name).ok_or_else(|| {
                let Nearest { suggestion, known, .. } = Nearest::new(name, bundled_names);
                let advice = suggestion.map_or_else(
                    || format!("the bundled ones are {}", known.join(", ")),
                    |suggestion| format!("did you mean `{suggestion}`?"),
                );
                parameter_error(py, format!("no bundled {what} is called `{name}`: {advice}"))
            }),
        }
    }
}

/// Refuses a profile with mistakes. `kind` is `finger`, `screen` or `touch source`.
#[pyfunction]
pub(crate) fn check_profile(py: Python<'_>, kind: &str, profile: ProfileText) -> PyResult<()> {
    match kind {
        "finger" => profile.finger(py).map(drop),
        "screen" => profile.screen(py).map(drop),
        _ => profile.touch_source(py).map(drop),
    }
}

/// The names of the bundled profiles of a kind.
#[pyfunction]
pub(crate) fn bundled_profiles(kind: &str) -> Vec<&'static str> {
    match kind {
        "finger" => FingerProfile::bundled_names().collect(),
        "screen" => Screen::bundled_names().collect(),
        _ => TouchConfig::bundled_names().collect(),
    }
}
