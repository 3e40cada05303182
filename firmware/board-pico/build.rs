//! Copies the linker script, which defines the chip's memory layout, to the linker's search path.

use std::env;
use std::error::Error;
use std::fs;
use std::path::PathBuf;

/// Each chip's Cargo feature, as Cargo passes it in the environment, its linker script and its target.
const CHIPS: [(&str, &str, &str); 2] = [
    ("CARGO_FEATURE_RP2040", "rp2040.x", "thumbv6m-none-eabi"),
    ("CARGO_FEATURE_RP2350", "rp2350.x", "thumbv8m.main-none-eabihf"),
];
const SECTIONS: &str = "sections.x";

fn main() -> Result<(), Box<dyn Error>> {
    let chosen: Vec<_> = CHIPS.into_iter().filter(|(feature, ..)| env::var_os(feature).is_some()).collect();
    let [(feature, memories, target)] = chosen[..] else {
        return Err("choose one of the features rp2040 and rp2350, with --no-default-features".into());
    };
    if env::var("TARGET")? != target {
        let feature = feature.trim_start_matches("CARGO_FEATURE_").to_lowercase();
        return Err(format!("feature {feature} needs --target {target}").into());
    }
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("memory.x"), fs::read_to_string(memories)? + &fs::read_to_string(SECTIONS)?)?;
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=--nmagic");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    if env::var_os("CARGO_FEATURE_LOG").is_some() {
        println!("cargo:rustc-link-arg-bins=-Tdefmt.x");
    }
    for script in CHIPS.map(|(_, memories, _)| memories).into_iter().chain([SECTIONS]) {
        println!("cargo:rerun-if-changed={script}");
    }
    Ok(())
}
