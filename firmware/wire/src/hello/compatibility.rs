//! Whether board and host can talk, and which of them to change when they cannot.

use core::fmt;

use super::{Hello, PROTOCOL_MAJOR, PROTOCOL_MINOR};

/// Board and host speak protocols of different major versions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mismatch {
    /// The board is the older one.
    BoardOlder {
        /// Protocol that the board speaks: major, minor.
        board: (u8, u8),
        /// Version of the board's firmware: major, minor, patch.
        firmware: (u8, u8, u8),
    },
    /// The board is the newer one.
    BoardNewer {
        /// Protocol that the board speaks: major, minor.
        board: (u8, u8),
        /// Version of the board's firmware: major, minor, patch.
        firmware: (u8, u8, u8),
    },
}

impl Hello {
    /// Whether a host with this crate can talk to the board: the major versions of their protocols are the same. When
    /// they are not, the host sends nothing but hello requests.
    pub const fn compatibility(&self) -> Result<(), Mismatch> {
        let (board, firmware) = (self.protocol, self.firmware);
        if board.0 < PROTOCOL_MAJOR {
            Err(Mismatch::BoardOlder { board, firmware })
        } else if board.0 > PROTOCOL_MAJOR {
            Err(Mismatch::BoardNewer { board, firmware })
        } else {
            Ok(())
        }
    }
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::BoardOlder { board, firmware } | Self::BoardNewer { board, firmware }) = self;
        write!(
            f,
            "the board's firmware {}.{}.{} speaks protocol {}.{}, this program speaks {PROTOCOL_MAJOR}.{PROTOCOL_MINOR}: ",
            firmware.0, firmware.1, firmware.2, board.0, board.1
        )?;
        match self {
            Self::BoardOlder { .. } => write!(f, "flash newer firmware, one that speaks protocol {PROTOCOL_MAJOR}"),
            Self::BoardNewer { .. } => write!(f, "update the frixel command to one that speaks protocol {}", board.0),
        }
    }
}

impl core::error::Error for Mismatch {}
