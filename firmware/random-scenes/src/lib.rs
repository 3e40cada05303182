//! Random scenes that a board accepts, and fingers to play them under: the same from a seed on desktop and chip.
//!
//! ```
//! use frixel_random_scenes::{Pace, RandomFinger, RandomScene};
//!
//! let scene = RandomScene::new(7, 0x1234_5678);
//! let mut bytes = [0; frixel_layers::SCENE_MAX_LEN];
//! let bytes = scene.write(&mut bytes);
//! assert!(frixel_layers::Scene::parse(bytes).is_ok());
//!
//! let mut finger = RandomFinger::new(7, &scene.header, Pace::Usual);
//! let reports = (0..1_000).filter_map(|_| finger.tick()).count();
//! assert!(reports > 0);
//! ```
#![no_std]
#![forbid(unsafe_code)]

mod dice;
mod finger;
mod layers;
mod scene;

pub use finger::{Pace, RandomFinger, Report};
pub use scene::RandomScene;
