//! [`frixel_fuzz::scene_load`] for libFuzzer.
#![no_main]

use frixel_fuzz::scene_load;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let _ = scene_load(bytes);
});
