//! What tests of `frixel` as a process share.
#![allow(clippy::unwrap_used, clippy::panic, reason = "part of a test, which may fail")]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::Duration;

#[cfg(unix)]
use rustix::process::{Pid, Signal, kill_process};

const NAP: Duration = Duration::from_millis(5);
/// A minute of naps: whatever is waited for longer has hung.
const NAPS_MAX: u32 = 12_000;

/// All of a scene but its layers: a screen of 120 mm by 80 mm, 0.25 N of natural friction, 27.78
/// mN more.
pub(crate) const HEAD: &str = "\
version = 1

[screen]
width_mm = 120
height_mm = 80
[screen.coating]
thickness_um = 10
permittivity = 1

[finger]
radius_mm = 8
stiffness_pa_per_m = 1.8e7
friction_coefficient = 0.5
normal_load_n = 0.5
skin_gap_um = 0
";

pub(crate) fn frixel() -> Command {
    Command::new(env!("CARGO_BIN_EXE_frixel"))
}

/// Runs a command in a folder, without any input.
pub(crate) fn run(folder: &Path, arguments: &[&str]) -> Output {
    frixel().args(arguments).current_dir(folder).output().unwrap()
}

/// What a command that succeeds prints.
pub(crate) fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", said(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// What a command says on standard error.
pub(crate) fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub(crate) fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
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

/// A process that does not outlive the test.
pub(crate) struct Running(pub(crate) Child);

#[cfg(unix)]
impl Running {
    pub(crate) fn signal(&self, signal: Signal) {
        kill_process(Pid::from_raw(self.0.id() as i32).unwrap(), signal).unwrap();
    }

    /// Ends it as a person would, and returns whether all was well.
    pub(crate) fn interrupt(&mut self) -> bool {
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
pub(crate) struct VirtualBoard {
    pub(crate) process: Running,
    pub(crate) port: String,
    _turn: MutexGuard<'static, ()>,
}

impl VirtualBoard {
    pub(crate) fn start(folder: &Path, arguments: &[&str]) -> Self {
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
