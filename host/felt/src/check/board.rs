//! The smallest firmware image that plays a scene.

use frixel_layers::feature_names;
use frixel_scene::Program;
use frixel_wire::hello::{BoardKind, feature};
use serde::Serialize;

/// A firmware image with only the features that a scene needs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BoardImage {
    /// Cargo features of `firmware/session` and of the board's firmware.
    pub features: Vec<&'static str>,
    /// Command that builds the image, to be run in the repository's root.
    pub command: String,
}

impl BoardImage {
    /// The image for a kind of board; for the NUCLEO-G474RE if that kind is simulated.
    pub fn of(program: &Program, kind: BoardKind) -> Self {
        let (folder, target, processor) = match kind {
            BoardKind::Pico => ("firmware/board-pico", " --target thumbv6m-none-eabi", Some("rp2040")),
            BoardKind::Pico2 => ("firmware/board-pico", "", Some("rp2350")),
            _ => ("firmware/board-nucleo-g474re", "", None),
        };
        // `frixel play` subscribes to telemetry.
        let needed = program.features() | feature::TELEMETRY;
        let kinds = feature_names().filter(|(bit, _)| needed & bit != 0).map(|(_, name)| name);
        let features: Vec<&str> = processor.into_iter().chain(kinds).collect();
        let list = if features.is_empty() { String::new() } else { format!(" --features {}", features.join(",")) };
        let command = format!("cd {folder} && cargo build --release{target} --no-default-features{list}");
        Self { features, command }
    }
}
