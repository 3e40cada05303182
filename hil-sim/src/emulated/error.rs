//! Errors of the emulated board.

use std::io;

use frixel_wire::fault::Fault;
use thiserror::Error;

/// Why an emulated board is unavailable, or has stopped.
#[derive(Debug, Error)]
pub enum EmulatorError {
    /// A program, or a target of the compiler, is not installed.
    #[error("{what} is not installed: `{command}`")]
    NotInstalled {
        /// The missing part, and what needs it.
        what: &'static str,
        /// The command that installs it.
        command: String,
    },
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
    /// A program failed.
    #[error("{failure}:\n{output}")]
    Failed {
        /// The failure.
        failure: String,
        /// The program's output.
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
        "the simulated world lags the emulated board by more than their shared memory holds: is the machine overloaded?"
    )]
    WorldBehind,
}

impl EmulatorError {
    /// The emulator has ended, with this output.
    pub(crate) fn ended(output: impl Into<String>) -> Self {
        Self::Failed { failure: "the emulator has ended".into(), output: output.into() }
    }

    /// Wraps an error of the operating system, for `map_err`.
    pub(crate) fn system(action: &'static str) -> impl Fn(io::Error) -> Self {
        move |reason| Self::System { action, reason }
    }
}
