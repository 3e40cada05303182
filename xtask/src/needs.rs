//! What the checks need of the machine besides cargo and a C linker.
//!
//! Everything is checked before anything is compiled. Needs that `rustup` can add are added. The others are reported
//! with the stages that are skipped; in continuous integration, they are an error instead.

use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// Where Debian installs the browser; the environment's CHROMIUM names another.
const CHROMIUM: &str = "/usr/bin/chromium";
const FIREFOX: &str = "/usr/bin/firefox-esr";
/// The oldest node that runs the tests of the studio.
const NODE_MAJOR_MIN: u32 = 20;

/// Fails without the parts of Python that Debian packages apart, and where it is older than 3.11.
const PYTHON_PROBE: &str = "import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))";

/// One thing that a stage needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Need {
    /// A subcommand of cargo that is a component of the toolchain: its name, and the component's.
    Component(&'static str, &'static str),
    /// The libraries of a compiler target.
    Target(&'static str),
    /// The emulator of Cortex-M processors.
    Emulator,
    Node,
    Npm,
    Chromium,
    Firefox,
    /// A compiler for C++, which libFuzzer is written in.
    CppCompiler,
    /// Python with what makes virtual environments.
    Python,
}

impl Need {
    /// What it is, for a list.
    fn name(self) -> String {
        match self {
            Self::Component(_, component) => component.to_owned(),
            Self::Target(target) => format!("target {target}"),
            Self::Emulator => "qemu-system-arm".to_owned(),
            Self::Node => format!("node {NODE_MAJOR_MIN} or newer"),
            Self::Npm => "npm".to_owned(),
            Self::Chromium => "Chromium".to_owned(),
            Self::Firefox => "Firefox".to_owned(),
            Self::CppCompiler => "a C++ compiler (c++)".to_owned(),
            Self::Python => "python3, 3.11 or newer, with venv".to_owned(),
        }
    }

    /// How a person installs it.
    fn cure(self) -> String {
        match self {
            Self::Component(_, component) => format!("`rustup component add {component}`"),
            Self::Target(target) => format!("`rustup target add {target}` (rustup: https://rustup.rs)"),
            Self::Emulator => "Debian: `apt-get install qemu-system-arm`".to_owned(),
            Self::Node => "Debian: `apt-get install nodejs`".to_owned(),
            Self::Npm => "Debian: `apt-get install npm`".to_owned(),
            Self::Chromium => "Debian: `apt-get install chromium`, or set CHROMIUM to its path".to_owned(),
            Self::Firefox => "Debian: `apt-get install firefox-esr`, or set FIREFOX to its path".to_owned(),
            Self::CppCompiler => "Debian: `apt-get install g++`".to_owned(),
            Self::Python => "Debian: `apt-get install python3-venv`".to_owned(),
        }
    }

    /// The arguments with which `rustup` adds it, if it can.
    fn rustup_arguments(self) -> Option<[&'static str; 3]> {
        match self {
            Self::Component(_, component) => Some(["component", "add", component]),
            Self::Target(target) => Some(["target", "add", target]),
            _ => None,
        }
    }
}

/// The machine, as far as needs are looked up and added there.
pub(crate) struct Machine {
    /// The folders of programs, as in the variable PATH.
    path: OsString,
    cargo: OsString,
    chromium: PathBuf,
    /// What is missing is an error.
    is_ci: bool,
}

/// The program of Firefox, whether it is there or not.
pub(crate) fn firefox() -> PathBuf {
    env::var_os("FIREFOX").unwrap_or_else(|| FIREFOX.into()).into()
}

impl Machine {
    /// The machine that this program runs on.
    pub(crate) fn this() -> Self {
        Self {
            path: env::var_os("PATH").unwrap_or_default(),
            cargo: env::var_os("CARGO").unwrap_or_else(|| "cargo".into()),
            chromium: env::var_os("CHROMIUM").unwrap_or_else(|| CHROMIUM.into()).into(),
            is_ci: env::var_os("CI").is_some_and(|ci| !ci.is_empty() && ci != "false" && ci != "0"),
        }
    }

    fn output(&self, program: impl Into<OsString>, arguments: &[&str]) -> Option<Output> {
        let mut command = Command::new(program.into());
        command.args(arguments).env("PATH", &self.path).stdin(Stdio::null()).output().ok()
    }

    /// The standard output of a program, if it is there and succeeds.
    fn text(&self, program: impl Into<OsString>, arguments: &[&str]) -> Option<String> {
        let output = self.output(program, arguments).filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    }

