//! Fingers, screens and touch sources, as texts.

use frixel_hil_sim::TouchConfig;
use frixel_scene::{FingerProfile, NamedProfile, Profile, ProfileError, Screen};
use pyo3::prelude::*;

use super::error::{parameter_error, scene_error};

/// A profile from Python: the text of its file with the file's name, or the name of a bundled profile.
#[derive(Clone, FromPyObject)]
pub(crate) struct ProfileText {
    text: Option<String>,
    name: String,
}

impl ProfileText {
    /// Its name, or the text of its file.
    pub(crate) fn named(&self) -> NamedProfile {
        let Self { text, name } = self.clone();
        NamedProfile { name, text }
    }

    /// Its name in messages.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// The profile.
    pub(crate) fn read<P: Profile>(&self, py: Python<'_>) -> PyResult<P> {
        self.named().read().map_err(|error| match error {
            ProfileError::Mistakes(error) => scene_error(py, &error),
            error @ ProfileError::NotBundled { .. } => parameter_error(py, error),
        })
    }
}

/// Rejects a profile with mistakes. `kind` is `finger`, `screen` or `touch source`.
#[pyfunction]
pub(crate) fn check_profile(py: Python<'_>, kind: &str, profile: ProfileText) -> PyResult<()> {
    match kind {
        "finger" => profile.read::<FingerProfile>(py).map(drop),
        "screen" => profile.read::<Screen>(py).map(drop),
        _ => profile.read::<TouchConfig>(py).map(drop),
    }
}

/// The text of a profile's file, which messages call `name`.
#[pyfunction]
pub(crate) fn profile_text(py: Python<'_>, kind: &str, content: &[u8], name: &str) -> PyResult<String> {
    let kind = match kind {
        "finger" => FingerProfile::KIND,
        "screen" => Screen::KIND,
        _ => TouchConfig::KIND,
    };
    kind.text(content, name).map(str::to_owned).map_err(|error| scene_error(py, &error))
}

/// The names of the bundled profiles of a kind.
#[pyfunction]
pub(crate) fn bundled_profiles(kind: &str) -> Vec<&'static str> {
    match kind {
        "finger" => FingerProfile::bundled_names(),
        "screen" => Screen::bundled_names(),
        _ => TouchConfig::bundled_names().collect(),
    }
}
