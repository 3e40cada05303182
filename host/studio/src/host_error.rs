//! Why a request of the page is refused or fails.

use frixel_driver::{ControlError, DeviceError};
use frixel_play::{PlayError, SimulationError};
use thiserror::Error;

use crate::layer_text::TextError;
use crate::program::ProgramError;

/// Why a request of the page was not carried out.
#[derive(Debug, Error)]
pub enum HostError {
    /// The scene has mistakes.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// The board, the line to it, or a change of what plays failed.
    #[error(transparent)]
    Play(#[from] PlayError),
    /// The board, or its player, refuses a scene that the compiler accepts.
    #[error("the board refused this scene: {0}")]
    Refused(PlayError),
    /// The simulated world could not be built, or the strokes that judge the scene could not be played.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// A control line has a mistake.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// A control line that a page does not carry out.
    #[error("`{line}` cannot run in a page: use `layer` or `trigger`")]
    NotInPage {
        /// The line.
        line: String,
    },
    /// A text cannot be read or edited.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A file is not a picture that can be played.
    #[error("{0}")]
    Picture(String),
    /// There is no board.
    #[error("no board is connected: connect one, or use the simulator")]
    NoBoard,
}

impl From<DeviceError> for HostError {
    fn from(error: DeviceError) -> Self {
        Self::Play(error.into())
    }
}

impl HostError {
    /// Whether the board is unreachable over this line: silent, gone or restarted.
    pub(crate) fn is_link_lost(&self) -> bool {
        let Self::Play(PlayError::Device(error)) = self else { return false };
        matches!(
            error,
            DeviceError::NoHello { .. }
                | DeviceError::Silent { .. }
                | DeviceError::Vanished { .. }
                | DeviceError::Restarted { .. }
                | DeviceError::TelemetryBackwards { .. }
        )
    }
}
