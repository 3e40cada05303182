//! [`frixel_fuzz::parquet`] for libFuzzer.
#![no_main]

use std::path::Path;
use std::{panic, process};

use frixel_fuzz::parquet;
use libfuzzer_sys::fuzz_target;

fuzz_target!(
    // The reader catches panics of the Parquet library, at which libFuzzer's own hook would end the process. Files of
    // this repository have relative paths. A panic that leaves the target ends the process, wherever it comes from.
    init: panic::set_hook(Box::new(|panic| {
        if panic.location().is_none_or(|at| Path::new(at.file()).is_relative()) {
            eprintln!("{panic}");
            process::abort();
        }
    })),
    |bytes: &[u8]| {
        parquet(bytes);
    }
);
