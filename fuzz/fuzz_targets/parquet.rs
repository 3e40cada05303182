//! [`frixel_fuzz::parquet`] for libFuzzer.
#![no_main]

use std::panic;

use frixel_fuzz::parquet;
use libfuzzer_sys::fuzz_target;

fuzz_target!(
    // The reader catches panics of the decoders, where libFuzzer's own hook would end the process. A panic that leaves
    // the target still ends it.
    init: panic::set_hook(Box::new(|panic| eprintln!("{panic}"))),
    |bytes: &[u8]| {
        parquet(bytes);
    }
);
