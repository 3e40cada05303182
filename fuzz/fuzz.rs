//! The target that the environment variable `TARGET` names, for libFuzzer.
#![no_main]
#![allow(clippy::expect_used, reason = "without a target there is nothing to run")]

use std::path::Path;
use std::sync::LazyLock;
use std::{env, panic, process};

use frixel_fuzz::{TARGETS, Target};
use libfuzzer_sys::fuzz_target;

static TARGET: LazyLock<Target> = LazyLock::new(|| {
    let target = env::var("TARGET").expect("the environment names a target");
    TARGETS.into_iter().find(|known| known.name == target).expect("a known target")
});

fuzz_target!(
    // The reader of recordings catches panics of the Parquet library, at which libFuzzer's own hook would end the
    // process. Files of this repository have relative paths. A panic that leaves the target ends the process, wherever
    // it comes from.
    init: panic::set_hook(Box::new(|panic| {
        if panic.location().is_none_or(|at| Path::new(at.file()).is_relative()) {
            eprintln!("{panic}");
            process::abort();
        }
    })),
    |bytes: &[u8]| (TARGET.run)(bytes)
);
