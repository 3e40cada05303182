//! `cargo xtask fuzz`: the targets of `fuzz` under libFuzzer, on the stable toolchain.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::time::Duration;

use crate::ci;
use crate::command::{absolute, bytes, remove, root, run, target_folder};

/// The targets, each with its number of inputs in [`Extent::Fixed`].
const TARGETS: [(&str, u32); 6] = [
    ("scene_text", 30_000),
    ("scene_bytes", 2_000_000),
    ("scene_load", 30_000),
    ("parquet", 100_000),
    ("scenario", 100_000),
    ("plan", 150_000),
];
/// Longest time of one input: beyond it, the target hangs.
const INPUT_MAX: Duration = Duration::from_secs(30);
/// The compiler of the workspace's crates, whose coverage guides libFuzzer. What they depend on is shared with
/// `cargo test`.
const COMPILER: &str = "fuzz/rustc-with-coverage";

/// How far a target is run.
#[derive(Clone, Copy)]
pub(crate) enum Extent {
    /// As many inputs as [`TARGETS`] says, drawn from one seed and from what a target starts with. They are nearly the
    /// same at every run, on fast and slow machines; only targets with hash maps differ a little.
    Fixed,
    /// Other inputs at every run, for this time. Those that reach new code are where the next such run begins.
    For(Duration),
}

/// Runs every target, all at once.
pub(crate) fn run_all(extent: Extent) -> Result<(), String> {
    run("seeds", ci::beside_default("build").args(["--bin", "seeds"]))?;
    let mut build = ci::beside_default("build");
    build.args(["--features", "frixel-fuzz/libfuzzer", "--bin", "fuzz"]);
    run("fuzz targets", build.env("RUSTC_WORKSPACE_WRAPPER", absolute(&root().join(COMPILER))?))?;
    let (programs, folder) = (target_folder().join("debug"), target_folder().join("fuzz"));
    let start = |(name, inputs)| Fuzzer::start(name, inputs, &programs, &folder, extent);
    let running: Vec<Fuzzer> = TARGETS.into_iter().map(start).collect::<Result<_, _>>()?;
    let failures: Vec<String> = running.into_iter().filter_map(|fuzzer| fuzzer.end().err()).collect();
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
}

/// A target that runs.
struct Fuzzer {
    name: &'static str,
    process: Child,
    /// What it writes.
    log: PathBuf,
}

impl Fuzzer {
    fn start(name: &'static str, inputs: u32, programs: &Path, folder: &Path, extent: Extent) -> Result<Self, String> {
        let explain = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
        let corpus = match extent {
            Extent::Fixed => folder.join("fixed").join(name),
            Extent::For(_) => folder.join("corpus").join(name),
        };
        if matches!(extent, Extent::Fixed) {
            remove(&corpus)?;
        }
        let found = folder.join("found");
        for folder in [&corpus, &found] {
            fs::create_dir_all(folder).map_err(|error| explain(folder, error))?;
        }
        let mut command = Command::new(programs.join("fuzz"));
        command.env("TARGET", name).arg(&corpus);
        match name {
            "scene_text" => drop(command.arg(root().join("scenes"))),
            "scenario" => drop(command.arg(root().join("hil-sim/scenarios"))),
            _ => {
                let seeds = programs.join("seeds");
                run(&format!("seeds of {name}"), Command::new(seeds).arg(name).arg(&corpus))?;
            }
        }
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
        Ok(Self { name, process, log })
    }

    /// Waits until it ends, and prints how many inputs it has tried.
    fn end(mut self) -> Result<(), String> {
        let status = self.process.wait().map_err(|error| format!("{}: {error}", self.name))?;
        let said = bytes(&self.log)?;
        let said = String::from_utf8_lossy(&said);
        let last =
            said.lines().rev().find(|line| line.starts_with("Done ")).unwrap_or("no line says how much was done");
        eprintln!("-- {}: {last}", self.name);
        if status.success() {
            return Ok(());
        }
        let lines: Vec<&str> = said.lines().collect();
        let end = lines[lines.len().saturating_sub(30)..].join("\n");
        Err(format!("the fuzz target {} failed ({status}); {} says:\n{end}", self.name, self.log.display()))
    }
}
