//! The board's image, shipped with the program or built, and the required tools.

use std::env;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::EmulatorError;

/// Name of the emulator of the MPS2 boards.
pub(super) const EMULATOR: &str = "qemu-system-arm";
/// Name of the program that runs the emulator of [`EmulatedBoard::Pico`].
pub(super) const NODE: &str = "node";

/// Environment variable with the checkout to build from, in place of the one around the working directory.
const CHECKOUT: &str = "FRIXEL_CHECKOUT";

/// Folder of the images shipped with a program, beside it.
pub(super) const IMAGES: &str = "images";

/// A board that runs in an emulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmulatedBoard {
    /// A Cortex-M4F with its own firmware.
    Mps2An386,
    /// A Cortex-M33 with an FPU, as in the RP2350, with the same firmware, only for [`replay`](super::replay).
    Mps2An505,
    /// A Raspberry Pi Pico, with the unmodified image.
    Pico,
    /// A Raspberry Pi Pico with an image for an optical touch frame, and few kinds of layers.
    PicoWithFrame,
}

/// The tools that run and build a board's image.
struct Tools {
    /// Its emulator: the program, what needs it, and Debian's packages.
    emulator: (&'static str, &'static str, &'static str),
    /// The emulator's name for the board.
    machine: &'static str,
    /// The folder of the firmware, and the name of its image in there.
    name: &'static str,
    /// The compiler's name for the processor.
    target: &'static str,
    /// Options with which cargo builds the image.
    options: &'static [&'static str],
    /// The target folder relative to that of the firmware. It is shared by all images, except for the second image of a
    /// name.
    target_folder: &'static str,
}

const MPS2: Tools = Tools {
    emulator: (EMULATOR, "the emulator", EMULATOR),
    machine: "mps2-an386",
    name: "board-mps2-an386",
    target: "thumbv7em-none-eabihf",
    options: &[],
    target_folder: "../target",
};
const PICO: Tools = Tools {
    emulator: (NODE, "the Pico's emulator runs on node, which", "nodejs npm"),
    machine: "pico",
    name: "board-pico",
    target: "thumbv6m-none-eabi",
    options: &["--no-default-features", "--features", "rp2040,everything"],
    target_folder: "../target",
};

impl EmulatedBoard {
    fn tools(self) -> Tools {
        match self {
            Self::Mps2An386 => MPS2,
            Self::Mps2An505 => Tools { machine: "mps2-an505", target: "thumbv8m.main-none-eabihf", ..MPS2 },
            Self::Pico => PICO,
            Self::PicoWithFrame => Tools {
                machine: "pico-with-frame",
                options: &["--no-default-features", "--features", "rp2040,grating,optical-frame"],
                target_folder: "../target/optical-frame",
                ..PICO
            },
        }
    }

    /// The emulator's name for it.
    pub(super) fn machine(self) -> &'static str {
        self.tools().machine
    }

    /// Returns an error if its emulator is not installed.
    fn emulator(self) -> Result<(), EmulatorError> {
        let (program, what, packages) = self.tools().emulator;
        match Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status() {
            Ok(_) => Ok(()),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Err(EmulatorError::NotInstalled { what, command: format!("apt-get install {packages}") })
            }
            Err(error) => Err(EmulatorError::system("starting the emulator")(error)),
        }
    }

    /// Returns an error that names the missing tool for building and running this board. Does not check for the
    /// sources.
    fn available(self) -> Result<(), EmulatorError> {
        self.emulator()?;
        let target = self.tools().target;
        let output = Command::new("rustc")
            .args(["--print", "target-libdir", "--target", target])
            .stderr(Stdio::null())
            .output()
            .map_err(|error| no_compiler_or("starting rustc", error))?;
        let libraries = PathBuf::from(String::from_utf8_lossy(&output.stdout).trim());
        if libraries.is_dir() {
            return Ok(());
        }
        let what = "the compiler's target for the board";
        Err(EmulatorError::NotInstalled { what, command: format!("rustup target add {target}") })
    }
}

/// An image to run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    board: EmulatedBoard,
    path: PathBuf,
}

