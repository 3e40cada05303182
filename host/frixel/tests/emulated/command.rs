//! `frixel play --port qemu` as a person uses it.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use tempfile::TempDir;

use crate::bench::turn;
use crate::processes::{bundled, frixel, said};
use crate::{emulator, pico};

/// Plays the brick with the longest host timeout that there is: on a busy machine pings are late.
fn play(folder: &Path) -> Command {
    fs::create_dir_all(folder.join("textures")).unwrap();
    fs::copy(bundled("textures/brick.png"), folder.join("textures/brick.png")).unwrap();
    let brick = fs::read_to_string(bundled("brick.toml")).unwrap();
    let scene = folder.join("brick.toml");
    fs::write(&scene, brick.replace("[drive]\n", "[drive]\nhost_timeout_ms = 1000\n")).unwrap();
    let mut command = frixel();
    command.arg("play").arg(scene).args(["--port", "qemu", "--ideal", "--json"]).current_dir(folder);
    command
}

/// Processes that take all the time of the machine that they get.
struct Busy(Vec<std::process::Child>);

impl Busy {
    fn start(count: usize) -> Self {
        let busy = || Command::new("sh").args(["-c", "while :; do :; done"]).spawn().unwrap();
        Self((0..count).map(|_| busy()).collect())
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        for process in &mut self.0 {
            let _ = process.kill();
            let _ = process.wait();
        }
    }
}

/// The emulated clock waits for the host, which hardly runs. How many frames have to be sent again depends on that.
#[test]
fn a_scene_plays_beside_eight_busy_processes() {
    if emulator::image().is_none() {
        return;
    }
    let _turn = turn();
    let folder = TempDir::new().unwrap();
    let mut command = play(folder.path());
    let scene = folder.path().join("brick.toml");
    let text = fs::read_to_string(&scene).unwrap();
    fs::write(&scene, text.replace("host_timeout_ms = 1000\n", "host_timeout_ms = 100\n")).unwrap();
    let busy = Busy::start(8);
    let output = command.args(["--seconds", "0.5"]).output().unwrap();
    drop(busy);
    assert!(output.status.success(), "{}", said(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["rig"], "qemu");
    assert_eq!(json["ticks"], 20_000);
    // Both need what the board reports of every tick.
    assert!(json["saturated_ticks"].is_null() && json["inversion_error_rms_n"].is_null());
    // The first strokes of the brick are within 9 mN on every rig; with the output at zero it would be 22.
    let error_n = json["friction_error_rms_n"].as_f64().unwrap();
    assert!((1e-6..15e-3).contains(&error_n), "{error_n} N rms");

    let felt = fs::read_to_string(folder.path().join("frixel-out/felt.csv")).unwrap();
    let rows: Vec<Vec<&str>> = felt.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 500);
    let largest = |column: usize| rows.iter().filter_map(|row| row[column].parse::<f64>().ok()).fold(0.0, f64::max);
    assert!((0.33..0.37).contains(&largest(6)), "felt {} N at most", largest(6));
    assert!((50.0..200.0).contains(&largest(7)), "{} V rms at most", largest(7));
    for name in ["felt.svg", "scene.png"] {
        assert!(fs::metadata(folder.path().join("frixel-out").join(name)).unwrap().len() > 10_000);
    }
}

/// Ctrl-C in a terminal goes to the emulator, too.
#[test]
fn an_interrupted_play_leaves_what_was_played() {
    if emulator::image().is_none() {
        return;
    }
    let _turn = turn();
    let folder = TempDir::new().unwrap();
    let mut command = play(folder.path());
    let mut process = command
        .args(["--seconds", "600"])
        .process_group(0)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let felt = folder.path().join("frixel-out/felt.csv");
    // The rows before the end.
    let rows = folder.path().join("frixel-out/.felt.csv.frixel-tmp");
    while fs::metadata(&rows).map_or(0, |file| file.len()) < 20_000 {
        assert!(process.try_wait().unwrap().is_none(), "it ended by itself");
        sleep(Duration::from_millis(5));
    }
    let group = rustix::process::Pid::from_raw(process.id() as i32).unwrap();
    rustix::process::kill_process_group(group, rustix::process::Signal::INT).unwrap();
    let output = process.wait_with_output().unwrap();
    assert!(output.status.success() && said(&output).contains("interrupted after "), "{}", said(&output));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = fs::read_to_string(felt).unwrap().lines().count() as u64 - 1;
    assert_eq!(json["ticks"].as_u64().unwrap() / 40, rows, "every whole row that was played is there");
}

