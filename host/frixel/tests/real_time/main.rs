//! `frixel` and a board that keeps the time of the wall clock, as processes on pseudo-terminals.
//!
//! Everything that virtual time can show is tested in virtual time. These tests show that processes, signals and
//! terminals of the machine work together. Run them one by one: each starts a virtual board.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod calibration;
mod ports;
#[path = "../processes/mod.rs"]
mod processes;
mod recordings;
mod self_test;
mod signals;
mod slow_reader;
mod tutorial;
mod virtual_board;
mod watch;

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::Duration;

use rustix::process::{Pid, Signal, kill_process};

use crate::processes::frixel;

const NAP: Duration = Duration::from_millis(5);
/// A minute of naps: whatever is waited for longer has hung.
const NAPS_MAX: u32 = 12_000;

fn until(what: &str, mut done: impl FnMut() -> bool) {
    for _ in 0..NAPS_MAX {
        if done() {
            return;
        }
        sleep(NAP);
    }
    panic!("hung: {what}");
}

/// The felt.csv of a play that goes on, of one that is over, or of a virtual board.
fn rows_so_far(folder: &Path) -> String {
    let of_a_play = fs::read_to_string(folder.join(".felt.csv.frixel-tmp"));
    of_a_play.or_else(|_| fs::read_to_string(folder.join("felt.csv"))).unwrap_or_default()
}

/// A process that does not outlive the test.
struct Running(Child);

impl Running {
    fn signal(&self, signal: Signal) {
        kill_process(Pid::from_raw(self.0.id() as i32).unwrap(), signal).unwrap();
    }

    /// Ends it as a person would, and returns whether all was well.
    fn interrupt(&mut self) -> bool {
        self.signal(Signal::INT);
        self.0.wait().unwrap().success()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// One virtual board at a time: on a busy machine a second one is late.
static TURN: Mutex<()> = Mutex::new(());

/// `frixel sim`, which writes into `board` of a folder.
struct VirtualBoard {
    process: Running,
    port: String,
    _turn: MutexGuard<'static, ()>,
}

impl VirtualBoard {
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let mut command = frixel();
        command.args(["sim", "--out", "board"]).args(arguments).current_dir(folder);
        let mut process = Running(command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap());
        let mut line = String::new();
        BufReader::new(process.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let port = line.trim().strip_prefix("port: ").unwrap().to_owned();
        Self { process, port, _turn: turn }
    }
}
