//! `cargo xtask fuzz`: the targets of `fuzz` under libFuzzer, on the stable toolchain.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::time::Duration;

use crate::ci;
use crate::command::{absolute, bytes, remove, root, run, target_folder, text_of};

/// Longest time of one input: beyond it, the target hangs.
const INPUT_MAX: Duration = Duration::from_secs(30);
/// The compiler of the workspace's crates, whose coverage guides libFuzzer. What they depend on is shared with
/// `cargo test`.
const COMPILER: &str = "fuzz/rustc-with-coverage";

/// How far a target is run.
#[derive(Clone, Copy)]
pub(crate) enum Extent {
    /// Each target's number of inputs, from one seed of the generator. Runs hardly differ, on fast and slow machines;
    /// only targets with hash maps do.
    Fixed,
    /// Other inputs at every run, for this time. Inputs that reach new code are kept for the next such run.
    For(Duration),
}

/// Runs every target, all at once.
pub(crate) fn run_all(extent: Extent) -> Result<(), String> {
    run("seeds", ci::beside_default("build").args(["--bin", "seeds"]))?;
    let mut build = ci::beside_default("build");
    build.args(["--features", "frixel-fuzz/libfuzzer", "--bin", "fuzz"]);
    run("fuzz targets", build.env("RUSTC_WORKSPACE_WRAPPER", absolute(&root().join(COMPILER))?))?;
    let (programs, folder) = (target_folder().join("debug"), target_folder().join("fuzz"));
    let corpora = match extent {
        Extent::Fixed => folder.join("fixed"),
        Extent::For(_) => folder.join("corpus"),
    };
    if matches!(extent, Extent::Fixed) {
        remove(&corpora)?;
    }
    let targets = text_of(Command::new(programs.join("seeds")).arg(&corpora))?;
    let targets = targets.lines().filter_map(|line| line.split_once(' '));
    let start = |(name, inputs)| Fuzzer::start(name, inputs, &programs.join("fuzz"), &folder, &corpora, extent);
    let running: Vec<Fuzzer> = targets.map(start).collect::<Result<_, _>>()?;
    let failures: Vec<String> = running.into_iter().filter_map(|fuzzer| fuzzer.end().err()).collect();
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
}

/// A running target.
struct Fuzzer {
    name: String,
    process: Child,
    /// The file of its output.
    log: PathBuf,
}

impl Fuzzer {
    fn start(
        name: &str,
        inputs: &str,
        program: &Path,
        folder: &Path,
        corpora: &Path,
        extent: Extent,
    ) -> Result<Self, String> {
        let explain = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
        let found = folder.join("found");
        fs::create_dir_all(&found).map_err(|error| explain(&found, error))?;
        let mut command = Command::new(program);
        command.env("TARGET", name).arg(corpora.join(name));
        command.arg(format!("-artifact_prefix={}/{name}-", found.display()));
        command.arg(format!("-timeout={}", INPUT_MAX.as_secs()));
        match extent {
            // Read again while it runs, the corpus would depend on the time.
            Extent::Fixed => command.arg(format!("-runs={inputs}")).args(["-seed=1", "-reload=0"]),
            Extent::For(time) => command.arg(format!("-max_total_time={}", time.as_secs())),
        };
        let log = folder.join(format!("{name}.log"));
        let file = File::create(&log).map_err(|error| explain(&log, error))?;
        let process = command.stderr(file).spawn().map_err(|error| format!("{command:?}: {error}"))?;
        Ok(Self { name: name.to_owned(), process, log })
    }

    /// Waits until it ends, and prints how many inputs it has tried.
    fn end(mut self) -> Result<(), String> {
        let status = self.process.wait().map_err(|error| format!("{}: {error}", self.name))?;
        let said = bytes(&self.log)?;
        let said = String::from_utf8_lossy(&said);
        let last =
            said.lines().rev().find(|line| line.starts_with("Done ")).unwrap_or("no line reports the number of runs");
        eprintln!("-- {}: {last}", self.name);
        if status.success() {
            return Ok(());
        }
        let lines: Vec<&str> = said.lines().collect();
        let end = lines[lines.len().saturating_sub(30)..].join("\n");
        Err(format!("the fuzz target {} failed ({status}); {} says:\n{end}", self.name, self.log.display()))
    }
}
