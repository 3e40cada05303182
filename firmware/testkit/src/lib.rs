//! Test support that several crates share, on desktop and chip. No image of a real board contains it.
//!
//! - [`HEADER`], [`record`], [`scene`]: scenes to begin with.
//! - [`samples`]: a sample of each kind of layer, from which tests and benchmarks are generated.
//! - [`IdealMonitor`]: the monitor readings of an ideal amplifier.
//! - [`Random`]: random numbers that depend on the seed only, not on the platform.
//! - [`RandomScene`], [`RandomFinger`]: scenes that a board accepts, and fingers to play them under.
//! - `examples`: the scenes in a page of documentation.
//! - `golden`: files of the repository that a test regenerates and compares.
//!
//! ```
//! use frixel_testkit::{Pace, RandomFinger, RandomScene};
//!
//! let scene = RandomScene::new(7, 0x1234_5678);
//! assert!(frixel_layers::Scene::parse(&scene.bytes()).is_ok());
//!
//! let mut finger = RandomFinger::new(7, &scene.header, Pace::Usual);
//! let reports = (0..1_000).filter_map(|_| finger.tick()).count();
//! assert!(reports > 0);
//! ```
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

#[cfg(feature = "std")]
pub mod corpus;
#[cfg(feature = "std")]
pub mod examples;
#[cfg(feature = "std")]
pub mod golden;

#[cfg(feature = "samples")]
mod finger;
#[cfg(feature = "samples")]
mod layers;
#[cfg(feature = "monitor")]
mod monitor;
#[cfg(feature = "samples")]
mod random;
#[cfg(feature = "samples")]
mod random_scene;
#[cfg(feature = "samples")]
pub mod samples;
#[cfg(feature = "scenes")]
mod scenes;

#[cfg(feature = "monitor")]
pub use self::monitor::IdealMonitor;
#[cfg(feature = "samples")]
pub use self::scenes::empirical_header;
#[cfg(feature = "scenes")]
pub use self::scenes::{HEADER, SceneBytes, constant, record, scene, scene_with_points};
#[cfg(feature = "samples")]
pub use self::{
    finger::{Pace, RandomFinger},
    random::Random,
    random_scene::RandomScene,
};
