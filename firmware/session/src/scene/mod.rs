//! Scenes: upload, commit, changes while one plays, and what is stored over power-off.

pub(crate) mod bitmap_directory;
pub(crate) mod commit;
pub(crate) mod live;
pub(crate) mod loading;
pub(crate) mod memory;
#[cfg(feature = "store")]
pub(crate) mod stored;
pub(crate) mod upload;
