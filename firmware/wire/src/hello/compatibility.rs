//! Protocol compatibility of board and host, and which side to update if they are incompatible.

use core::fmt;

use super::{Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR};
use crate::frame::FRAME_MAX_LEN;

/// Why board and host are incompatible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mismatch {
    /// The board speaks another major version of the protocol.
    Protocol {
        /// Protocol version of the board: major, minor.
        board: (u8, u8),
        /// Version of the board's firmware: major, minor, patch.
        firmware: (u8, u8, u8),
    },
    /// The board's largest frame is shorter than the host's.
    FramesTooShort {
        /// Largest frame that the board accepts, in bytes.
        max: u16,
    },
}

impl Hello {
    /// Checks that a host with this crate can communicate with the board: the major protocol versions must be equal,
    /// and the board must accept frames of [`FRAME_MAX_LEN`] bytes. If the versions differ, the host sends only hello
    /// requests.
    pub const fn compatibility(&self) -> Result<(), Mismatch> {
        let (board, firmware) = (self.protocol, self.firmware);
        if board.0 != PROTOCOL_MAJOR {
            Err(Mismatch::Protocol { board, firmware })
        } else if (self.frame_max_len as usize) < FRAME_MAX_LEN {
            Err(Mismatch::FramesTooShort { max: self.frame_max_len })
        } else {
            Ok(())
        }
    }
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Protocol { board, firmware } => {
                write!(
                    f,
                    "the board's firmware {}.{}.{} speaks protocol {}.{}, this program speaks \
                     {PROTOCOL_MAJOR}.{PROTOCOL_MINOR}: ",
                    firmware.0, firmware.1, firmware.2, board.0, board.1
                )?;
                if board.0 < PROTOCOL_MAJOR {
                    write!(f, "flash newer firmware, one that speaks protocol {PROTOCOL_MAJOR}")
                } else {
                    write!(f, "update the frixel command to one that speaks protocol {}", board.0)
                }
            }
            Self::FramesTooShort { max } => write!(
                f,
                "the board accepts frames of at most {max} bytes, and this program sends {FRAME_MAX_LEN}: flash newer \
                 firmware"
            ),
        }
    }
}

impl core::error::Error for Mismatch {}
