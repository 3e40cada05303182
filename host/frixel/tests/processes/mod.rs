//! What tests of `frixel` as a process share.
#![allow(dead_code, reason = "not every test waits")]

use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

const NAP: Duration = Duration::from_millis(5);
/// A minute of naps: whatever is waited for longer has hung.
const NAPS_MAX: u32 = 12_000;

pub(crate) fn frixel() -> Command {
    Command::new(env!("CARGO_BIN_EXE_frixel"))
}

pub(crate) fn until(what: &str, mut done: impl FnMut() -> bool) {
    for _ in 0..NAPS_MAX {
        if done() {
            return;
        }
        sleep(NAP);
    }
    panic!("hung: {what}");
}
