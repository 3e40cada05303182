//! [`frixel_fuzz::scene_bytes`] for libFuzzer.
#![no_main]

use frixel_fuzz::scene_bytes;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    scene_bytes(bytes);
});
