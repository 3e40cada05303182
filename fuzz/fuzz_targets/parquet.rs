//! [`frixel_fuzz::parquet`] for libFuzzer.
#![no_main]

use frixel_fuzz::parquet;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    parquet(bytes);
});