/// What a machine has on its PATH, and nothing else.
struct Tools(TempDir);

impl Tools {
    fn new(tools: &[(&str, &str)]) -> Self {
        let folder = TempDir::new().unwrap();
        for (name, script) in tools {
            let path = folder.path().join(name);
            fs::write(&path, format!("#!/bin/sh\n{script}\n")).unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        }
        Self(folder)
    }

    /// One sentence that names the cure, and an exit of one, before anything is written.
    fn refused(&self, checkout: Option<&Path>, parts: &[&str]) {
        self.refused_by(play, checkout, parts);
    }

    fn refused_by(&self, play: fn(&Path) -> Command, checkout: Option<&Path>, parts: &[&str]) {
        let folder = TempDir::new().unwrap();
        let mut command = play(folder.path());
        command.env("PATH", self.0.path()).env_remove("CARGO");
        if let Some(checkout) = checkout {
            command.env("FRIXEL_CHECKOUT", checkout);
        }
        let output = command.output().unwrap();
        let said = said(&output);
        assert_eq!(output.status.code(), Some(1), "{said}");
        let sentence = said.lines().last().unwrap_or_default();
        assert!(sentence.starts_with("frixel: "), "{said}");
        for part in parts {
            assert!(sentence.contains(part), "{part:?} is not in: {said}");
        }
        assert!(!folder.path().join("frixel-out").exists(), "nothing was played");
    }
}

const EMULATOR: (&str, &str) = ("qemu-system-arm", "exit 0");

#[test]
fn a_missing_program_is_named_with_the_command_that_installs_it() {
    let command = ["`apt-get install qemu-system-arm`"];
    Tools::new(&[]).refused(None, &command);
    let command = ["`curl https://sh.rustup.rs -sSf | sh`"];
    Tools::new(&[EMULATOR]).refused(None, &command);
    // What rustc says of a target that it does not have.
    let rustc = ("rustc", "echo /nowhere/lib/rustlib/thumbv7em-none-eabihf/lib");
    Tools::new(&[EMULATOR, rustc]).refused(None, &["`rustup target add thumbv7em-none-eabihf`"]);
    let rustc = ("rustc", "echo /");
    Tools::new(&[EMULATOR, rustc]).refused(None, &["`curl https://sh.rustup.rs -sSf | sh`"]);
}

#[test]
fn outside_a_checkout_it_says_what_it_takes() {
    let elsewhere = TempDir::new().unwrap();
    let tools = Tools::new(&[EMULATOR, ("rustc", "echo /")]);
    let named = format!("`FRIXEL_CHECKOUT={}` is not a checkout of frixel", elsewhere.path().display());
    tools.refused(Some(elsewhere.path()), &[&named, "it has no folder firmware/board-mps2-an386", "or unset it"]);
    let nowhere = elsewhere.path().join("nowhere");
    let named = format!("`FRIXEL_CHECKOUT={}` is not a checkout of frixel", nowhere.display());
    tools.refused(Some(&nowhere), &[&named, "there is no such folder", "or unset it"]);
}

/// Node comes without npm, too.
#[test]
fn the_program_that_fetches_the_picos_emulator_is_named_if_it_is_missing() {
    let checkout = TempDir::new().unwrap();
    for folder in ["firmware/board-pico", "hil-sim/pico"] {
        fs::create_dir_all(checkout.path().join(folder)).unwrap();
    }
    fs::write(checkout.path().join("hil-sim/pico/package-lock.json"), "{}").unwrap();
    let tools = Tools::new(&[("node", "exit 0"), ("rustc", "echo /"), ("cargo", "exit 0")]);
    tools.refused_by(
        pico::play,
        Some(checkout.path()),
        &["fetched by npm, which is not installed", "`apt-get install npm`"],
    );
    let command = ["runs on node, which is not installed", "`apt-get install nodejs npm`"];
    Tools::new(&[]).refused_by(pico::play, Some(checkout.path()), &command);
}
