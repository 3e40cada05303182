//! Programs that the checks need besides cargo and a C linker.

use std::env;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// Each program, what of it is needed, and Debian's package of it.
const PACKAGES: [(&str, &str, &str); 7] = [
    ("qemu-system-arm", "qemu-system-arm", "qemu-system-arm"),
    ("node", "node 20 or newer", "nodejs"),
    ("npm", "npm", "npm"),
    ("chromium", "chromium", "chromium"),
    ("firefox", "firefox", "firefox-esr"),
    ("c++", "c++", "g++"),
    ("python3", "python3, 3.11 or newer, with venv", "python3-venv"),
];

/// The path of a browser: that in an environment variable, or Debian's.
fn browser(variable: &str, path: &str) -> PathBuf {
    env::var_os(variable).unwrap_or_else(|| path.into()).into()
}

/// The path of Firefox, whether it is there or not.
pub(crate) fn firefox() -> PathBuf {
    browser("FIREFOX", "/usr/bin/firefox-esr")
}

fn is_there(program: &str) -> bool {
    match program {
        "chromium" => browser("CHROMIUM", "/usr/bin/chromium").is_file(),
        "firefox" => firefox().is_file(),
        "node" => succeeds(program, &["-e", "process.exit(parseInt(process.versions.node) < 20 ? 1 : 0)"]),
        "python3" => succeeds(program, &["-c", "import ensurepip, venv, sys; sys.exit(sys.version_info < (3, 11))"]),
        _ => succeeds(program, &["--version"]),
    }
}

fn succeeds(program: &str, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Fails if one of these programs is not there. The error lists them, and how to install them.
pub(crate) fn require(programs: &[&str]) -> Result<(), String> {
    let missing = PACKAGES.iter().filter(|(program, ..)| programs.contains(program) && !is_there(program));
    let cures: Vec<String> =
        missing.map(|(_, needed, package)| format!("{needed} (Debian: `apt-get install {package}`)")).collect();
    if cures.is_empty() { Ok(()) } else { Err(format!("this machine lacks {}", cures.join(", "))) }
}
