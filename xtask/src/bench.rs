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
use std::process::Command;

use crate::command::{M0_PLUS, M3, M4F, M33, root};
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
/// Code for a Cortex-M0+, which a Cortex-M3 executes, too, with as many instructions.
const M0_PLUS_CORE: Core = Core { name: "m0plus", target: M0_PLUS, machine: "mps2-an385" };
/// The RP2350's instruction set. Cycles are not estimated: the estimate is a Cortex-M4's.
const M33_CORE: Core = Core { name: "m33", target: M33, machine: "mps2-an505" };

/// Name of the emulator's executable.
const EMULATOR: &str = "qemu-system-arm";

/// The counts that `frixel report` shows without being given others.
pub(crate) const COMMITTED: &str = "host/frixel/src/report/bench.json";

/// Measures everything and writes `target/bench/bench.json`, and with `FRIXEL_BLESS=1` [`COMMITTED`].
pub(crate) fn bench() -> Result<Figures, String> {
    let mut figures = Figures::default();
    for core in [&M4F_CORE, &M3_CORE] {
        Image::build(core, false)?.measure(&mut figures)?;
    }
    for core in [&M0_PLUS_CORE, &M33_CORE] {
        Image::build(core, false)?.count(&mut figures)?;
    }
    size::measure(&mut figures)?;
    let folder = root().join("target/bench");
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths = vec![folder.join("bench.json")];
    if std::env::var_os("FRIXEL_BLESS").is_some() {
        size::measure_features(&mut figures)?;
        paths.push(root().join(COMMITTED));
    }
    let json = figures.json(&source_date()?)?;
    for path in paths {
        fs::write(&path, &json).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    Ok(figures)
}

/// The day of the commit that is measured.
fn source_date() -> Result<String, String> {
    let output = Command::new("git").args(["log", "-1", "--format=%cs"]).current_dir(root()).output();
    let output = output.map_err(|error| format!("git, for the date of the source: {error}"))?;
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The figure that exceeds its limit in [`breach`].
pub(crate) const BROKEN: &str = "m4f.inverse_table";

/// Counts the instructions of an image that is deliberately slower.
pub(crate) fn breach() -> Result<Figures, String> {
    let mut figures = Figures::default();
    Image::build(&M4F_CORE, true)?.count(&mut figures)?;
    Ok(figures)
}
