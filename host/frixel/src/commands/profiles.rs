//! The options `--finger` and `--screen`.

use crate::scene_file::ProfileNames;
use clap::Args;

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