    fn has(&self, need: Need) -> bool {
        let runs = |program: &str| self.text(program, &["--version"]).is_some();
        match need {
            Need::Component(subcommand, _) => self.text(&self.cargo, &[subcommand, "--version"]).is_some(),
            Need::Target(target) => self
                .text("rustc", &["--print", "target-libdir", "--target", target])
                .is_some_and(|libraries| Path::new(&libraries).is_dir()),
            Need::Emulator => runs("qemu-system-arm"),
            Need::Node => self.text("node", &["--version"]).is_some_and(|version| is_new_enough(&version)),
            Need::Npm => runs("npm"),
            Need::Chromium => self.chromium.is_file(),
            Need::Firefox => firefox().is_file(),
            Need::CppCompiler => runs("c++"),
            Need::Python => self.text("python3", &["-c", PYTHON_PROBE]).is_some(),
        }
    }

    /// Adds one need by `rustup`; the error says why it could not.
    fn add(&self, need: Need) -> Result<(), String> {
        let Some(arguments) = need.rustup_arguments() else { return Err(need.cure()) };
        let Some(output) = self.output("rustup", &arguments) else {
            return Err(format!("there is no rustup that could add it; {}", need.cure()));
        };
        if output.status.success() && self.has(need) {
            return Ok(());
        }
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        let reason = said.lines().find(|line| line.starts_with("error")).or(said.lines().last()).unwrap_or("no reason");
        Err(format!("rustup could not add it ({}); {}", reason.trim(), need.cure()))
    }
}

/// A version of node as it prints it, `v20.1.0`.
fn is_new_enough(version: &str) -> bool {
    let major = version.trim_start_matches('v').split('.').next().and_then(|major| major.parse::<u32>().ok());
    major.is_some_and(|major| major >= NODE_MAJOR_MIN)
}

/// What was found missing, and could not be added.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Missing(BTreeMap<Need, String>);

impl Missing {
    /// Looks for the needs of stages, which are given with their names, and has `rustup` add what it can. `say` gets
    /// the list of what is added, missing and skipped.
    pub(crate) fn look(
        machine: &Machine,
        stages: &[(&str, &[Need])],
        say: &mut dyn FnMut(&str),
    ) -> Result<Self, String> {
        let needs: BTreeSet<Need> = stages.iter().flat_map(|(_, needs)| *needs).copied().collect();
        let absent: Vec<Need> = needs.into_iter().filter(|need| !machine.has(*need)).collect();
        let (addable, others): (Vec<Need>, Vec<Need>) =
            absent.into_iter().partition(|need| need.rustup_arguments().is_some());
        let mut missing = Self(others.into_iter().map(|need| (need, need.cure())).collect());
        // Downloads begin only where the run is not going to end for want of something else.
        if !machine.is_ci || missing.0.is_empty() {
            for need in addable {
                match machine.add(need) {
                    Ok(()) => say(&format!("  added    {}", need.name())),
                    Err(reason) => drop(missing.0.insert(need, reason)),
                }
            }
        }
        if machine.is_ci && !missing.0.is_empty() {
            return Err(format!("this machine lacks what the checks need:\n{}", missing.lines().join("\n")));
        }
        for line in missing.lines() {
            say(&line);
        }
        for (stage, needs) in stages {
            if let Some(names) = missing.among(needs) {
                say(&format!("  SKIPPED  {stage}: without {names}"));
            }
        }
        Ok(missing)
    }

    /// The names of those needs that are missing, if any is.
    pub(crate) fn among(&self, needs: &[Need]) -> Option<String> {
        let names: Vec<String> =
            needs.iter().filter(|need| self.0.contains_key(need)).map(|need| need.name()).collect();
        (!names.is_empty()).then(|| names.join(", "))
    }

    fn lines(&self) -> Vec<String> {
        self.0.iter().map(|(need, reason)| format!("  missing  {}: {reason}", need.name())).collect()
    }
}

/// Adds what `rustup` can; fails if anything is missing in spite of that.
pub(crate) fn require(needs: &[Need]) -> Result<(), String> {
    let missing = Missing::look(&Machine::this(), &[("", needs)], &mut |_| {})?;
    if missing.0.is_empty() { Ok(()) } else { Err(format!("this machine lacks:\n{}", missing.lines().join("\n"))) }
}

#[cfg(all(test, unix))]
mod tests {
    #![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

    use std::fs;
    use std::os::unix::fs::PermissionsExt;

    use super::*;
    use crate::command::root;

    const TARGET: Need = Need::Target("thumbv7m-none-eabi");
    const CLIPPY: Need = Need::Component("clippy", "clippy");
    const STAGES: [(&str, &[Need]); 5] = [
        ("lints", &[CLIPPY]),
        ("images", &[TARGET, CLIPPY]),
        ("browser", &[Need::Node, Need::Npm, Need::Chromium]),
        ("emulators", &[TARGET, Need::Emulator]),
        ("python", &[Need::Python]),
    ];

    /// A folder of made-up programs, which is the whole PATH.
    struct Bare(PathBuf);

