//! What can be missing or go wrong around an emulator.

use std::io;

use thiserror::Error;

/// Why there is no emulated board, or none any more.
#[derive(Debug, Error)]
pub enum EmulatorError {
    /// The emulator is not installed.
    #[error("the emulator is not installed: `apt-get install qemu-system-arm`")]
    NoEmulator,
    /// The compiler cannot compile for the board.
    #[error("the compiler's target for the board is not installed: `rustup target add {target}`")]
    NoTarget {
        /// The target's name.
        target: &'static str,
    },
    /// There is no compiler.
    #[error(
        "the emulated board's image takes Rust to build, which is not installed: `curl https://sh.rustup.rs -sSf | sh`"
    )]
    NoCompiler,
    /// The board's sources are not there.
    #[error(
        "the emulated board's image is built from frixel's sources, which are not here: run this in a checkout of frixel, or set FRIXEL_CHECKOUT to the folder of one"
    )]
    NoSources,
    /// The image does not compile.
    #[error("the emulated board's image does not compile:\n{output}")]
    NotBuilt {
        /// What the compiler says.
        output: String,
    },
    /// The operating system refuses something.
    #[error("emulated board: {action}: {reason}")]
    System {
        /// What was tried.
        action: &'static str,
        /// What the operating system says.
        reason: io::Error,
    },
    /// The emulator has ended.
    #[error("the emulator has ended:\n{output}")]
    Ended {
        /// What it says.
        output: String,
    },
    /// The emulator has made no serial port.
    #[error("the emulator does not say where its serial port is:\n{output}")]
    NoSerialPort {
        /// What it says.
        output: String,
    },
    /// The board does not come to an end.
    #[error("the emulated board owes {what} since {seconds} s: is its image stuck, or the machine overloaded?")]
    Silent {
        /// What it owes.
        what: &'static str,
        /// Wall time since it was asked.
        seconds: u64,
    },
    /// The simulator was too slow for what the board drives.
    #[error(
        "the simulated world is behind the emulated board by more than its memory holds: is the machine overloaded?"
    )]
    WorldBehind,
}

impl EmulatorError {
    /// For `map_err` on what the operating system does.
    pub(crate) fn system(action: &'static str) -> impl Fn(io::Error) -> Self {
        move |reason| Self::System { action, reason }
    }
}
