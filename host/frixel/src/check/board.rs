//! The smallest firmware that plays a scene.

use frixel_layers::{Carrier, Layer, Region};
use serde::Serialize;

use frixel_scene::Program;

/// Folder of the board's firmware.
const FOLDER: &str = "firmware/board-nucleo-g474re";

/// An image with what a scene asks for and nothing else.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct BoardImage {
    /// Features of `firmware/session`, and of a board's firmware.
    pub features: Vec<&'static str>,
    /// Builds the image, from the repository's root.
    pub command: String,
}

impl BoardImage {
    pub(super) fn of(program: &Program) -> Self {
        let asks = |layer: fn(&Layer) -> bool| program.records.iter().any(|record| layer(&record.layer));
        let polygon = |region: Region| matches!(region, Region::Polygon { .. });
        let features: Vec<&str> = [
            ("grating", asks(|layer| matches!(layer, Layer::Grating(_)))),
            ("bitmap", asks(|layer| matches!(layer, Layer::Bitmap(_)))),
            ("noise", asks(|layer| matches!(layer, Layer::Noise(_)))),
            ("edge", asks(|layer| matches!(layer, Layer::Edge(_) | Layer::Button(_)))),
            ("vibration", asks(|layer| matches!(layer, Layer::Vibration(_)))),
            ("speed", asks(|layer| matches!(layer, Layer::Speed(_)))),
            ("stream", asks(|layer| matches!(layer, Layer::Stream(_)))),
            ("polygon", program.records.iter().any(|record| polygon(record.region))),
            ("sine-carrier", program.header.carrier == Carrier::Sine),
            // `frixel play` follows what a board does.
            ("telemetry", true),
        ]
        .into_iter()
        .filter_map(|(feature, asked)| asked.then_some(feature))
        .collect();
        let list = if features.is_empty() { String::new() } else { format!(" --features {}", features.join(",")) };
        let command = format!("cd {FOLDER} && cargo build --release --no-default-features{list}");
        Self { features, command }
    }
}
