//! Errors of the emulated board.

use std::io;

use frixel_wire::fault::Fault;
use thiserror::Error;

/// Why an emulated board is unavailable, or has stopped.
#[derive(Debug, Error)]
pub enum EmulatorError {
    /// The emulator is not installed.
    #[error("the emulator is not installed: `apt-get install qemu-system-arm`")]
    NoEmulator,
    /// Node, which runs the emulator of the Pico, is not installed.
    #[error("the Pico's emulator runs on node, which is not installed: `apt-get install nodejs npm`")]
    NoNode,
    /// npm, which fetches the emulator of the Pico, is not installed.
    #[error("the Pico's emulator rp2040js is fetched by npm, which is not installed: `apt-get install npm`")]
    NoNpm,
    /// The packages that run the Pico's image could not be installed.
    #[error("the emulator rp2040js could not be installed by `npm ci` in {folder}:\n{output}")]
    NoPackages {
        /// The folder of the programs that use it.
        folder: String,
        /// The output of npm.
        output: String,
    },
    /// The compiler cannot compile for the board.
    #[error("the compiler's target for the board is not installed: `rustup target add {target}`")]
    NoTarget {
        /// The target's name.
        target: &'static str,
    },
    /// Rust is not installed.
    #[error(
        "the emulated board's image is not in the folder `images` beside this program, and building it needs Rust, \
         which is not installed: `curl https://sh.rustup.rs -sSf | sh`"
    )]
    NoCompiler,
    /// The board's sources are missing.
    #[error(
        "the emulated board's image is not in the folder `images` beside this program, and frixel's sources to build it \
         are not here: run this in a checkout of frixel, or set FRIXEL_CHECKOUT to the folder of one"
    )]
    NoSources,
    /// `FRIXEL_CHECKOUT` is not a checkout.
    #[error(
        "`FRIXEL_CHECKOUT={folder}` is not a checkout of frixel, because {missing}: set it to the folder of one, \
         or unset it"
    )]
    NotACheckout {
        /// The folder, as in the environment.
        folder: String,
        /// The missing part of a checkout.
        missing: String,
    },
    /// The image does not compile.
    #[error("the emulated board's image does not compile:\n{output}")]
    NotBuilt {
        /// The compiler's output.
        output: String,
    },
    /// An operation of the operating system failed.
    #[error("emulated board: {action}: {reason}")]
    System {
        /// The action that failed.
        action: &'static str,
        /// The operating system's error.
        reason: io::Error,
    },
    /// The emulated board cannot be given its limits.
    #[error(
        "the emulated board cannot have the limits of `Board::PICO`, which are in its flash before it starts: {reason}"
    )]
    LimitsNotStored {
        /// The reason, and what to do.
        reason: String,
    },
    /// The emulator has ended.
    #[error("the emulator has ended:\n{output}")]
    Ended {
        /// The emulator's output.
        output: String,
    },
    /// The emulator has not reported its serial port.
    #[error("the emulator has not reported its serial port:\n{output}")]
    NoSerialPort {
        /// The emulator's output.
        output: String,
    },
    /// The board missed a deadline.
    #[error("the emulated board has not completed {what} for {seconds} s: is the image stuck, or the machine busy?")]
    Silent {
        /// The missing result.
        what: &'static str,
        /// Wall time since the request.
        seconds: u64,
    },
    /// The firmware restarted unexpectedly after a fault.
    #[error("the firmware of the emulated board has restarted: {fault} (detail {detail:#x})")]
    Restarted {
        /// The fault.
        fault: Fault,
        /// The fault's detail: the program counter for a hard fault, the address below the stack for a stack overflow,
        /// the line for a panic.
        detail: u32,
    },
    /// The simulator was too slow to follow the board's output.
    #[error(
        "the simulated world is behind the emulated board by more than its memory holds: is the machine overloaded?"
    )]
    WorldBehind,
}

impl EmulatorError {
    /// Wraps an error of the operating system, for `map_err`.
    pub(crate) fn system(action: &'static str) -> impl Fn(io::Error) -> Self {
        move |reason| Self::System { action, reason }
    }
}
