//! No file of the user's is ever lost: tests of every output of every command. The rules themselves are tested in
//! `host/files`.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod results;
mod source;
mod table;

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

use crate::processes::{bundled, frixel};

const SCENE: &str = "version = 1\n[[layer]]\nkind = \"grating\"\nwavelength_mm = 4\nlow_fraction = 0\n\
                     high_fraction = 0.9\n";

/// A folder with an input of every kind.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(TempDir::new().unwrap());
        let points = "variant,radius_m,coating_m,permittivity,friction_coefficient,stiffness_pa_per_m";
        folder.write("scene.toml", SCENE);
        folder.write("stroke.csv", "t_s,x_mm,y_mm,note\n0,10,20,a\n0.4,40,20,b\n");
        folder.write("points.csv", &format!("{points},voltage_v\nwf-upper,0.008,1e-5,1,0.5,1.8e7,100\n"));
        folder.write("frictions.csv", &format!("{points},electric_friction_n\nwf-upper,0.008,1e-5,1,0.5,1.8e7,0.01\n"));
        folder.write("plan.toml", "scenes = [\"scene.toml\"]\npeople = 1\nstrokes = 1\nseeds = 1\nseconds = 0.5\n");
        let row = |volts: f64| format!("{volts},0.5,{},0.001\n", 0.25 + 5e-6 * volts * volts);
        let header = "voltage_v_rms,normal_force_n,friction_n,friction_se_n\n";
        folder.write("data.csv", &(header.to_owned() + &[0.0, 50.0, 100.0, 150.0].map(row).concat()));
        fs::copy(bundled("textures/brick.png"), folder.path("picture.png")).unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        fs::write(self.path(name), text).unwrap();
    }

    fn text(&self, name: &str) -> String {
        String::from_utf8_lossy(&fs::read(self.path(name)).unwrap()).into_owned()
    }

    /// Names of all files, hidden ones included.
    fn names(&self) -> Vec<String> {
        let (mut names, mut folders) = (Vec::new(), vec![self.0.path().to_owned()]);
        while let Some(folder) = folders.pop() {
            for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
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

    /// A command in this folder.
    fn command(&self, line: &str) -> Command {
        let mut command = frixel();
        command.args(line.split_whitespace()).current_dir(self.0.path());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn run(&self, line: &str) -> Ran {
        Ran::of(&self.command(line).output().unwrap())
    }
}

/// How a command ended, and what it said.
struct Ran {
    code: Option<i32>,
    said: String,
    notes: String,
}

impl Ran {
    fn of(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Self { code: output.status.code(), said: text(&output.stdout), notes: text(&output.stderr) }
    }

    /// Whether the command failed with these words.
    fn refused(&self, words: &str) -> bool {
        self.code == Some(1) && self.notes.contains(words)
    }
}
