//! The compiled scene: a header, fixed-size records and points, little-endian, the same bytes on the wire and in flash.
//!
//! Every friction in a scene is **electric friction**: what the drive adds above `mu F_N`, in newtons; of a layer that
//! is multiplied, the same numbers are plain factors. Lengths are in metres from the screen's top left corner, x to the
//! right, y down. Angles are in turns, from x towards y.

mod codec;
pub mod cost;
mod error;
mod grid;
mod kind;
mod point;
mod view;

pub use error::SceneError;
pub use grid::{Cell, Grid, LayerSet};
pub use kind::{Beat, Burst, Click, Layer, Wave};
pub use point::Point;
pub use view::Scene;

use crate::frame::Crc32;

/// Version of the layout.
pub const SCENE_VERSION: u16 = 2;
/// Bytes of the header.
pub const HEADER_LEN: usize = 56;
/// Bytes of a record.
pub const RECORD_LEN: usize = 56;
/// Most records that the layout allows.
pub const RECORDS_MAX: usize = 64;
/// Bytes of a point.
pub const POINT_LEN: usize = 8;
/// Most points that the layout allows, those of all polygons and curves together.
pub const POINTS_MAX: usize = 128;
/// Most vertices of a polygon.
pub const POLYGON_POINTS_MAX: usize = 32;
/// Most points of a curve of speed.
pub const CURVE_POINTS_MAX: usize = 16;
/// Bytes of the largest scene.
pub const SCENE_MAX_LEN: usize = HEADER_LEN + RECORDS_MAX * RECORD_LEN + POINTS_MAX * POINT_LEN;

/// CRC-32 that names a bitmap: of its width and height, each little-endian in two bytes, and its samples. The shape is
/// part of the name, since the same bytes in another shape are another picture.
pub fn bitmap_crc32(width: u16, height: u16, samples: &[u8]) -> u32 {
    bitmap_digest(width, height).update(samples).finish()
}

/// [`bitmap_crc32`] of samples that come piece by piece.
pub fn bitmap_digest(width: u16, height: u16) -> Crc32 {
    let mut digest = Crc32::new();
    digest.update(&width.to_le_bytes()).update(&height.to_le_bytes());
    digest
}

/// What holds for the whole scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Header {
    /// Width of the screen, m.
    pub screen_width_m: f32,
    /// Height of the screen, m.
    pub screen_height_m: f32,
    /// Finger radius `R`, m.
    pub finger_radius_m: f32,
    /// Winkler-Fuss stiffness `k`, Pa/m.
    pub stiffness_pa_per_m: f32,
    /// Friction coefficient `mu`.
    pub friction_coefficient: f32,
    /// Normal load `F_N` at which the scene is meant, N.
    pub normal_load_n: f32,
    /// Effective gap `h0/eps` of the coating, m.
    pub effective_gap_m: f32,
    /// Largest rms voltage, V.
    pub voltage_max_v_rms: f32,
    /// Largest peak voltage, V.
    pub voltage_max_v_peak: f32,
    /// Fastest change of the envelope, V/s.
    pub slew_v_per_s: f32,
    /// Carrier frequency, Hz.
    pub carrier_hz: f32,
    /// Time without a word from the host after which the output goes to zero, s.
    pub host_timeout_s: f32,
    /// Shape of the carrier.
    pub carrier: Carrier,
    /// The scene goes on without a host.
    pub autonomous: bool,
    /// The tick estimates where the finger is now from late samples; without it, it takes the last sample as it is.
    pub prediction: bool,
    /// Which finger is followed when the host tells of several.
    pub leader: Leader,
    /// No layer is changed while the scene plays: the board prepares for what the records ask for and no more, and refuses
    /// a change.
    pub layers_fixed: bool,
}

/// Shape of the carrier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Carrier {
    /// Plus and minus the envelope: the square of the voltage has no ripple.
    #[default]
    Square,
    /// A sine whose rms is the envelope.
    Sine,
}

/// Which of several fingers is followed, since one electrode gives one effect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Leader {
    /// The one that came first of those that are on the screen.
    #[default]
    First,
    /// The one that came last.
    Latest,
}

/// One layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Where the layer acts.
    pub region: Region,
    /// How it joins the layers before it.
    pub blend: Blend,
    /// Factor on what the layer gives.
    pub gain: f32,
    /// What the layer is.
    pub layer: Layer,
}

/// Where a layer acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Region {
    /// Everywhere.
    Screen,
    /// A rectangle with sides along the screen's; left and top edge belong to it, right and bottom do not.
    Rectangle {
        /// Left edge, m.
        x_m: f32,
        /// Top edge, m.
        y_m: f32,
        /// Width, m.
        width_m: f32,
        /// Height, m.
        height_m: f32,
    },
    /// The ellipse that touches the sides of a rectangle; its border belongs to it.
    Ellipse {
        /// Left end, m.
        x_m: f32,
        /// Top end, m.
        y_m: f32,
        /// Width, m.
        width_m: f32,
        /// Height, m.
        height_m: f32,
    },
    /// A polygon, by the even-odd rule. Left and top edges belong to it, right and bottom ones do not, so that of two
    /// polygons with a common edge each place is in one.
    Polygon {
        /// Its first vertex among the scene's points, m.
        first: u8,
        /// How many vertices it has, 3 to [`POLYGON_POINTS_MAX`]; the last is joined to the first.
        count: u8,
    },
}

/// How a layer joins the layers before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// It takes their place.
    #[default]
    Replace,
    /// It is added to them.
    Add,
    /// They are multiplied by it: its numbers are plain factors.
    Multiply,
    /// The larger of the two counts.
    Max,
}
