//! The compiled scene.

use std::time::Duration;

use frixel_layers::{FingerLaw, Header, Point, Record, features_of};
use frixel_model::{Carrier, FrictionLaw, ParameterError};
use frixel_wire::scene::bitmap_crc32;

use super::LayerSetting;
use super::diagnostic::{Diagnostic, DiagnosticKind, Message};
use super::layer_map::LayerMap;
use super::played_finger::PlayedFinger;
use super::reach::Reach;
use super::titles::LayerTitle;

/// A compiled scene, with its pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// Parameters of the whole scene. Its voltages are within the board's limits: [`Reach::voltage_max_v_rms`].
    pub header: Header,
    /// The layers from bottom to top, in the order of the file. Some may be optimised away.
    pub records: Vec<Record>,
    /// The setting of each record at the start of a play.
    pub start: Vec<LayerSetting>,
    /// The trigger pattern of each record: alternating on and off times; empty for a record without a pattern.
    pub patterns: Vec<Vec<Duration>>,
    /// The points that records name.
    pub points: Vec<Point>,
    /// The pictures that records name, each one once.
    pub bitmaps: Vec<Bitmap>,
    /// The title of each record in messages, with the number of its layer.
    pub titles: Vec<LayerTitle>,
    /// Maps each layer of the file to its record, for a host that changes layers during play.
    pub layers: LayerMap,
    /// The range of friction that the drive can render.
    pub reach: Reach,
    /// The carrier behind the lag of the board's amplifier.
    pub carrier: Carrier,
    /// The finger that the program is compiled for.
    pub finger: PlayedFinger,
    /// Whether friction out of reach is clamped by the scene's `saturate = true`.
    pub saturates: bool,
    /// Diagnostics of the compiler: refusals in the order of the file, then warnings and notes.
    pub diagnostics: Vec<Diagnostic>,
}

impl Program {
    /// Mean friction under the carrier, by rms voltage. The world's finger has that of [`Header::friction_law`] in
    /// every tick instead.
    ///
    /// # Errors
    ///
    /// As for [`Header::friction_law`]; never for a compiled program.
    pub fn mean_friction(&self) -> Result<FrictionLaw, ParameterError> {
        Ok(self.header.friction_law()?.under_carrier(self.carrier.ripple()))
    }

    /// Whether the program is a draft, which only previews and the in-process simulator play. Every output marks it.
    pub fn is_draft(&self) -> bool {
        self.refusals().next().is_some()
    }

    /// Reasons for which a board refuses the scene; empty unless the program is a draft, see
    /// [`compile_draft`](super::compile_draft).
    pub fn refusals(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.iter().filter(|diagnostic| diagnostic.kind == DiagnosticKind::Refusal)
    }

    /// Reasons to doubt the program's newtons, one sentence each.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.sentences(|message| matches!(message, Message::Warning(_)))
    }

    /// The warning for which boards refuse the program: its finger was not measured at the voltage or the load that it
    /// needs.
    pub fn unmeasured(&self) -> Option<String> {
        let is_refused = |message: &Message| matches!(message, Message::Warning(one) if one.is_refused_by_boards());
        self.sentences(is_refused).next()
    }

    /// Conversions, roundings and clamps, one sentence each.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        self.sentences(|message| matches!(message, Message::Note(_)))
    }

    /// Parts of the file that the program does not need, one sentence each.
    pub fn optimisations(&self) -> impl Iterator<Item = String> {
        self.sentences(|message| matches!(message, Message::Optimisation(_)))
    }

    fn sentences(&self, is_wanted: fn(&Message) -> bool) -> impl Iterator<Item = String> {
        let messages = self.diagnostics.iter().map(|diagnostic| &diagnostic.message);
        messages.filter(move |message| is_wanted(message)).map(ToString::to_string)
    }

    /// The same scene without layers and pictures. A board plays it in between if it has no room for the pictures of
    /// two scenes.
    #[must_use]
    pub fn without_layers(&self) -> Self {
        let header = Header { electric_friction_max_n: None, ..self.header };
        let (records, start, patterns, points, bitmaps, titles) = Default::default();
        Self { header, records, start, patterns, points, bitmaps, titles, ..self.clone() }
    }

    /// The scene's bytes for a board.
    pub fn scene_bytes(&self) -> Vec<u8> {
        self.scene_bytes_with(&self.start)
    }

    /// As [`Self::scene_bytes`], with the gains of these settings, one per record.
    ///
    /// A board turns every layer on at the commit. A layer that is off in `settings` gets the gain 0 until the host
    /// switches it off.
    pub fn scene_bytes_with(&self, settings: &[LayerSetting]) -> Vec<u8> {
        // The compiler has checked the numbers of records and points.
        let mut bytes = self.header.write(self.records.len() as u8, self.points.len() as u8).to_vec();
        let gains = settings.iter().map(|setting| if setting.on { setting.gain } else { 0.0 });
        bytes.extend(self.records.iter().zip(gains).flat_map(|(record, gain)| Record { gain, ..*record }.write()));
        bytes.extend(self.points.iter().flat_map(Point::write));
        bytes.extend(self.header.law.iter().flat_map(FingerLaw::write_points));
        bytes
    }

    /// The feature bits ([`frixel_wire::hello::feature`]) that a board needs to play the program.
    pub fn features(&self) -> u32 {
        features_of(&self.header, self.records.iter().copied())
    }

    /// Whether friction depends on earlier clicks or on a stream, in addition to place, speed and time.
    pub fn has_history(&self) -> bool {
        self.records.iter().any(|record| record.layer.click().is_some() || record.layer.is_streamed())
    }

    /// The bitmap that a record names.
    pub fn bitmap(&self, crc32: u32) -> Option<&Bitmap> {
        self.bitmaps.iter().find(|bitmap| bitmap.crc32 == crc32)
    }
}

/// Samples of a picture, a byte each, row after row from the top left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bitmap {
    /// CRC-32 of the samples: the bitmap's name in the board's pool.
    pub crc32: u32,
    /// Samples in a row.
    pub width: u16,
    /// Number of rows.
    pub height: u16,
    /// The samples: 0 is black, 255 white.
    pub samples: Vec<u8>,
}

impl Bitmap {
    pub(super) fn new(width: u16, height: u16, samples: Vec<u8>) -> Self {
        Self { crc32: bitmap_crc32(width, height, &samples), width, height, samples }
    }
}
