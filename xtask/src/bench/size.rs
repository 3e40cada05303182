//! Sizes of images, and the depth of their stacks.

use std::fs;
use std::path::{Path, PathBuf};

use object::Endianness;
use object::elf::{FileHeader32, PT_LOAD};
use object::read::elf::{FileHeader, ProgramHeader};

use super::figures::Figures;
use super::stack::Functions;
use crate::command::{IMAGES_TARGET_FOLDER, M0_PLUS, M4F, M33, cargo_in, root, run};

/// A set of features that a board's image is built with.
struct Build {
    /// Suffix of the names of its figures.
    name: &'static str,
    features: &'static [&'static str],
}

/// A board: its folder, the name of its image, and what that is compiled for.
struct Board(&'static str, &'static str, &'static str);

const G474: Board = Board("firmware/board-nucleo-g474re", "board-nucleo-g474re", M4F);
const FULL: Build = Build { name: "full", features: &[] };
const G474_BUILDS: [Build; 2] =
    [FULL, Build { name: "grating_only", features: &["--no-default-features", "--features", "grating"] }];
/// Both boards of one folder, with the prefix of the names of their figures.
const PICOS: [(&str, Board, [Build; 2]); 2] = [
    (
        "pico_2",
        Board("firmware/board-pico", "board-pico", M33),
        [FULL, Build { name: "grating_only", features: &["--no-default-features", "--features", "rp2350,grating"] }],
    ),
    (
        "pico",
        Board("firmware/board-pico", "board-pico", M0_PLUS),
        [
            Build { name: "full", features: &["--no-default-features", "--features", "rp2040,everything"] },
            Build { name: "grating_only", features: &["--no-default-features", "--features", "rp2040,grating"] },
        ],
    ),
];
/// The tick of the Picos.
const PICO_TICK: &str = "PIO0_IRQ_0";
/// The main program and the NUCLEO's exceptions that can interrupt each other: the tick, and the fault of unreadable
/// flash.
const MAIN: &str = "main";
const TICK: &str = "TIM3";
const EXCEPTIONS: [&str; 2] = [TICK, "NonMaskableInt"];
/// The emulated board.
const AN386: Board = Board("firmware/board-mps2-an386", "board-mps2-an386", M4F);
/// The serial port's interrupts, of one priority, are counted as if one could interrupt the other.
const AN386_EXCEPTIONS: [&str; 3] = ["UART0_RX", "UART0_TX", "SysTick"];
/// Where RAM begins on every Cortex-M.
const RAM: u64 = 0x2000_0000;
const PERIPHERALS: u64 = 0x4000_0000;

/// Measures the images of the real boards, and the stack of the emulated board. An image for the Pico takes as much RAM
/// as flash for its code, which runs there.
pub(super) fn measure(figures: &mut Figures) -> Result<(), String> {
    for (name, board, builds) in &PICOS {
        for build in builds {
            let path = image(board, build.name, build.features)?;
            let (flash, ram) = sizes(&path)?;
            figures.put(format!("{name}.flash_{}", build.name), flash);
            figures.put(format!("{name}.ram_{}", build.name), ram);
            // As for the NUCLEO's tick below. The depth of the stack is not known: the main program calls the boot ROM.
            Functions::read(&path)?.never_ends(PICO_TICK)?;
        }
    }
    if root().join(G474.0).is_dir() {
        for build in &G474_BUILDS {
            let path = image(&G474, build.name, build.features)?;
            let (flash, ram) = sizes(&path)?;
            figures.put(format!("g474.flash_{}", build.name), flash);
            figures.put(format!("g474.ram_{}", build.name), ram);
            let functions = Functions::read(&path)?;
            // If a tick panicked, the voltage would remain on the electrode until the one-shot expires.
            functions.never_ends(TICK)?;
            measure_stack(figures, format!("g474.stack_{}", build.name), &functions, &EXCEPTIONS);
        }
    }
    let functions = Functions::read(&image(&AN386, FULL.name, FULL.features)?)?;
    measure_stack(figures, "an386.stack".to_owned(), &functions, &AN386_EXCEPTIONS);
    Ok(())
}

/// Measures the NUCLEO's image without the features that scenes and hosts ask for, and with each one alone: what the
/// report of a scene adds up.
pub(super) fn measure_features(figures: &mut Figures) -> Result<(), String> {
    let manifest = root().join(G474.0).join("Cargo.toml");
    let explain = |error: &dyn std::fmt::Display| format!("{}: {error}", manifest.display());
    let text = fs::read_to_string(&manifest).map_err(|error| explain(&error))?;
    let table: toml::Table = toml::from_str(&text).map_err(|error| explain(&error))?;
    let features = table.get("features").and_then(toml::Value::as_table).into_iter().flatten();
    let is_of_scenes = |name: &str, enabled: &toml::Value| {
        enabled.as_array().is_some_and(|all| all.contains(&format!("frixel-session/{name}").into()))
    };
    let mut measure = |name: String, features: &[&str]| {
        let (flash, _) = sizes(&image(&G474, &name, &[&["--no-default-features"], features].concat())?)?;
        figures.put(format!("g474.flash_{name}"), flash);
        Ok::<_, String>(())
    };
    measure("none".to_owned(), &[])?;
    for (feature, _) in features.filter(|(name, enabled)| is_of_scenes(name, enabled)) {
        measure(format!("{}_only", feature.replace('-', "_")), &["--features", feature])?;
    }
    Ok(())
}

/// Builds an image. The next build of the same image takes its place.
fn image(Board(folder, image, target): &Board, name: &str, features: &[&str]) -> Result<PathBuf, String> {
    let mut command = cargo_in(folder);
    command
        .args(["build", "--release", "--locked", "--quiet", "--target", target, "--target-dir", IMAGES_TARGET_FOLDER])
        .args(features);
    run(&format!("image of {folder} for {target}, {name}"), &mut command)?;
    Ok(root().join(folder).join(IMAGES_TARGET_FOLDER).join(target).join("release").join(image))
}

/// Measures the depth of the stack. Without the figure, its limit fails.
fn measure_stack(figures: &mut Figures, name: String, functions: &Functions, exceptions: &[&str]) {
    match functions.depth(MAIN, exceptions) {
        Ok(bytes) => figures.put(name, bytes),
        Err(why) => eprintln!("{name}: the depth of the stack is not known: {why}"),
    }
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
