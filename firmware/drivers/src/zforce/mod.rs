//! Neonode zForce touch sensor module: a bar of infrared light along one edge of the screen, which measures the finger
//! without contact to glass or drive (Neonode Touch Sensor Module User's Guide: I2C transport).
//!
//! The driver is asynchronous, because a transfer takes milliseconds. It needs no executor: call
//! [`poll_once`](crate::polling::poll_once) in the main loop.

mod message;

use core::fmt;

use embedded_hal::digital::InputPin;
use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

pub use message::{
    ENABLE, I2C_ADDRESS, LENGTH_LEN, MESSAGE_MAX_LEN, Message, SET_FREQUENCY, Touch, message_len, parse,
};

use crate::polling::yield_now;

/// Pause after a failed transfer, before the module is set up again, ms.
const PAUSE_MS: u32 = 100;
/// Bytes of a discarded transfer: a report of two fingers.
const DISCARDED_LEN: usize = 32;
/// Largest number of transfers discarded between two pauses, 50 ms at 400 kHz: more than a module reports in a pause.
const DISCARDED_MAX: u32 = 64;

/// The module: its bus, its data-ready pin (high while a message waits), and a delay.
#[derive(Debug)]
pub struct ZForce<B, R, D> {
    bus: B,
    data_ready: R,
    delay: D,
    is_set_up: bool,
}

/// Why a report could not be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Error<E> {
    /// The bus failed.
    I2c(E),
    /// The data-ready pin could not be read.
    DataReady,
    /// More messages keep waiting, no matter how many are read.
    Waiting,
    /// Invalid header: expected `ee` and a length from 1 to 127.
    Length([u8; LENGTH_LEN]),
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::I2c(error) => write!(f, "the touch frame's bus failed: {error:?}; check its supply, SCL and SDA"),
            Self::DataReady => f.write_str("the touch frame's data-ready pin could not be read; check its wire"),
            Self::Waiting => write!(
                f,
                "the touch frame has messages after {DISCARDED_MAX} of {DISCARDED_LEN} bytes were discarded, expected \
                 none; if this goes on, check the wire of its data-ready pin"
            ),
            Self::Length([transport, len]) => {
                write!(
                    f,
                    "the touch frame sent {transport:#04x}, {len} in front of a message, expected 0xee, 1 to 127; \
                     check SCL and SDA, and restart the frame"
                )
            }
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}

impl<E> From<E> for Error<E> {
    fn from(error: E) -> Self {
        Self::I2c(error)
    }
}

impl<B: I2c, R: InputPin, D: DelayNs> ZForce<B, R, D> {
    /// Creates a driver for the module on `bus`. Sends nothing yet.
    pub const fn new(bus: B, data_ready: R, delay: D) -> Self {
        Self { bus, data_ready, delay, is_set_up: false }
    }

    /// Waits for the next report of a finger. Sets the module up at the first call, and again after the module has
    /// restarted.
    ///
    /// After an error it pauses for 0.1 s and returns it; the next call sets the module up again.
    pub async fn next_touch(&mut self) -> Result<Touch, Error<B::Error>> {
        let touch = self.wait_for_touch().await;
        if touch.is_err() {
            self.is_set_up = false;
            self.delay.delay_ms(PAUSE_MS).await;
        }
        touch
    }

    async fn wait_for_touch(&mut self) -> Result<Touch, Error<B::Error>> {
        loop {
            if !self.is_set_up {
                self.discard_waiting().await?;
                self.bus.write(I2C_ADDRESS, &SET_FREQUENCY).await?;
                self.bus.write(I2C_ADDRESS, &ENABLE).await?;
                self.is_set_up = true;
            }
            match self.read_message().await? {
                Message::Touch(touch) => return Ok(touch),
                Message::Started => self.is_set_up = false,
                Message::Other => {}
            }
        }
    }

    async fn read_message(&mut self) -> Result<Message, Error<B::Error>> {
        while !self.is_data_ready()? {
            yield_now().await;
        }
        let mut length = [0; LENGTH_LEN];
        self.bus.read(I2C_ADDRESS, &mut length).await?;
        let mut message = [0; MESSAGE_MAX_LEN];
        let message = message_len(length).and_then(|len| message.get_mut(..len)).ok_or(Error::Length(length))?;
        self.bus.read(I2C_ADDRESS, message).await?;
        Ok(parse(message))
    }

    /// Reads and discards unread data: the rest of a message partly read by a failed transfer, and reports that are now
    /// older than the board assumes.
    async fn discard_waiting(&mut self) -> Result<(), Error<B::Error>> {
        for _ in 0..DISCARDED_MAX {
            if !self.is_data_ready()? {
                return Ok(());
            }
            self.bus.read(I2C_ADDRESS, &mut [0; DISCARDED_LEN]).await?;
        }
        Err(Error::Waiting)
    }

    fn is_data_ready(&mut self) -> Result<bool, Error<B::Error>> {
        self.data_ready.is_high().map_err(|_| Error::DataReady)
    }
}
