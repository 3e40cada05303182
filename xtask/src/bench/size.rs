//! Sizes of images, and the depth of their stacks.

use std::fs;
use std::path::Path;

use object::Endianness;
use object::elf::{FileHeader32, PT_LOAD};
use object::read::elf::{FileHeader, ProgramHeader};

use super::figures::Figures;
use super::stack::Functions;
use crate::command::{IMAGES_TARGET_FOLDER, M4F, cargo_in, root, run};

/// A set of features that a board's image is built with.
struct Build {
    /// Suffix of the names of its figures.
    name: &'static str,
    features: &'static [&'static str],
}

/// Folder of the real board, and the name of its image.
const G474: (&str, &str) = ("firmware/board-nucleo-g474re", "board-nucleo-g474re");
const G474_BUILDS: [Build; 2] = [
    Build { name: "full", features: &[] },
    Build { name: "grating_only", features: &["--no-default-features", "--features", "grating"] },
];
/// The main program and the exceptions that can interrupt each other: the tick, and the fault of unreadable flash.
const MAIN: &str = "main";
const TICK: &str = "TIM3";
const EXCEPTIONS: [&str; 2] = [TICK, "NonMaskableInt"];
/// Where RAM begins on every Cortex-M.
const RAM: u64 = 0x2000_0000;
const PERIPHERALS: u64 = 0x4000_0000;

/// Measures the images of the real board, if its folder exists.
pub(super) fn measure(figures: &mut Figures) -> Result<(), String> {
    let (folder, image) = G474;
    if !root().join(folder).is_dir() {
        return Ok(());
    }
    for build in &G474_BUILDS {
        let mut command = cargo_in(folder);
        command
            .args(["build", "--release", "--locked", "--quiet", "--target-dir", IMAGES_TARGET_FOLDER])
            .args(build.features);
        run(&format!("image of {folder}, {}", build.name), &mut command)?;
        // The image of the next set of features takes its place.
        let path = root().join(folder).join(IMAGES_TARGET_FOLDER).join(M4F).join("release").join(image);
        let (flash, ram) = sizes(&path)?;
        figures.put(format!("g474.flash_{}", build.name), flash);
        figures.put(format!("g474.ram_{}", build.name), ram);
        let functions = Functions::read(&path)?;
        // If a tick panicked, the voltage would remain on the electrode until the one-shot expires.
        functions.never_ends(TICK)?;
        match functions.depth(MAIN, &EXCEPTIONS) {
            Ok(bytes) => figures.put(format!("g474.stack_{}", build.name), bytes),
            Err(why) => eprintln!("the depth of the stack is not known: {why}"),
        }
    }
    Ok(())
}

/// Bytes of flash and of RAM in an image, without its stacks.
fn sizes(path: &Path) -> Result<(u64, u64), String> {
    let explain = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = fs::read(path).map_err(|error| explain(&error))?;
    let header = FileHeader32::<Endianness>::parse(&*bytes).map_err(|error| explain(&error))?;
    let endian = header.endian().map_err(|error| explain(&error))?;
    let segments = header.program_headers(endian, &*bytes).map_err(|error| explain(&error))?;
    let (mut flash, mut ram) = (0, 0);
    for segment in segments.iter().filter(|segment| segment.p_type(endian) == PT_LOAD) {
        flash += u64::from(segment.p_filesz(endian));
        if (RAM..PERIPHERALS).contains(&u64::from(segment.p_vaddr(endian))) {
            ram += u64::from(segment.p_memsz(endian));
        }
    }
    Ok((flash, ram))
}
