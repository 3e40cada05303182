//! A compiled scene: its bytes, its checks, its cost, and its evaluation at the finger.
//!
//! # Inputs and outputs
//!
//! The host's compiler creates a [`Header`], [`Record`]s and [`Point`]s, and writes them to bytes for the upload. It
//! computes their cost with [`cost`], and their largest electric friction with [`electric_friction_max_n`].
//!
//! A board reads the bytes ([`Scene::parse`]). At the commit, it checks the records against the accepted ranges, and
//! converts them to [`ActiveLayers`], in which everything that is constant during a play is precomputed. In every tick,
//! [`ActiveLayers::electric_friction_n`] takes the [`Inputs`] (place and velocity of the finger, time, stream sample),
//! the samples of bitmaps ([`BitmapPool`]) and the state of clicks ([`Clicks`]), and returns the electric friction
//! under the finger, in newtons.
//!
//! Every friction in a scene is **electric friction**: the friction added by the drive above `mu F_N`, in newtons. With
//! the multiplicative blend, the same numbers are dimensionless factors. Lengths are in metres from the screen's top
//! left corner, x to the right, y down. Angles are in turns, from x towards y.
//!
//! # How a kind of layer is described
//!
//! A kind is one file in `kinds/`. It declares
//!
//! - its parameters, with `parameters!`: for each one the type, the offset in the record, the range that a board
//!   accepts, and the meaning with its unit. Reading, writing and checking are generated from this;
//! - its `Kind`: the most core cycles that its evaluation takes, the bounds of its friction, and how the
//!   parameters become coefficients;
//! - its coefficients, with `Evaluate`: the friction at the finger's place.
//!
//! `kind.rs` contains the traits. The list at the end of `kinds.rs` assigns the number in records and the Cargo
//! feature; all code that covers all kinds is generated from that list. Parts shared by several kinds have their own
//! modules: waves, clicks, regions, blends, points.
//!
//! # Order of the modules
//!
//! A module uses only modules of earlier lines, and modules to its left on the same line:
//!
//! 1. numbers: `interval`, `cosine`, `angle`, `square_root`, `measured` (costs of evaluations);
//! 2. bytes: `layout` (common to all records), `parameters`, `point`, `header`;
//! 3. inputs and state of an evaluation: `bitmap_pool`, `clicks`, `noise_waves`, `tables`, `context`, `prepare`;
//! 4. the parts of a layer: `blend`, `region`, `click`, `kind`, `wave`, `kinds`, `record`;
//! 5. a scene: `scene`, `grid`, `cost`, `bounds`, `active`.
//!
//! # Features
//!
//! Every Cargo feature is a kind of layer or of region, and all are enabled by default. A board without a feature has a
//! smaller image, and refuses scenes that need it ([`disabled_record`]). [`FEATURES`] are the feature bits in its
//! hello, and [`KIND_FEATURES`] the bits of all kinds. A test writes the features of the kinds into the manifests.
//! Constant layers, rectangles, ellipses and all blends are always included.
//!
//! # Speed and size
//!
//! Functions called by the tick are `#[inline]`, so that they are compiled with the tick's crate, which a board builds
//! for speed. The rest is built for size.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

mod active;
mod angle;
mod bitmap_pool;
mod blend;
mod bounds;
mod click;
mod clicks;
mod context;
mod cosine;
pub mod cost;
mod finger_law;
mod grid;
mod header;
mod interval;
mod kind;
mod kinds;
mod layout;
mod measured;
#[cfg(feature = "noise")]
mod noise_waves;
mod parameters;
mod point;
mod prepare;
mod record;
mod region;
mod scene;
mod square_root;
mod tables;
#[cfg(test)]
mod tests;
mod wave;

pub use active::{ActiveLayers, active_bytes};
pub use angle::angle_turns;
pub use bitmap_pool::{BITMAP_POOL_LEN, BitmapPool, StoredBitmap};
pub use blend::Blend;
pub use bounds::electric_friction_max_n;
pub use click::Click;
pub use clicks::{CLICKS_MAX, Clicks};
pub use context::{Inputs, StreamSample};
pub use cosine::cosine;
pub use finger_law::{FingerLaw, LAW_POINTS_MAX};
pub use frixel_model::LawPoint;
pub use frixel_model::Waveform;
pub use grid::{Cell, Grid, LayerSet, layer_numbers, layer_set};
pub use header::{
    CARRIER_MIN_HZ, HALF_PERIOD_MIN_TICKS, HEADER_LEN, HOST_TIMEOUTS_MS, HOST_TIMEOUTS_S, Header, Leader, SCENE_VERSION,
};
pub use interval::{Interval, Number};
#[cfg(feature = "vibration")]
pub use kinds::vibration::{Beat, Burst};
pub use kinds::*;
pub use layout::RECORD_LEN;
pub use parameters::{Range, range, within};
pub use point::{POINT_LEN, Point};
pub use prepare::ticks;
pub use record::{Record, disabled_record};
pub use region::Region;
pub use scene::{SCENE_MAX_LEN, Scene, features_of};
pub use square_root::square_root;
pub use tables::NOISES_MAX;
pub use wave::Wave;

use frixel_wire::hello::feature;

/// Feature bits of the hello for the enabled kinds of layers and regions, and for empirical laws.
pub const FEATURES: u32 = kinds::KIND_FEATURES_ON
    | if cfg!(feature = "polygon") { feature::POLYGON } else { 0 }
    | if cfg!(feature = "empirical") { feature::EMPIRICAL } else { 0 };

/// Bit and name of each feature of the hello, by ascending bit. The name is that of the board's Cargo feature, if there
/// is one.
pub fn feature_names() -> impl Iterator<Item = (u32, &'static str)> {
    let all = || KIND_FEATURES.iter().map(|kind| (kind.bit, kind.name)).chain(feature::NAMES);
    (0..u32::BITS).filter_map(move |bit| all().find(|(named, _)| *named == 1 << bit))
}
