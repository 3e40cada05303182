//! [`frixel_fuzz::plan`] for libFuzzer.
#![no_main]

use frixel_fuzz::plan;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    plan(text);
});
