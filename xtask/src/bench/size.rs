//! Sizes of images, and the depth of their stacks.

use std::path::{Path, PathBuf};

use object::Endianness;
use object::elf::{FileHeader32, PT_LOAD};
use object::read::elf::{FileHeader, ProgramHeader};

use super::figures::Figures;
use super::stack::Functions;
use crate::command::{IMAGES_TARGET_FOLDER, M0_PLUS, M4F, M33, bytes, cargo_in, root, run, text};

/// A board: its folder, the name of its image, and what that is compiled for.
struct Board(&'static str, &'static str, &'static str);

const G474: Board = Board("firmware/board-nucleo-g474re", "board-nucleo-g474re", M4F);
/// The emulated board.
const AN386: Board = Board("firmware/board-mps2-an386", "board-mps2-an386", M4F);
/// The serial port's interrupts, of one priority, are counted as if one could interrupt the other.
const AN386_EXCEPTIONS: [&str; 3] = ["UART0_RX", "UART0_TX", "SysTick"];

/// The measured images of a board.
struct Images {
    /// Prefix of the names of their figures.
    name: &'static str,
    board: Board,
    /// Suffix of the names of their figures, and the features that they are built with.
    builds: [(&'static str, &'static [&'static str]); 2],
    /// The exception of the tick.
    tick: &'static str,
    /// The exceptions that can interrupt each other; none if the depth of the stack is not known.
    exceptions: &'static [&'static str],
}

/// The main programs of the Picos call the boot ROM, so the depth of their stacks is not known.
const IMAGES: [Images; 3] = [
    Images {
        name: "pico_2",
        board: Board("firmware/board-pico", "board-pico", M33),
        builds: [("full", &[]), ("grating_only", &["--no-default-features", "--features", "rp2350,grating"])],
        tick: "PIO0_IRQ_0",
        exceptions: &[],
    },
    Images {
        name: "pico",
        board: Board("firmware/board-pico", "board-pico", M0_PLUS),
        builds: [
            ("full", &["--no-default-features", "--features", "rp2040,everything"]),
            ("grating_only", &["--no-default-features", "--features", "rp2040,grating"]),
        ],
        tick: "PIO0_IRQ_0",
        exceptions: &[],
    },
    // The tick, and the fault of unreadable flash.
    Images {
        name: "g474",
        board: G474,
        builds: [("full", &[]), ("grating_only", &["--no-default-features", "--features", "grating"])],
        tick: "TIM3",
        exceptions: &["TIM3", "NonMaskableInt"],
    },
];
/// The NUCLEO's programs beside the firmware, which share its memory.
const G474_PROGRAMS: [&str; 2] = ["bring-up", "self-test"];
/// Where RAM begins on every Cortex-M.
const RAM: u64 = 0x2000_0000;
const PERIPHERALS: u64 = 0x4000_0000;

/// Measures the images of the real boards, and the stack of the emulated board. An image for the Pico takes as much RAM
/// as flash for its code, which runs there.
pub(super) fn measure(figures: &mut Figures) -> Result<(), String> {
    for Images { name, board, builds, tick, exceptions } in &IMAGES {
        for (build, features) in builds {
            let path = image(board, build, features)?;
            let (flash, ram) = sizes(&path)?;
            figures.insert(format!("{name}.flash_{build}"), flash);
            figures.insert(format!("{name}.ram_{build}"), ram);
            let functions = Functions::read(&path)?;
            // If a tick panicked, the voltage would remain on the electrode until the one-shot expires.
            figures.insert(format!("{name}.tick_code_{build}"), functions.code_that_never_ends(tick)?);
            if !exceptions.is_empty() {
                measure_stack(figures, format!("{name}.stack_{build}"), &functions, exceptions);
            }
            if (*name, *build) == ("g474", "full") {
                for program in G474_PROGRAMS {
                    let functions = Functions::read(&path.with_file_name(program))?.without_formatting();
                    let name = format!("{name}.stack_{}", program.replace('-', "_"));
                    measure_stack(figures, name, &functions, exceptions);
                }
            }
        }
    }
    let functions = Functions::read(&image(&AN386, "full", &[])?)?;
    measure_stack(figures, "an386.stack".to_owned(), &functions, &AN386_EXCEPTIONS);
    Ok(())
}

/// Measures the NUCLEO's image without the features that scenes and hosts ask for, and with each one alone: what the
/// report of a scene adds up.
pub(super) fn measure_features(figures: &mut Figures) -> Result<(), String> {
    let manifest = root().join(G474.0).join("Cargo.toml");
    let table: toml::Table =
        toml::from_str(&text(&manifest)?).map_err(|error| format!("{}: {error}", manifest.display()))?;
    let features = table.get("features").and_then(toml::Value::as_table).into_iter().flatten();
    let is_of_scenes = |name: &str, enabled: &toml::Value| {
        enabled.as_array().is_some_and(|all| all.contains(&format!("frixel-session/{name}").into()))
    };
    let mut measure = |name: String, features: &[&str]| {
        let (flash, _) = sizes(&image(&G474, &name, &[&["--no-default-features"], features].concat())?)?;
        figures.insert(format!("g474.flash_{name}"), flash);
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
    match functions.depth("main", exceptions) {
        Ok(bytes) => drop(figures.insert(name, bytes)),
        Err(why) => eprintln!("{name}: the depth of the stack is not known: {why}"),
    }
}

/// Bytes of flash and of RAM in an image, without its stacks.
fn sizes(path: &Path) -> Result<(u64, u64), String> {
    let explain = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = bytes(path)?;
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
