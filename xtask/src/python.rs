//! The checks of the Python module: its wheel, built and installed into a fresh virtual environment, with types, lints,
//! tests and examples. The tests of its widget run in the studio's Chromium.

use std::process::Command;

use crate::command::{absolute, entries, remove, root, run, target_folder};
use crate::{ci, studio, studio_tests};

/// The folder of the module.
const FOLDER: &str = "host/python";

/// Builds the wheel, installs it into a fresh virtual environment, and checks it there.
pub(crate) fn check() -> Result<(), String> {
    let target = absolute(&target_folder())?.join("python");
    let (environment, wheels) = (target.join("environment"), target.join("wheels"));
    remove(&environment)?;
    remove(&wheels)?;
    let in_environment = |program: &str| {
        let mut command = Command::new(environment.join("bin").join(program));
        command.current_dir(root().join(FOLDER)).env("CARGO_TARGET_DIR", &target);
        // Nothing of the caller's own Python is in it.
        command.env("VIRTUAL_ENV", &environment).env_remove("PYTHONPATH").env_remove("PYTHONHOME");
        command
    };
    run("virtual environment", Command::new("python3").args(["-m", "venv"]).arg(&environment))?;
    let install = ["install", "--quiet", "--disable-pip-version-check"];
    run("packages", in_environment("pip").args(install).args(["--requirement", "requirements.txt"]))?;
    run("format of Python", in_environment("ruff").args(["format", "--check", "."]))?;
    run("lints of Python", in_environment("ruff").args(["check", "."]))?;
    let page = studio::build()?;
    let build = ["build", "--quiet", "--locked", "--profile", "wheel", "--out"];
    run("wheel", in_environment("maturin").args(build).arg(&wheels))?;
    let wheels = entries(&wheels)?;
    run("installation", in_environment("pip").args(install).args(["--no-index", "--no-deps"]).args(wheels))?;
    run("types", in_environment("mypy").args(["--package", "frixel"]))?;
    run("types of tests", in_environment("mypy").args(["tests", "examples"]))?;
    let frixel = ci::command()?;
    studio_tests::install(&studio_tests::folder())?;
    let mut tests = in_environment("pytest");
    run("tests of the Python module", tests.arg("--quiet").env("FRIXEL", frixel).env("STUDIO_PAGE", page))
}
