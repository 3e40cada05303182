//! What a scene compiles to.

use frixel_layers::{Header, Point, Record, features_of};
use frixel_wire::hello::{PROTOCOL_MAJOR, PROTOCOL_MINOR};
use frixel_wire::scene::bitmap_crc32;

use super::layer_map::LayerMap;
use super::left_out::LeftOut;
use super::reach::Reach;

/// The protocol that knows [`Header::layers_fixed`].
const LAYERS_FIXED_SINCE: (u8, u8) = (1, 2);
/// The protocol that knows [`Header::electric_friction_max_n`].
const ELECTRIC_FRICTION_MAX_SINCE: (u8, u8) = (1, 3);

/// A scene as a board plays it, with the pictures that it names.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// What holds for the whole scene. Voltages are what the board can reach: see [`Reach::voltage_max_v_rms`].
    pub header: Header,
    /// The layers from bottom to top, in the order of the file; some may be left out.
    pub records: Vec<Record>,
    /// The points that records name.
    pub points: Vec<Point>,
    /// The pictures that records name, each one once.
    pub bitmaps: Vec<Bitmap>,
    /// How messages call each record: its number from one, and its name or kind.
    pub titles: Vec<String>,
    /// Which record each layer of the file became, for a host that changes layers while they play.
    pub layers: LayerMap,
    /// What the finger can be given.
    pub reach: Reach,
    /// Ticks of half a carrier period.
    pub half_period_ticks: u32,
    /// What was converted, rounded or clamped, a sentence each.
    pub notes: Vec<String>,
    /// What the file has and the program does without.
    pub left_out: Vec<LeftOut>,
}

impl Program {
    /// The scene's bytes, as they are uploaded to a board of this version.
    pub fn scene_bytes(&self) -> Vec<u8> {
        self.scene_bytes_for((PROTOCOL_MAJOR, PROTOCOL_MINOR))
    }

    /// The scene's bytes, as they are uploaded to a board that speaks a protocol, major and minor: one that is older does
    /// without the flags that came later.
    pub fn scene_bytes_for(&self, protocol: (u8, u8)) -> Vec<u8> {
        let layers_fixed = self.header.layers_fixed && protocol >= LAYERS_FIXED_SINCE;
        let electric_friction_max_n =
            self.header.electric_friction_max_n.filter(|_| protocol >= ELECTRIC_FRICTION_MAX_SINCE);
        let header = Header { layers_fixed, electric_friction_max_n, ..self.header };
        // At most 64 records and 128 points were compiled.
        let mut bytes = header.write(self.records.len() as u8, self.points.len() as u8).to_vec();
        bytes.extend(self.records.iter().flat_map(Record::write));
        bytes.extend(self.points.iter().flat_map(Point::write));
        bytes
    }

    /// The bits of [`frixel_wire::hello::feature`] that a board needs to play it.
    pub fn features(&self) -> u32 {
        features_of(&self.header, self.records.iter().copied())
    }

    /// Whether the friction at a place depends on what happened before, beside the time: on a click, or on a stream.
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
    /// Rows.
    pub height: u16,
    /// The samples: 0 is black, 255 white.
    pub samples: Vec<u8>,
}

impl Bitmap {
    pub(super) fn new(width: u16, height: u16, samples: Vec<u8>) -> Self {
        Self { crc32: bitmap_crc32(width, height, &samples), width, height, samples }
    }
}
