//! The board's image: the one that comes with the program, or building it, and the tools that are required.

use std::env;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::EmulatorError;

/// Name of the emulator.
pub(super) const EMULATOR: &str = "qemu-system-arm";
/// The compiler's name for the board's processor.
const TARGET: &str = "thumbv7em-none-eabihf";
const BOARD: &str = "board-mps2-an386";

/// Environment variable with the checkout to build from, if it is not the one around the working directory.
const CHECKOUT: &str = "FRIXEL_CHECKOUT";

/// Folder of the images that come with a program, beside it.
const IMAGES: &str = "images";

/// An image to run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image(PathBuf);

impl Image {
    /// The image `images/board-mps2-an386.elf` beside this program, if it has come with one (`cargo xtask dist`), or else
    /// as [`Self::build`], which is what happens where the environment has `FRIXEL_CHECKOUT`.
    pub fn find() -> Result<Self, EmulatorError> {
        let program = env::current_exe().unwrap_or_default();
        match Self::beside(&program).filter(|_| env::var_os(CHECKOUT).is_none()) {
            Some(image) => emulator().map(|()| image),
            None => Self::build(),
        }
    }

    /// The image that has come with a program.
    fn beside(program: &Path) -> Option<Self> {
        let path = program.parent()?.join(IMAGES).join(format!("{BOARD}.elf"));
        path.is_file().then_some(Self(path))
    }

    /// Builds the image of the emulated board if it is not up to date.
    ///
    /// It is built from the checkout that the environment's `FRIXEL_CHECKOUT` names, or else the one around the working
    /// directory, or else the one that this program was built in.
    pub fn build() -> Result<Self, EmulatorError> {
        available()?;
        let folder = sources()?;
        // The folder that all images share.
        let target = folder.join("../target");
        let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(["build", "--release", "--locked", "--quiet", "--target-dir"])
            .arg(&target)
            .current_dir(&folder)
            .stdin(Stdio::null())
            .output()
            .map_err(|error| no_compiler_or("starting cargo", error))?;
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

/// Returns an error that names what is missing to build and run the emulated board. It does not check for the sources.
pub fn available() -> Result<(), EmulatorError> {
    emulator()?;
    let output = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", TARGET])
        .stderr(Stdio::null())
        .output()
        .map_err(|error| no_compiler_or("starting rustc", error))?;
    let libraries = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
    if libraries.is_dir() { Ok(()) } else { Err(EmulatorError::NoTarget { target: TARGET }) }
}

/// Returns an error if the emulator is not installed.
fn emulator() -> Result<(), EmulatorError> {
    match Command::new(EMULATOR).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status() {
        Ok(_) => Ok(()),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(EmulatorError::NoEmulator),
        Err(error) => Err(EmulatorError::system("starting the emulator")(error)),
    }
}

fn no_compiler_or(action: &'static str, error: io::Error) -> EmulatorError {
    if error.kind() == ErrorKind::NotFound { EmulatorError::NoCompiler } else { EmulatorError::system(action)(error) }
}

/// A folder in the checkout of a build for development, whose tests run elsewhere. What is handed on names no folder of
/// the machine that built it.
const BUILT_IN: Option<&str> = if cfg!(debug_assertions) { Some(env!("CARGO_MANIFEST_DIR")) } else { None };

/// The folder of the board's sources.
fn sources() -> Result<PathBuf, EmulatorError> {
    let here = env::current_dir().unwrap_or_default();
    let checkouts: Vec<PathBuf> = if let Some(checkout) = env::var_os(CHECKOUT) {
        vec![checkout.into()]
    } else {
        let built_in = BUILT_IN.and_then(|folder| Path::new(folder).parent());
        here.ancestors().chain(built_in).map(Path::to_path_buf).collect()
    };
    let mut folders = checkouts.into_iter().map(|checkout| checkout.join("firmware").join(BOARD));
    folders.find(|folder| folder.join("Cargo.toml").is_file()).ok_or(EmulatorError::NoSources)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn an_image_that_has_come_with_a_program_is_found_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("frixel");
        assert_eq!(Image::beside(&program), None);
        let path = folder.path().join("images/board-mps2-an386.elf");
        fs::create_dir(folder.path().join("images")).unwrap();
        fs::write(&path, "ELF").unwrap();
        assert_eq!(Image::beside(&program), Some(Image(path)));
        assert_eq!(Image::beside(Path::new("/")), None);
    }
}
