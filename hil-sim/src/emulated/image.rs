//! The board's image, and what it takes to build and run it.

use std::env;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::EmulatorError;

/// Name of the emulator.
pub(super) const EMULATOR: &str = "qemu-system-arm";
/// The compiler's name of the board's processor.
const TARGET: &str = "thumbv7em-none-eabihf";
const BOARD: &str = "board-mps2-an386";

/// An image to run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image(PathBuf);

impl Image {
    /// Builds the image of the emulated board, as far as it is not built yet.
    pub fn build() -> Result<Self, EmulatorError> {
        available()?;
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware").join(BOARD);
        if !folder.join("Cargo.toml").is_file() {
            return Err(EmulatorError::NoSources { folder: folder.display().to_string() });
        }
        let target = folder.join("target");
        let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(["build", "--release", "--locked", "--quiet", "--target-dir"])
            .arg(&target)
            .current_dir(&folder)
            .stdin(Stdio::null())
            .output()
            .map_err(EmulatorError::system("starting cargo"))?;
        if !output.status.success() {
            return Err(EmulatorError::NotBuilt { output: String::from_utf8_lossy(&output.stderr).into_owned() });
        }
        Ok(Self(target.join(TARGET).join("release").join(BOARD)))
    }

    /// Where the image is.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

/// Says what is missing for the emulated board, if anything is.
pub fn available() -> Result<(), EmulatorError> {
    match Command::new(EMULATOR).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status() {
        Ok(_) => {}
        Err(error) if error.kind() == ErrorKind::NotFound => return Err(EmulatorError::NoEmulator),
        Err(error) => return Err(EmulatorError::system("starting the emulator")(error)),
    }
    let output = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", TARGET])
        .stderr(Stdio::null())
        .output()
        .map_err(EmulatorError::system("starting rustc"))?;
    let libraries = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
    if libraries.is_dir() { Ok(()) } else { Err(EmulatorError::NoTarget { target: TARGET }) }
}
