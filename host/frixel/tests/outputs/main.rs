//! Nothing of the user's is ever lost: what commands write, over every output of every command.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod folders;
mod full_disk;
mod inputs;
mod kills;
mod recordings;
mod source;
mod streams;
mod table;

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;

use table::OUTPUTS;
use tempfile::TempDir;

use crate::processes::repository;

const SCENE: &str = "version = 2\n[[layer]]\nkind = \"grating\"\nwavelength_mm = 4\nlow_fraction = 0\n\
                     high_fraction = 0.9\n";

/// A folder with an input of every kind.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(TempDir::new().unwrap());
        let points = "variant,radius_m,coating_m,permittivity,friction_coefficient,stiffness_pa_per_m";
        let screen = "width_mm = 120\nheight_mm = 80\n[[coating]]\nthickness_um = 1\npermittivity = 3.9\n";
        folder.write("scene.toml", SCENE);
        folder.write("old.toml", OLD);
        folder.write("stroke.csv", "t_s,x_mm,y_mm,note\n0,10,20,a\n0.4,40,20,b\n");
        folder.write("screen.toml", screen);
        folder.write("points.csv", &format!("{points},voltage_v\nwf-upper,0.008,1e-5,1,0.5,1.8e7,100\n"));
        folder.write("frictions.csv", &format!("{points},electric_friction_n\nwf-upper,0.008,1e-5,1,0.5,1.8e7,0.01\n"));
        folder.write("forces.csv", "time_s,normal_force_n,friction_n\n0,0.5,0.2\n1,0.5,0.2\n");
        folder.write("bench.json", "{}");
        folder.write("plan.toml", "scenes = [\"scene.toml\"]\npeople = 1\nstrokes = 1\nseeds = 1\nseconds = 0.5\n");
        folder.write("data.csv", friction());
        fs::copy(repository().join("scenes/textures/brick.png"), folder.path("picture.png")).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        if let Some(folder) = self.path(name).parent() {
            fs::create_dir_all(folder).unwrap();
        }
        fs::write(self.path(name), text).unwrap();
    }

    fn read(&self, name: &str) -> Option<Vec<u8>> {
        fs::read(self.path(name)).ok()
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// Names of all files, hidden ones included.
    fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        let mut folders = vec![self.0.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    names.push(path.strip_prefix(self.0.path()).unwrap().display().to_string());
                }
            }
        }
        names.sort();
        names
    }

    /// A command in this folder, with a pipe as standard input.
    fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_frixel"));
        command.args(line.split_whitespace()).current_dir(self.0.path());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn run(&self, line: &str) -> Ran {
        answered(&mut self.command(line))
    }
}

/// How a command ended, and what it said.
struct Ran {
    code: Option<i32>,
    said: String,
    notes: String,
}

/// Runs a command to its end, with nothing on standard input.
fn answered(command: &mut Command) -> Ran {
    ran(&command.output().unwrap())
}

fn ran(output: &Output) -> Ran {
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    Ran { code: output.status.code(), said, notes: String::from_utf8_lossy(&output.stderr).into_owned() }
}

/// A scene of version 1.
const OLD: &str = "version = 1\n[screen]\nwidth_mm = 120\nheight_mm = 80\n[coating]\nthickness_um = 10\n\
                   permittivity = 1\n[finger]\nradius_mm = 8\nstiffness_pa_per_m = 1.8e7\nfriction_coefficient = 0.5\n\
                   normal_load_n = 0.5\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n";

/// A recording of friction that can be fitted.
fn friction() -> &'static str {
    static RECORDING: OnceLock<String> = OnceLock::new();
    RECORDING.get_or_init(|| {
        let folder = TempDir::new().unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_frixel"));
        command.args(["calibrate", "--strokes", "9", "-o", "data.csv"]).current_dir(folder.path());
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(folder.path().join("data.csv")).unwrap()
    })
}

/// Every output whose command line ends by itself and writes the same each time.
fn reproducible() -> impl Iterator<Item = &'static table::Output> {
    OUTPUTS.iter().filter(|output| output.is_reproducible && output.argument != "calibrate output")
}

/// The command line of an output to `out`, from `input`.
fn line(output: &table::Output, input: &str, out: &str) -> String {
    output.run.replace("IN", input).replace("OUT", out)
}

#[test]
fn every_command_line_of_the_table_writes_what_it_says() {
    for output in reproducible() {
        let folder = Folder::new();
        let ran = folder.run(&line(output, output.input, "out"));
        assert_eq!(ran.code, Some(0), "{}: {}", output.argument, ran.notes);
        let mut expected = Folder::new().names();
        expected.extend(output.written.iter().map(|name| name.replace("OUT", "out")));
        if output.argument == "demo out" {
            expected.extend(["out/brick.toml".to_owned(), "out/textures/brick.png".to_owned()]);
        }
        expected.sort();
        let mut left = folder.names();
        // The cells of a sweep are called by what they play.
        left.retain(|name| !name.starts_with("out/cells/"));
        assert_eq!(left, expected, "{}: nothing else is left", output.argument);
    }
}