    impl Bare {
        fn new(name: &str, programs: &[(&str, &str)]) -> Self {
            let folder = root().join(format!("target/machine-of-test-{name}-{}", std::process::id()));
            fs::create_dir_all(&folder).unwrap();
            for (program, script) in programs {
                let path = folder.join(program);
                fs::write(&path, format!("#!/bin/sh\ncd '{}'\n{script}\n", folder.display())).unwrap();
                fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
            }
            Self(folder)
        }

        fn look(&self, is_ci: bool) -> (Result<Missing, String>, String) {
            let machine = Machine {
                path: self.0.clone().into(),
                cargo: self.0.join("cargo").into(),
                chromium: self.0.join("chromium"),
                is_ci,
            };
            let mut said = String::new();
            let missing = Missing::look(&machine, &STAGES, &mut |line| said.extend([line, "\n"]));
            (missing, said)
        }
    }

    impl Drop for Bare {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    /// A compiler whose targets lie in a folder beside it.
    const RUSTC: (&str, &str) = ("rustc", "echo \"$PWD/lib-$4\"");
    const CARGO_WITHOUT_COMPONENTS: (&str, &str) = ("cargo", "test -f \"component-$1\"");

    #[test]
    fn a_machine_with_nothing_skips_everything_and_says_what_is_missing() {
        let (missing, said) = Bare::new("nothing", &[]).look(false);
        let missing = missing.unwrap();
        for line in [
            "missing  clippy: there is no rustup that could add it; `rustup component add clippy`",
            "missing  target thumbv7m-none-eabi: there is no rustup that could add it; `rustup target add",
            "missing  qemu-system-arm: Debian: `apt-get install qemu-system-arm`",
            "missing  node 20 or newer",
            "missing  npm",
            "missing  Chromium",
            "missing  python3, 3.11 or newer, with venv: Debian: `apt-get install python3-venv`",
            "SKIPPED  python: without python3, 3.11 or newer, with venv",
            "SKIPPED  lints: without clippy",
            "SKIPPED  images: without target thumbv7m-none-eabi, clippy",
            "SKIPPED  browser: without node 20 or newer, npm, Chromium",
            "SKIPPED  emulators: without target thumbv7m-none-eabi, qemu-system-arm",
        ] {
            assert!(said.contains(line), "{line} is missing in\n{said}");
        }
        assert!(STAGES.iter().all(|(_, needs)| missing.among(needs).is_some()));
    }

    #[test]
    fn in_continuous_integration_what_is_missing_is_an_error_before_anything_is_downloaded() {
        let rustup = ("rustup", "touch asked");
        let bare = Bare::new("ci", &[RUSTC, CARGO_WITHOUT_COMPONENTS, rustup]);
        let (missing, _) = bare.look(true);
        let error = missing.unwrap_err();
        assert!(error.contains("qemu-system-arm") && error.contains("Chromium") && error.contains("npm"), "{error}");
        assert!(!bare.0.join("asked").exists(), "rustup was started");
    }

    #[test]
    fn a_target_and_a_component_are_added_and_their_stages_run() {
        let rustup = ("rustup", "case $1 in target) /bin/mkdir \"lib-$3\";; *) : >\"component-$3\";; esac");
        let programs = [RUSTC, CARGO_WITHOUT_COMPONENTS, rustup, ("qemu-system-arm", "exit 0")];
        let (missing, said) = Bare::new("rustup", &programs).look(false);
        let missing = missing.unwrap();
        assert!(said.contains("added    target thumbv7m-none-eabi") && said.contains("added    clippy"), "{said}");
        assert_eq!(missing.among(STAGES[1].1), None);
        assert_eq!(missing.among(STAGES[3].1), None);
        assert!(missing.among(STAGES[2].1).is_some());
    }

    #[test]
    fn rustup_without_network_is_said_with_its_reason() {
        let rustup = ("rustup", "echo info: downloading >&2; echo 'error: no such host' >&2; exit 1");
        let (missing, said) = Bare::new("offline", &[RUSTC, CARGO_WITHOUT_COMPONENTS, rustup]).look(false);
        assert!(said.contains("thumbv7m-none-eabi: rustup could not add it (error: no such host)"), "{said}");
        assert!(missing.unwrap().among(&[TARGET]).is_some());
    }

    #[test]
    fn a_rustup_that_succeeds_and_adds_nothing_is_not_believed() {
        let (missing, _) = Bare::new("liar", &[RUSTC, CARGO_WITHOUT_COMPONENTS, ("rustup", "exit 0")]).look(false);
        assert!(missing.unwrap().among(&[TARGET]).is_some());
    }

    #[test]
    fn an_old_node_is_missing() {
        let (missing, _) = Bare::new("old", &[("node", "echo v18.19.0"), ("npm", "echo 9")]).look(false);
        assert_eq!(missing.unwrap().among(&[Need::Node, Need::Npm]), Some("node 20 or newer".to_owned()));
        assert!(is_new_enough("v20.0.1") && is_new_enough("v24.1.0") && !is_new_enough("no version"));
    }
}
