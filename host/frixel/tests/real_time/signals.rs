//! Signals end a process that is blocked.

use std::fs;
use std::process::{Child, Stdio};
use std::thread;
use std::time::Duration;

use rustix::fs::{CWD, FileType, Mode, mknodat};
use rustix::process::Signal;
use tempfile::TempDir;

use crate::processes::frixel;
use crate::{Running, until};

pub(crate) const SCENE: &str = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n";

fn ended(process: &mut Running) -> bool {
    process.0.try_wait().unwrap().is_some()
}

/// Whether a process has a handler for this signal, so that a signal does not just end it.
fn handles(process: &Child, signal: Signal) -> bool {
    let status = fs::read_to_string(format!("/proc/{}/status", process.id())).unwrap_or_default();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    caught
        .and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .is_some_and(|mask| mask & (1 << (signal.as_raw() - 1)) != 0)
}

/// A simulator that waits for a line that never comes, and a play whose output is a pipe that nobody reads.
#[test]
fn a_second_signal_ends_a_process_that_is_blocked_on_a_pipe() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    mknodat(CWD, out.join("felt.csv"), FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).unwrap();
    for command in ["play", "sim"] {
        for signal in [Signal::INT, Signal::TERM] {
            let mut process = frixel();
            process.arg(command).args(if command == "play" { &["scene.toml"][..] } else { &[] }).args(["--out", "out"]);
            process.current_dir(folder.path()).stdout(Stdio::null()).stderr(Stdio::null());
            let mut process = Running(process.spawn().unwrap());
            until("the handler is there", || handles(&process.0, signal) || ended(&mut process));
            process.signal(signal);
            thread::sleep(Duration::from_millis(50));
            if !ended(&mut process) {
                process.signal(signal);
            }
            until("the second signal ends it", || ended(&mut process));
        }
    }
}
