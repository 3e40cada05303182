//! The benchmark image (`firmware/bench`) in the emulator.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use super::figures::{CYCLES, Figures, MEAN};
use super::follow::{self, Seen};
use super::{Core, EMULATOR};
use crate::command::{IMAGES_TARGET_FOLDER, cargo_in, root, run};

/// Each instruction takes 1,024 ns of virtual time, and nothing else takes any.
const COUNTING: [&str; 2] = ["-icount", "shift=10,sleep=off"];

/// The benchmark image for a core.
pub(super) struct Image<'a> {
    core: &'a Core,
    path: PathBuf,
}

/// One line of the image's output.
pub(super) struct Count {
    pub(super) name: String,
    pub(super) instructions: u64,
    /// Number of the input with the most instructions, from 1.
    pub(super) worst_input: u32,
    /// Mean over all inputs, rounded up.
    pub(super) mean: u64,
}

impl<'a> Image<'a> {
    /// Builds the image.
    pub(super) fn build(core: &'a Core) -> Result<Self, String> {
        let mut command = cargo_in("firmware/bench");
        command.args(["build", "--release", "--locked", "--quiet", "--bin", "bench", "--target", core.target]);
        command.args(["--target-dir", IMAGES_TARGET_FOLDER]);
        run(&format!("benchmark for {}", core.name), &mut command)?;
        let path = root().join("firmware/bench").join(IMAGES_TARGET_FOLDER).join(core.target).join("release/bench");
        Ok(Self { core, path })
    }

    /// Counts the instructions of every case.
    pub(super) fn count(&self, figures: &mut Figures) -> Result<Vec<Count>, String> {
        let text = self.run(&[])?;
        let counts: Vec<Count> = text.lines().map(parse).collect::<Result<_, _>>()?;
        for count in &counts {
            figures.insert(self.name(count), count.instructions);
            figures.insert(self.name(count) + MEAN, count.mean);
        }
        Ok(counts)
    }

    /// Runs the image with these command-line arguments, and returns its output.
    pub(super) fn run(&self, words: &[String]) -> Result<String, String> {
        let output =
            self.emulator(words).output().map_err(|error| format!("{EMULATOR} could not be started: {error}"))?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        if output.status.success() {
            Ok(text)
        } else {
            let said = String::from_utf8_lossy(&output.stderr);
            Err(format!("the benchmark of {} failed: {text}{said}", self.core.name))
        }
    }

    /// Counts instructions, then follows every case at its worst input to estimate its cycles.
    pub(super) fn measure(&self, figures: &mut Figures) -> Result<(), String> {
        let counts = self.count(figures)?;
        let inputs: Vec<u32> = counts.iter().map(|count| count.worst_input).collect();
        let followed = self.follow(&[], &inputs)?;
        for (count, seen) in counts.iter().zip(followed) {
            if seen.instructions != count.instructions {
                return Err(format!(
                    "{}: the timer counts {} instructions, the debugger {}",
                    self.name(count),
                    count.instructions,
                    seen.instructions
                ));
            }
            figures.insert(self.name(count) + CYCLES, seen.cycles);
        }
        Ok(())
    }

    /// Runs the image with these command-line arguments, and follows every case at its given input.
    pub(super) fn follow(&self, words: &[String], inputs: &[u32]) -> Result<Vec<Seen>, String> {
        follow::follow(self.emulator(words), &self.path, inputs)
    }

    fn name(&self, count: &Count) -> String {
        format!("{}.{}", self.core.name, count.name)
    }

    /// The command that runs the image in the emulator with these arguments.
    fn emulator(&self, words: &[String]) -> Command {
        let words = [&["bench".to_owned()], words].concat().join(",arg=");
        let mut command = Command::new(EMULATOR);
        command
            .args(["-M", self.core.machine, "-display", "none", "-monitor", "none", "-serial", "null"])
            .args(COUNTING)
            .args(["-semihosting-config", &format!("enable=on,target=native,arg={words}"), "-kernel"])
            .arg(&self.path)
            .stdin(Stdio::null());
        command
    }
}

fn parse(line: &str) -> Result<Count, String> {
    let mut words = line.split(' ');
    let count = (|| {
        let name = words.next()?.to_owned();
        let instructions = words.next()?.parse().ok()?;
        let worst_input = words.next()?.parse().ok()?;
        let mean = words.next()?.parse().ok()?;
        Some(Count { name, instructions, worst_input, mean })
    })();
    count.ok_or_else(|| format!("the benchmark wrote `{line}`: expected name, instructions, input and mean"))
}
