//! Sets the `cfg` of the processor's architecture, like the build script of `cortex-m`.

use std::env;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-check-cfg=cfg(armv6m, armv8m)");
    let target = env::var("TARGET").unwrap_or_default();
    for (start, architecture) in [("thumbv6m", "armv6m"), ("thumbv8m", "armv8m")] {
        if target.starts_with(start) {
            println!("cargo:rustc-cfg={architecture}");
        }
    }
}
