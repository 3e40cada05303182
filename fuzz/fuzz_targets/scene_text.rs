//! [`frixel_fuzz::scene_text`] for libFuzzer.
#![no_main]

use frixel_fuzz::scene_text;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    scene_text(text);
});
