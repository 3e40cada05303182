//! Samples of each kind of layer, from which tests and benchmarks are generated.
//!
//! [`samples`] returns one for each kind. The tests of this crate compare the bytes of its records, and find the kinds
//! without a sample.
#![allow(clippy::single_range_in_vec_init, reason = "most kinds use one range of bytes")]

#[cfg(feature = "std")]
mod formula;
mod of_place;
mod of_time_and_borders;

use core::ops::Range;

use frixel_layers::{Blend, Click, Header, Layer, Point, Record, Region, Wave};
use frixel_wire::scene::{CURVE_POINTS_MAX, POLYGON_POINTS_MAX};

use crate::random::Random;

#[cfg(feature = "std")]
pub use formula::{Formula, along_deg, noise, sine, turn};
pub use of_place::{bitmap_to_count, grating_to_count};

/// The data of a kind of layer for tests and benchmarks.
pub struct Sample {
    /// A layer of each form of the kind.
    pub records: &'static [SampleRecord],
    /// Layers whose evaluation a benchmark counts.
    pub costs: &'static [CostCase],
    /// Draws a layer of the kind.
    pub random: fn(&mut Draw) -> Layer,
    /// Scene files of the kind, each with a formula of its friction.
    #[cfg(feature = "std")]
    pub formulas: &'static [Formula],
}

/// A layer in a scene with [`POINTS`].
pub struct SampleRecord {
    /// The record. A bitmap has the name [`PICTURE`].
    pub record: Record,
    /// The bytes of the record that the kind uses, from the tables in `PROTOCOL.md`.
    pub used: &'static [Range<usize>],
}

/// A layer whose evaluation a benchmark counts, at the most expensive input.
pub struct CostCase {
    /// Name of the count. `tick_KIND_alone` becomes the cost `KIND`, and `tick_KIND_over_OTHER_alone` the part of it
    /// above the cost `OTHER`.
    pub name: &'static str,
    /// Where the layer acts. The finger is there.
    pub region: Region,
    /// The layer.
    pub layer: Layer,
}

/// CRC-32 of the bitmap in the samples; [`with_bitmap_crc32`] replaces it.
pub const PICTURE: u32 = 0xcbf4_3926;

/// The points that the samples refer to: a curve of two points, and a triangle of three.
pub const POINTS: [Point; 4] = [
    Point { x: 0.0, y: 0.5 },
    Point { x: 0.0625, y: 0.03125 },
    Point { x: 0.09, y: 0.0625 },
    Point { x: 0.05, y: 0.0625 },
];

/// The screen of a benchmark.
pub const AROUND: Region = Region::Rectangle { x_m: 0.0, y_m: 0.0, width_m: 0.12, height_m: 0.11 };
const RECTANGLE: Region = Region::Rectangle { x_m: 0.01, y_m: 0.02, width_m: 0.03, height_m: 0.04 };
const ELLIPSE: Region = Region::Ellipse { x_m: 0.02, y_m: 0.01, width_m: 0.04, height_m: 0.03 };
const POLYGON: Region = Region::Polygon { first: 1, count: 3 };

/// The sample of each kind of layer.
pub fn samples() -> impl Iterator<Item = &'static Sample> + Clone {
    of_place::SAMPLES.iter().chain(of_time_and_borders::SAMPLES)
}

/// The records of all samples.
pub fn sample_records() -> impl Iterator<Item = &'static SampleRecord> + Clone {
    samples().flat_map(|sample| sample.records)
}

/// The layer, with this CRC-32 if it is a bitmap.
#[must_use]
pub const fn with_bitmap_crc32(mut layer: Layer, crc32: u32) -> Layer {
    if let Layer::Bitmap(bitmap) = &mut layer {
        bitmap.crc32 = crc32;
    }
    layer
}

const fn sample(region: Region, blend: Blend, gain: f32, layer: Layer, used: &'static [Range<usize>]) -> SampleRecord {
    SampleRecord { record: Record { region, blend, gain, layer }, used }
}

const fn cost(name: &'static str, layer: Layer) -> CostCase {
    CostCase { name, region: AROUND, layer }
}

/// The inputs for drawing a random layer.
pub struct Draw<'a> {
    /// The random numbers.
    pub random: &'a mut Random,
    /// The scene's header.
    pub header: &'a Header,
    /// The name of the picture.
    pub picture: u32,
    /// Two frictions, N, or factors.
    pub amounts: [f32; 2],
    /// A click, which may have no height.
    pub click: Click,
    /// An angle from -1 to 1 turn.
    pub turned: f32,
    pub(crate) amount: fn(&mut Random) -> f32,
    pub(crate) points: &'a mut NewPoints,
}

impl Draw<'_> {
    /// Another friction, N, or factor.
    pub fn amount(&mut self) -> f32 {
        (self.amount)(self.random)
    }

    /// Any of the waves.
    pub fn wave(&mut self) -> Wave {
        self.random.pick([Wave::Sine, Wave::Square { duty: 0.3 }, Wave::Triangle, Wave::Saw])
    }

    /// Waves per second that pass a place; 0 with a probability of one half.
    pub fn drift_hz(&mut self) -> f32 {
        let moving = self.random.between(-50.0, 50.0);
        self.random.pick([0.0, moving])
    }

    /// A place on the screen or beyond its edges by up to a part of its size, m.
    pub fn place_m(&mut self, beyond: f32) -> [f32; 2] {
        [self.header.screen_width_m, self.header.screen_height_m]
            .map(|size_m| self.random.between(-beyond, 1.0 + beyond) * size_m)
    }

    /// Adds points to the scene, and returns the numbers that they have.
    pub fn add_points(&mut self, points: impl Iterator<Item = Point>) -> Range<u8> {
        self.points.add(points)
    }
}

/// Points that a record needs, and the first free point number.
pub(crate) struct NewPoints {
    pub(crate) first: u8,
    pub(crate) points: heapless::Vec<Point, { POLYGON_POINTS_MAX + CURVE_POINTS_MAX }>,
}

impl NewPoints {
    pub(crate) fn add(&mut self, points: impl Iterator<Item = Point>) -> Range<u8> {
        let start = self.first + self.points.len() as u8;
        self.points.extend(points);
        start..self.first + self.points.len() as u8
    }
}
