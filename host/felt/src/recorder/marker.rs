//! Events during a play, with their times.

use frixel_scene::{LayerSetting, Program};
use serde::{Deserialize, Serialize};

/// An event of a play, on the clock of its rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Marker {
    /// Ticks since time zero of the record.
    pub ticks: u64,
    /// The same time, s.
    pub t_s: f64,
    /// The event.
    #[serde(flatten)]
    pub event: MarkedEvent,
}

/// An event at a [`Marker`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub enum MarkedEvent {
    /// The scene began to play, or a playing board sent its first report: time zero.
    SceneBegan,
    /// Another scene plays from here on.
    SceneReplaced,
    /// A layer gets a new setting.
    LayerChanged {
        /// The layer's title, as in messages.
        layer: String,
        /// Whether the layer is on.
        on: bool,
        /// The gain of the layer.
        gain: f32,
    },
    /// A layer was triggered. Switching it on and off are separate events.
    Triggered {
        /// The layer's title, as in messages.
        layer: String,
    },
    /// The host asked the board to play a stream.
    StreamStarted {
        /// Samples a second.
        sample_hz: u32,
    },
    /// The stream has no further samples.
    StreamEnded,
    /// The host switched the output off.
    Stopped,
}

/// The markers of a record, and the titles of its layers.
#[derive(Debug, Default)]
pub(super) struct Markers {
    markers: Vec<Marker>,
    titles: Vec<String>,
}

impl Markers {
    /// Takes the titles of the layers from this program.
    pub(super) fn name_layers(&mut self, program: &Program) {
        self.titles = program.titles.iter().map(ToString::to_string).collect();
    }

    pub(super) fn add(&mut self, ticks: u64, t_s: f64, event: MarkedEvent) {
        self.markers.push(Marker { ticks, t_s, event });
    }

    pub(super) fn changed(&self, record: u8, setting: LayerSetting) -> MarkedEvent {
        MarkedEvent::LayerChanged { layer: self.title(record), on: setting.on, gain: setting.gain }
    }

    /// The title of a layer by its record number.
    pub(super) fn title(&self, record: u8) -> String {
        self.titles.get(usize::from(record)).cloned().unwrap_or_else(|| format!("record {record}"))
    }

    pub(super) fn as_slice(&self) -> &[Marker] {
        &self.markers
    }
}
