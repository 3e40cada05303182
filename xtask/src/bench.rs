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

use std::process::Command;

use crate::command::{M0_PLUS, M3, M4F, M33, root, text_of, write};
pub(crate) use figures::{Figures, table};
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
        Image::build(core)?.measure(&mut figures)?;
    }
    for core in [&M0_PLUS_CORE, &M33_CORE] {
        Image::build(core)?.count(&mut figures)?;
    }
    size::measure(&mut figures)?;
    let mut paths = vec![root().join("target/bench/bench.json")];
    if std::env::var_os("FRIXEL_BLESS").is_some() {
        size::measure_features(&mut figures)?;
        paths.push(root().join(COMMITTED));
    }
    let json = figures::json(&figures, &source_date()?)?;
    paths.iter().try_for_each(|path| write(path, &json))?;
    Ok(figures)
}

/// The day of the commit that is measured.
fn source_date() -> Result<String, String> {
    let date = text_of(Command::new("git").args(["log", "-1", "--format=%cs"]).current_dir(root()))?;
    Ok(date.trim().to_owned())
}
