//! The command as a scene's designer uses it, as a process of its own.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod demo;
mod first_scene;
mod numbers;
mod pictures;
#[cfg(unix)]
mod pipes;
