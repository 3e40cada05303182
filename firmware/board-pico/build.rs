//! Puts the linker script where the linker looks for it: the memories of the chip, and what lies where in them.

use std::env;
use std::error::Error;
use std::fs;
use std::path::PathBuf;

const CHIPS: [(&str, &str); 2] = [("CARGO_FEATURE_RP2040", "rp2040.x"), ("CARGO_FEATURE_RP2350", "rp2350.x")];
const SECTIONS: &str = "sections.x";

fn main() -> Result<(), Box<dyn Error>> {
    let chosen: Vec<&str> =
        CHIPS.into_iter().filter(|(feature, _)| env::var_os(feature).is_some()).map(|(_, memories)| memories).collect();
    let [memories] = chosen[..] else { return Err("choose one of the features rp2040 and rp2350".into()) };
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("memory.x"), fs::read_to_string(memories)? + &fs::read_to_string(SECTIONS)?)?;
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=--nmagic");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    for script in CHIPS.map(|(_, memories)| memories).into_iter().chain([SECTIONS]) {
        println!("cargo:rerun-if-changed={script}");
    }
    Ok(())
}
