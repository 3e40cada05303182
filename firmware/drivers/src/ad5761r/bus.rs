//! The DAC's bus as an `SpiDevice`, based on a processor's exchange of bytes.

use embedded_hal::spi::{self, ErrorKind, ErrorType, Operation, SpiDevice};

use super::{FRAME_LEN, Frame};

/// A processor's side of the bus.
pub trait FrameBus {
    /// Sends bytes while SYNC is low, and replaces each by the byte received at the same time.
    fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), BusError>;
}

/// Why a transfer failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BusError {
    /// The bus did not become idle, or did not receive a byte.
    Timeout,
    /// A transaction other than a single frame, which the driver never needs.
    Unsupported,
}

impl spi::Error for BusError {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

/// The bus for the driver: one frame per transaction.
#[derive(Debug)]
pub struct FrameDevice<B>(pub B);

impl<B> ErrorType for FrameDevice<B> {
    type Error = BusError;
}

impl<B: FrameBus> SpiDevice for FrameDevice<B> {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), BusError> {
        match operations {
            [Operation::Write(bytes)] => {
                let mut frame: Frame = (*bytes).try_into().map_err(|_| BusError::Unsupported)?;
                self.0.exchange(&mut frame)
            }
            [Operation::TransferInPlace(bytes)] if bytes.len() == FRAME_LEN => self.0.exchange(bytes),
            _ => Err(BusError::Unsupported),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers with the complement of each byte.
    #[derive(Default)]
    struct Complement {
        sent: Vec<Vec<u8>>,
    }

    impl FrameBus for Complement {
        fn exchange(&mut self, bytes: &mut [u8]) -> Result<(), BusError> {
            self.sent.push(bytes.to_vec());
            for byte in bytes {
                *byte = !*byte;
            }
            Ok(())
        }
    }

    #[test]
    fn a_transaction_is_one_frame() {
        let mut device = FrameDevice(Complement::default());
        let mut frame = [1, 2, 3];
        assert_eq!(device.write(&[4, 5, 6]), Ok(()));
        assert_eq!(device.transfer_in_place(&mut frame), Ok(()));
        assert_eq!(frame, [!1, !2, !3]);
        assert_eq!(device.0.sent, [[4, 5, 6], [1, 2, 3]]);
        assert_eq!(device.write(&[0; 2]), Err(BusError::Unsupported));
        assert_eq!(device.transfer_in_place(&mut [0; 4]), Err(BusError::Unsupported));
        assert_eq!(device.read(&mut [0; 3]), Err(BusError::Unsupported));
        assert_eq!(device.transaction(&mut []), Err(BusError::Unsupported));
        let two = &mut [Operation::Write(&[0; 3]), Operation::Write(&[0; 3])];
        assert_eq!(device.transaction(two), Err(BusError::Unsupported));
        assert_eq!(device.0.sent.len(), 2);
    }
}
