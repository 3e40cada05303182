//! The emulated board's image, or the reason why it is unavailable.
#![allow(dead_code, unreachable_pub, clippy::panic, reason = "part of tests, which may fail, and use what they need")]

use std::io::Write;

use frixel_hil_sim::emulated::{EmulatedBoard, EmulatorError, Image};

/// The image. Without emulator or target, the test is skipped with a message; in CI it fails.
pub fn image() -> Option<Image> {
    built(EmulatedBoard::Mps2An386)
}

/// The images that tick in lockstep, likewise.
pub fn lockstep_images() -> impl Iterator<Item = Image> {
    [EmulatedBoard::Mps2An386, EmulatedBoard::Mps2An505].into_iter().filter_map(built)
}

/// The image of the Pico, likewise.
pub fn pico_image() -> Option<Image> {
    built(EmulatedBoard::Pico)
}

/// The image of the Pico that takes the finger's place from an optical frame, likewise.
pub fn pico_image_with_frame() -> Option<Image> {
    built(EmulatedBoard::PicoWithFrame)
}

fn built(board: EmulatedBoard) -> Option<Image> {
    match Image::build(board) {
        Ok(image) => Some(image),
        Err(missing @ EmulatorError::NotInstalled { .. }) if !is_ci() => {
            let _ = writeln!(std::io::stderr(), "SKIPPED on {board:?}: {missing}");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

pub fn is_ci() -> bool {
    std::env::var_os("CI").is_some_and(|ci| !ci.is_empty() && ci != "false" && ci != "0")
}
