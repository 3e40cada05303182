//! [`frixel_fuzz::scenario`] for libFuzzer.
#![no_main]

use frixel_fuzz::scenario;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    scenario(text);
});
