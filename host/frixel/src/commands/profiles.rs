//! The options `--finger`, `--screen` and `--touch`.

use std::path::Path;

use crate::scene_file::{ProfileNames, SceneFileError, file_of, named, profile};
use anyhow::Result;
use clap::Args;
use frixel_hil_sim::{TouchConfig, WorldOptions};
use frixel_scene::{NamedProfile, Screen};

#[derive(Clone, Debug, Args)]
pub(super) struct ProfileArgs {
    /// Finger in place of the scene's: `example`, `dry`, `moist`, `light` or a profile's file.
    #[arg(long, value_name = "NAME|FILE")]
    finger: Option<String>,
    /// Screen in place of the scene's: `example` or a screen's file.
    #[arg(long, value_name = "NAME|FILE")]
    screen: Option<String>,
}

impl ProfileArgs {
    pub(super) fn names(&self) -> ProfileNames {
        ProfileNames { finger: self.finger.clone(), screen: self.screen.clone() }
    }
}

#[derive(Clone, Debug, Args)]
pub(super) struct TouchArgs {
    /// Simulated touch source: `100`, `200`, `500` reports a second or a file. Default: 100.
    #[arg(long, value_name = "NAME|FILE")]
    touch: Option<String>,
}

impl TouchArgs {
    /// The name of the source, or the text of its file.
    pub(super) fn named(&self) -> Result<Option<NamedProfile>, SceneFileError> {
        self.touch.as_deref().map(named::<TouchConfig>).transpose()
    }

    pub(super) fn is_given(&self) -> bool {
        self.touch.is_some()
    }

    /// The file of the source, if it is read from one.
    pub(super) fn file(&self) -> Option<&Path> {
        file_of::<TouchConfig>(self.touch.as_ref())
    }

    /// The source, if it is given.
    pub(super) fn source(&self) -> Result<Option<TouchConfig>, SceneFileError> {
        self.touch.as_deref().map(profile).transpose()
    }

    /// Options of a world with this source.
    pub(super) fn world(&self, ideal: bool) -> Result<WorldOptions, SceneFileError> {
        Ok(WorldOptions { ideal, touch: self.source()?, ..WorldOptions::default() })
    }
}

/// The screen of an experiment, by a bundled name or a file, and the name by which profiles refer to it.
pub(super) fn screen(named: Option<&str>) -> Result<(String, Screen)> {
    let Some(named) = named else { return Ok(("example".to_owned(), Screen::example())) };
    let screen: Screen = profile(named)?;
    let name = screen.name.clone().unwrap_or_else(|| {
        Path::new(named).file_stem().map_or_else(|| named.to_owned(), |stem| stem.to_string_lossy().into_owned())
    });
    Ok((name, screen))
}