impl Image {
    /// Returns the image `images/BOARD.elf` beside this program, if it was shipped with one (`cargo xtask dist`).
    /// Otherwise, or if `FRIXEL_CHECKOUT` is set, builds it as [`Self::build`] does.
    pub fn find(board: EmulatedBoard) -> Result<Self, EmulatorError> {
        match beside_program(&format!("board-{}.elf", board.machine())) {
            Some(path) => board.emulator().map(|()| Self { board, path }),
            None => Self::build(board),
        }
    }

    /// Builds the image of an emulated board if it is not up to date.
    ///
    /// The sources are those of the checkout named by `FRIXEL_CHECKOUT`, else around the working directory, else where
    /// this program was built.
    pub fn build(board: EmulatedBoard) -> Result<Self, EmulatorError> {
        board.available()?;
        let Tools { name, target, options, target_folder, .. } = board.tools();
        let folder = source_folder(&format!("firmware/{name}"))?;
        let target_folder = folder.join(target_folder);
        let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(["build", "--release", "--locked", "--quiet", "--target", target, "--target-dir"])
            .arg(&target_folder)
            .args(options)
            .current_dir(&folder)
            .stdin(Stdio::null())
            .output()
            .map_err(|error| no_compiler_or("starting cargo", error))?;
        if !output.status.success() {
            return Err(EmulatorError::Failed {
                failure: "the emulated board's image does not compile".into(),
                output: String::from_utf8_lossy(&output.stderr).into_owned(),
            });
        }
        Ok(Self { board, path: target_folder.join(target).join("release").join(name) })
    }

    /// Where the image is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The board that it is for.
    pub(super) fn board(&self) -> EmulatedBoard {
        self.board
    }
}

/// A file shipped in this program's folder of images, unless the environment names a checkout.
pub(super) fn beside_program(name: &str) -> Option<PathBuf> {
    beside(&env::current_exe().unwrap_or_default(), name).filter(|_| env::var_os(CHECKOUT).is_none())
}

fn beside(program: &Path, name: &str) -> Option<PathBuf> {
    let path = program.parent()?.join(IMAGES).join(name);
    path.exists().then_some(path)
}

fn no_compiler_or(action: &'static str, error: io::Error) -> EmulatorError {
    if error.kind() != ErrorKind::NotFound {
        return EmulatorError::system(action)(error);
    }
    let what = "the emulated board's image is not in the folder `images` beside this program, and building it needs \
                Rust, which";
    EmulatorError::NotInstalled { what, command: "curl https://sh.rustup.rs -sSf | sh".into() }
}

/// A folder in the checkout of a development build, whose tests run elsewhere. A release contains no path of the
/// machine that built it.
const BUILT_IN: Option<&str> = if cfg!(debug_assertions) { Some(env!("CARGO_MANIFEST_DIR")) } else { None };

/// A folder of the sources.
pub(super) fn source_folder(name: &str) -> Result<PathBuf, EmulatorError> {
    if let Some(checkout) = env::var_os(CHECKOUT) {
        return folder_of(Path::new(&checkout), name);
    }
    let here = env::current_dir().unwrap_or_default();
    let built_in = BUILT_IN.and_then(|folder| Path::new(folder).parent());
    let mut folders = here.ancestors().chain(built_in).map(|checkout| checkout.join(name));
    folders.find(|folder| folder.is_dir()).ok_or(EmulatorError::NoSources)
}

/// A folder of the checkout that the environment names.
fn folder_of(checkout: &Path, name: &str) -> Result<PathBuf, EmulatorError> {
    let folder = checkout.join(name);
    if folder.is_dir() {
        return Ok(folder);
    }
    let missing = if checkout.is_dir() { format!("it has no folder {name}") } else { "there is no such folder".into() };
    Err(EmulatorError::NotACheckout { folder: checkout.display().to_string(), missing })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn an_image_that_has_come_with_a_program_is_found_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let (program, name) = (folder.path().join("frixel"), "board-mps2-an386.elf");
        assert_eq!(beside(&program, name), None);
        let path = folder.path().join("images").join(name);
        fs::create_dir(folder.path().join("images")).unwrap();
        fs::write(&path, "ELF").unwrap();
        assert_eq!(beside(&program, name), Some(path));
        assert_eq!(beside(Path::new("/"), name), None);
    }
}
