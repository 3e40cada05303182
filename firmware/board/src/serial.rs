//! The serial port to the host, over a UART whose received bytes are stored in a ring by DMA or an interrupt.

use core::convert::Infallible;
use core::sync::atomic::AtomicU8;

use embedded_io::{ErrorType, Read, ReadReady, Write, WriteReady};
use frixel_drivers::ring::RingReader;

/// Largest number of bytes that the host may have in flight.
pub const RECEIVE_WINDOW: usize = 4096;
/// Length of the ring: the host's credit, plus room for a hello and some noise, which need no credit.
pub const RING_LEN: usize = RECEIVE_WINDOW + 512;

/// A UART that runs.
pub trait Uart {
    /// The ring of received bytes.
    fn ring(&self) -> &'static [AtomicU8; RING_LEN];

    /// Bytes until the ring wraps around. Clears conditions that keep the UART from receiving, such as an overrun flag;
    /// the lost bytes damage frames, which the host resends.
    fn remaining(&mut self) -> usize;

    /// Whether [`Self::send`] accepts a byte.
    fn takes_bytes(&self) -> bool;

    /// Begins to send bytes and returns the number accepted, without waiting.
    fn send(&mut self, bytes: &[u8]) -> usize;

    /// Whether everything has been sent.
    fn has_sent_all(&self) -> bool;
}

/// The serial port.
pub struct SerialPort<U> {
    uart: U,
    reader: RingReader<RING_LEN>,
}

impl<U: Uart> SerialPort<U> {
    /// The port of a UART whose ring is at its beginning.
    pub const fn new(uart: U) -> Self {
        Self { uart, reader: RingReader::new() }
    }
}

impl<U> ErrorType for SerialPort<U> {
    type Error = Infallible;
}

impl<U: Uart> ReadReady for SerialPort<U> {
    fn read_ready(&mut self) -> Result<bool, Infallible> {
        Ok(!self.reader.is_empty(self.uart.remaining()))
    }
}

impl<U: Uart> Read for SerialPort<U> {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        Ok(self.reader.read(self.uart.ring(), || self.uart.remaining(), bytes))
    }
}

impl<U: Uart> WriteReady for SerialPort<U> {
    fn write_ready(&mut self) -> Result<bool, Infallible> {
        Ok(self.uart.takes_bytes())
    }
}

impl<U: Uart> Write for SerialPort<U> {
    /// Begins to send once the UART accepts a byte.
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        if bytes.is_empty() {
            return Ok(0);
        }
        while !self.uart.takes_bytes() {}
        Ok(self.uart.send(bytes))
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        while !self.uart.has_sent_all() {}
        Ok(())
    }
}
