//! The options `--finger`, `--screen` and `--touch`.

use std::path::Path;

use crate::scene_file::{self, ProfileNames, SceneFileError};
use clap::Args;
use frixel_hil_sim::{TouchConfig, WorldConfig};

#[derive(Clone, Debug, Default, Args)]
pub(super) struct ProfileArgs {
    /// The finger in place of the scene's own: a profile's file, or `example`, `dry`, `moist` or `light`.
    #[arg(long, value_name = "FILE")]
    finger: Option<String>,
    /// The screen in place of the scene's own: a screen's file, or `example`.
    #[arg(long, value_name = "FILE")]
    screen: Option<String>,
}

impl ProfileArgs {
    pub(super) fn names(&self) -> ProfileNames {
        ProfileNames { finger: self.finger.clone(), screen: self.screen.clone() }
    }
}

#[derive(Clone, Debug, Default, Args)]
pub(super) struct TouchArgs {
    /// The simulated touch source: `100`, `200` or `500` reports a second, 10, 5 or 3 ms late, or a touch source's file
    /// (docs/touch.md). Without it, 100.
    #[arg(long, value_name = "NAME|FILE")]
    touch: Option<String>,
}

impl TouchArgs {
    /// The name of the source, if it is a bundled one.
    pub(super) fn bundled_name(&self) -> Option<&str> {
        self.touch.as_deref().filter(|name| TouchConfig::bundled(name).is_some())
    }

    pub(super) fn is_given(&self) -> bool {
        self.touch.is_some()
    }

    /// The file of the source, if it is in one.
    pub(super) fn file(&self) -> Option<&Path> {
        self.touch.as_deref().filter(|name| TouchConfig::bundled(name).is_none()).map(Path::new)
    }

    /// The source, if it is given.
    pub(super) fn source(&self) -> Result<Option<TouchConfig>, SceneFileError> {
        self.touch.as_deref().map(scene_file::touch_source).transpose()
    }

    /// A world with this source, which is ideal or realistic already.
    pub(super) fn applied_to(&self, world: WorldConfig, is_ideal: bool) -> Result<WorldConfig, SceneFileError> {
        let source = self.source()?.map(|source| if is_ideal { source.without_losses() } else { source });
        Ok(WorldConfig { touch: source.unwrap_or(world.touch), ..world })
    }
}
