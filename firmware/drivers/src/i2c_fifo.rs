//! Transfers over the FIFOs of the I2C controller of the RP2040 and the RP2350, served whenever the main loop polls
//! (RP2040, 4.3, "I2C").

use embedded_hal_async::i2c::Operation;

/// Words of a FIFO.
const FIFO_LEN: usize = 16;

/// The controller's FIFOs.
pub trait I2cFifos {
    /// Whether there is room for a command.
    fn has_room(&self) -> bool;

    /// Issues a command: writes the byte, or reads one. The last one of a transfer ends with STOP.
    fn command(&mut self, write: Option<u8>, is_last: bool);

    /// Returns a byte that was read.
    fn receive(&mut self) -> Option<u8>;
}

/// Progress of a transfer.
#[derive(Debug, Default)]
pub struct FifoTransfer {
    /// Bytes whose commands are in the FIFO or were executed.
    sent: usize,
    /// Bytes that were read.
    received: usize,
}

impl FifoTransfer {
    /// Fills the transmit FIFO with the bytes to write, or with read commands, at most as many as the receive FIFO can
    /// hold.
    pub fn send(&mut self, fifos: &mut impl I2cFifos, operation: &Operation<'_>) {
        let (bytes, is_read): (&[u8], bool) = match operation {
            Operation::Read(bytes) => (bytes, true),
            Operation::Write(bytes) => (bytes, false),
        };
        while let Some(byte) = bytes.get(self.sent)
            && fifos.has_room()
            && !(is_read && self.sent - self.received >= FIFO_LEN)
        {
            self.sent += 1;
            fifos.command((!is_read).then_some(*byte), self.sent == bytes.len());
        }
    }

    /// Empties the receive FIFO.
    pub fn receive(&mut self, fifos: &mut impl I2cFifos, operation: &mut Operation<'_>) {
        let Operation::Read(bytes) = operation else { return };
        while let Some(place) = bytes.get_mut(self.received)
            && let Some(byte) = fifos.receive()
        {
            *place = byte;
            self.received += 1;
        }
    }

    /// Whether all bytes were read, or queued for writing.
    pub fn is_complete(&self, operation: &Operation<'_>) -> bool {
        match operation {
            Operation::Read(bytes) => self.received == bytes.len(),
            Operation::Write(bytes) => self.sent == bytes.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use proptest::prelude::*;

    use super::*;

    /// A controller whose target sends 0, 1, 2 and so on.
    #[derive(Default)]
    struct Controller {
        commands: VecDeque<(Option<u8>, bool)>,
        received: VecDeque<u8>,
        written: Vec<u8>,
        next: u8,
        stops: u32,
    }

    impl I2cFifos for Controller {
        fn has_room(&self) -> bool {
            self.commands.len() < FIFO_LEN
        }

        fn command(&mut self, write: Option<u8>, is_last: bool) {
            assert!(self.has_room() && self.stops == 0);
            self.commands.push_back((write, is_last));
        }

        fn receive(&mut self) -> Option<u8> {
            self.received.pop_front()
        }
    }

    impl Controller {
        /// Carries out commands. The receive FIFO never overflows.
        fn run(&mut self, count: usize) {
            for (write, is_last) in self.commands.drain(..count.min(self.commands.len())) {
                if let Some(byte) = write {
                    self.written.push(byte);
                } else {
                    assert!(self.received.len() < FIFO_LEN, "a byte is lost");
                    self.received.push_back(self.next);
                    self.next += 1;
                }
                self.stops += u32::from(is_last);
            }
        }
    }

    /// Serves a transfer while the controller carries out commands at this pace.
    fn run(operation: &mut Operation<'_>, pace: &[usize]) -> Controller {
        let (mut controller, mut transfer) = (Controller::default(), FifoTransfer::default());
        for count in pace.iter().cycle().take(1_000) {
            transfer.receive(&mut controller, operation);
            controller.run(*count);
            transfer.send(&mut controller, operation);
            controller.run(*count);
        }
        transfer.receive(&mut controller, operation);
        assert!(transfer.is_complete(operation));
        assert_eq!(controller.stops, 1);
        controller
    }

    proptest! {
        /// Every byte is transferred once, with one STOP, however often the main loop polls.
        #[test]
        fn no_byte_is_lost(len in 1_usize..128, pace in proptest::collection::vec(1_usize..40, 1..20)) {
            let bytes: Vec<u8> = (0..len as u8).collect();
            let mut read = vec![0xff; len];
            run(&mut Operation::Read(&mut read), &pace);
            prop_assert_eq!(&read, &bytes);
            prop_assert_eq!(run(&mut Operation::Write(&bytes), &pace).written, bytes);
        }
    }
}
