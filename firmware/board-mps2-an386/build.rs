//! Copies the linker script to the linker's search path, and sets the `cfg` of the target's board.

use std::env;
use std::error::Error;
use std::fs;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let out = PathBuf::from(env::var("OUT_DIR")?);
    println!("cargo:rustc-check-cfg=cfg(an505)");
    let is_an505 = env::var("TARGET")?.starts_with("thumbv8m.main");
    if is_an505 {
        println!("cargo:rustc-cfg=an505");
    }
    fs::copy(if is_an505 { "an505.x" } else { "an386.x" }, out.join("memory.x"))?;
    // cortex-m-rt requires this file. It is empty, because no interrupt handler is optional.
    fs::write(out.join("device.x"), "")?;
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rerun-if-changed=an386.x");
    println!("cargo:rerun-if-changed=an505.x");
    Ok(())
}
