//! Programs that the checks need besides cargo and a C linker.

use std::env;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// Each program, and Debian's package of it.
const PACKAGES: [(&str, &str); 7] = [
    ("qemu-system-arm", "qemu-system-arm"),
    ("node", "nodejs"),
    ("npm", "npm"),
    ("chromium", "chromium"),
    ("firefox", "firefox-esr"),
    ("c++", "g++"),
    ("python3", "python3-venv"),
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
        _ => {
            let mut command = Command::new(program);
            command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
        }
    }
}

/// Fails if one of these programs is not there. The error lists them, and how to install them.
pub(crate) fn require(programs: &[&str]) -> Result<(), String> {
    let missing = PACKAGES.iter().filter(|(program, _)| programs.contains(program) && !is_there(program));
    let cures: Vec<String> =
        missing.map(|(program, package)| format!("{program} (Debian: `apt-get install {package}`)")).collect();
    if cures.is_empty() { Ok(()) } else { Err(format!("this machine lacks {}", cures.join(", "))) }
}
