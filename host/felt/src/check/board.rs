//! The smallest firmware image that plays a scene.

use frixel_layers::feature_names;
use frixel_scene::Program;
use frixel_wire::hello::feature;
use serde::Serialize;

/// Folder of the board's firmware.
const FOLDER: &str = "firmware/board-nucleo-g474re";

/// A firmware image with only the features that a scene needs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BoardImage {
    /// Cargo features of `firmware/session` and of the board's firmware.
    pub features: Vec<&'static str>,
    /// Command that builds the image, to be run in the repository's root.
    pub command: String,
}

impl BoardImage {
    pub(super) fn of(program: &Program) -> Self {
        // `frixel play` subscribes to telemetry.
        let needed = program.features() | feature::TELEMETRY;
        let features: Vec<&str> = feature_names().filter(|(bit, _)| needed & bit != 0).map(|(_, name)| name).collect();
        let list = if features.is_empty() { String::new() } else { format!(" --features {}", features.join(",")) };
        let command = format!("cd {FOLDER} && cargo build --release --no-default-features{list}");
        Self { features, command }
    }
}
