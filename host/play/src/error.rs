//! Errors of a play, and refusals that leave it unchanged.

use frixel_driver::DeviceError;
use frixel_model::ParameterError;
use frixel_wire::fault::{Fault, Flags};
use thiserror::Error;

use crate::feed::FeedError;
use crate::live_layers::LiveError;

/// Why a play ended early, or a change of it was not made.
#[derive(Debug, Error)]
pub enum PlayError {
    /// The contact model refuses the finger of the program.
    #[error("the contact model refuses the scene's finger: {0}")]
    Finger(#[from] ParameterError),
    /// The board refused a request, or stopped answering.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The samples to stream could not be read or sent to their end.
    #[error(transparent)]
    Feed(#[from] FeedError),
    /// The layer cannot be changed.
    #[error(transparent)]
    Live(#[from] LiveError),
    /// A board with an electrode plays no program that extrapolates from what was measured on its finger.
    #[error("a real board plays only what was measured on this finger: {warning}")]
    Unmeasured {
        /// The compiler's warning, with what to do.
        warning: String,
    },
    /// No scene plays whose layers could be changed.
    #[error("no scene plays: play one, then change its layers")]
    NothingPlays,
    /// The board does not switch off the layer of a trigger that has ended.
    #[error("the end of the trigger of {layer}: {refused}")]
    TriggerEnd {
        /// Title of the layer.
        layer: String,
        /// The board's reason.
        refused: DeviceError,
    },
    /// The board stopped without a stop command.
    #[error("the board {0}")]
    Stopped(StopReason),
}

impl PlayError {
    /// Whether the request was refused, by the board or earlier, and the play continues unchanged.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Device(error) => is_refusal(error),
            Self::Live(_) | Self::Unmeasured { .. } | Self::NothingPlays => true,
            _ => false,
        }
    }
}

/// Whether the board refused a request, and continues unchanged.
pub(crate) fn is_refusal(error: &DeviceError) -> bool {
    matches!(error, DeviceError::Refused { .. })
}

/// Why a board stopped without a stop command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum StopReason {
    /// A fault is latched.
    #[error("stopped with its output at zero: {0}")]
    Fault(Fault),
    /// The board stopped because of the host timeout.
    #[error("stopped with its output at zero: it had not heard from this host for the scene's host timeout")]
    HostSilent,
}

impl StopReason {
    /// The reason, from the board's report of its state.
    pub(crate) fn of(fault: Option<Fault>, flags: Flags) -> Option<Self> {
        let silent = flags.contains(Flags::HOST_SILENT).then_some(Self::HostSilent);
        fault.map(Self::Fault).or(silent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_that_stopped_by_itself_says_why() {
        assert_eq!(StopReason::of(None, Flags::default()), None);
        assert_eq!(StopReason::of(None, Flags::HOST_SILENT), Some(StopReason::HostSilent));
        let fault = Some(Fault::Deadline);
        assert_eq!(StopReason::of(fault, Flags::HOST_SILENT), Some(StopReason::Fault(Fault::Deadline)));
    }
}
