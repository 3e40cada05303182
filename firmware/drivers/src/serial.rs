//! Bytes between a serial port and the session, without waiting.

use embedded_io::{Read, ReadReady, Write, WriteReady};

/// Number of bytes moved at a time: more than a frame of the protocol.
const CHUNK_LEN: usize = 256;

/// A serial port, and the bytes that it has not accepted yet.
#[derive(Debug)]
pub struct BufferedSerial<P> {
    port: P,
    transmitting: [u8; CHUNK_LEN],
    /// Number of bytes of `transmitting` accepted by the port, and number of bytes in it.
    taken: usize,
    len: usize,
}

impl<P: Read + ReadReady + Write + WriteReady> BufferedSerial<P> {
    /// Buffers for `port`.
    pub const fn new(port: P) -> Self {
        Self { port, transmitting: [0; CHUNK_LEN], taken: 0, len: 0 }
    }

    /// Passes up to 256 received bytes to `take`, so that the caller can do other work between two calls.
    pub fn receive(&mut self, take: impl FnOnce(&[u8])) -> Result<(), P::Error> {
        if self.port.read_ready()? {
            let mut bytes = [0; CHUNK_LEN];
            let len = self.port.read(&mut bytes)?;
            take(bytes.get(..len).unwrap_or_default());
        }
        Ok(())
    }

    /// Sends bytes from `fill` until the port accepts no more. `fill` writes bytes and returns their number, 0 if there
    /// is nothing to send.
    pub fn transmit(&mut self, mut fill: impl FnMut(&mut [u8]) -> usize) -> Result<(), P::Error> {
        while self.port.write_ready()? {
            if self.taken == self.len {
                self.taken = 0;
                self.len = fill(&mut self.transmitting).min(CHUNK_LEN);
            }
            let rest = self.transmitting.get(self.taken..self.len).unwrap_or_default();
            if rest.is_empty() {
                return Ok(());
            }
            self.taken += self.port.write(rest)?;
        }
        Ok(())
    }

    /// The port.
    pub fn port_mut(&mut self) -> &mut P {
        &mut self.port
    }
}
