//! What tests of `frixel` as a process share.
#![allow(clippy::panic, reason = "part of a test, which may fail")]

use std::fs;
use std::path::Path;
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

/// The felt.csv of a play that goes on, of one that is over, or of a virtual board.
pub(crate) fn rows_so_far(folder: &Path) -> String {
    let of_a_play = fs::read_to_string(folder.join(".felt.csv.frixel-tmp"));
    of_a_play.or_else(|_| fs::read_to_string(folder.join("felt.csv"))).unwrap_or_default()
}
