//! Errors of the emulated board.

use std::io;

use frixel_wire::fault::Fault;
use thiserror::Error;

/// Why there is no emulated board, or why it has stopped.
#[derive(Debug, Error)]
pub enum EmulatorError {
    /// The emulator is not installed.
    #[error("the emulator is not installed: `apt-get install qemu-system-arm`")]
    NoEmulator,
    /// The program that runs the emulator of the Pico is not installed.
    #[error("the Pico's emulator runs on node, which is not installed: `apt-get install nodejs npm`")]
    NoNode,
    /// The program that fetches the emulator of the Pico is not installed.
    #[error("the Pico's emulator rp2040js is fetched by npm, which is not installed: `apt-get install npm`")]
    NoNpm,
    /// The packages that run the image of the Pico could not be installed.
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
    /// There is no compiler.
    #[error(
        "the emulated board's image is not in the folder `images` beside this program, and takes Rust to build, which is not \
         installed: `curl https://sh.rustup.rs -sSf | sh`"
    )]
    NoCompiler,
    /// The board's sources are not there.
    #[error(
        "the emulated board's image is not in the folder `images` beside this program, and frixel's sources to build it \
         are not here: run this in a checkout of frixel, or set FRIXEL_CHECKOUT to the folder of one"
    )]
    NoSources,
    /// The environment names a folder that is no checkout.
    #[error(
        "`FRIXEL_CHECKOUT={folder}` names no checkout of frixel, because {missing}: set it to the folder of one, or unset \
         it"
    )]
    NotACheckout {
        /// The folder, as the environment has it.
        folder: String,
        /// What is missing.
        missing: String,
    },
    /// The image does not compile.
    #[error("the emulated board's image does not compile:\n{output}")]
    NotBuilt {
        /// The compiler's output.
        output: String,
    },
    /// The operating system refuses something.
    #[error("emulated board: {action}: {reason}")]
    System {
        /// The action that failed.
        action: &'static str,
        /// The operating system's error.
        reason: io::Error,
    },
    /// The emulated board would not start with the limits that it is to have.
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
    /// The emulator has made no serial port.
    #[error("the emulator does not say where its serial port is:\n{output}")]
    NoSerialPort {
        /// The emulator's output.
        output: String,
    },
    /// The board did not finish in time.
    #[error("the emulated board owes {what} since {seconds} s: is its image stuck, or the machine overloaded?")]
    Silent {
        /// The missing result.
        what: &'static str,
        /// Wall time since the request.
        seconds: u64,
    },
    /// The firmware ended with a fault and started again, where it must not.
    #[error("the emulated board ended and started again: {fault} (detail {detail:#x})")]
    Restarted {
        /// The fault.
        fault: Fault,
        /// The fault's detail: of a hard fault the program counter, of a stack overflow the address below the stack, of
        /// a panic the line.
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
