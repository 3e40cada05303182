//! `cargo xtask bench`: instructions and estimated cycles on emulated processors, and image sizes.

pub(crate) mod costs;
mod cycles;
mod figures;
mod follow;
mod gdb;
mod image;
pub(crate) mod programs;
mod size;
mod stack;
mod thumb;

use std::fs;

use crate::command::{M3, M4F, root};
pub(crate) use figures::Figures;
use image::Image;

/// A processor on which instructions are counted.
struct Core {
    /// Prefix of the names of its figures.
    name: &'static str,
    target: &'static str,
    machine: &'static str,
}

const M4F_CORE: Core = Core { name: "m4f", target: M4F, machine: "mps2-an386" };
const M3_CORE: Core = Core { name: "m3", target: M3, machine: "mps2-an385" };

/// Name of the emulator's executable.
const EMULATOR: &str = "qemu-system-arm";

/// Measures everything and writes `target/bench/bench.json`.
pub(crate) fn bench() -> Result<Figures, String> {
    let mut figures = Figures::default();
    for core in [&M4F_CORE, &M3_CORE] {
        Image::build(core, false)?.measure(&mut figures)?;
    }
    size::measure(&mut figures)?;
    let folder = root().join("target/bench");
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let path = folder.join("bench.json");
    fs::write(&path, figures.json()?).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(figures)
}

/// The figure that exceeds its limit in [`breach`].
pub(crate) const BROKEN: &str = "m4f.inverse_table";

/// Counts the instructions of an image that is deliberately slower.
pub(crate) fn breach() -> Result<Figures, String> {
    let mut figures = Figures::default();
    Image::build(&M4F_CORE, true)?.count(&mut figures)?;
    Ok(figures)
}
