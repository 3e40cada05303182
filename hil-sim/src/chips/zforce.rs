//! Neonode zForce touch sensor module on I2C (Touch Sensor Module User's Guide: I2C transport, serialization protocol).

use std::cell::RefCell;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::digital::{self, InputPin};
use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::{self, ErrorKind, I2c, NoAcknowledgeSource, Operation};

use std::future::poll_fn;
use std::task::Poll;

const ADDRESS: u8 = 0x50;
const TRANSPORT: u8 = 0xee;
const REQUEST: u8 = 0xee;
const RESPONSE: u8 = 0xef;
const NOTIFICATION: u8 = 0xf0;
const ENABLE: u8 = 0x65;
const FREQUENCY: u8 = 0x68;

#[derive(Debug)]
struct Module {
    is_connected: bool,
    is_enabled: bool,
    frequency_hz: Option<u16>,
    /// Unread messages, each preceded by its two bytes. The first may be partly read.
    waiting: VecDeque<VecDeque<u8>>,
    /// Number of polls per transfer.
    transfer_polls: u32,
    corrupted_lengths: u32,
}

/// A module along the edge of a screen. All clones are the same module.
///
/// To a driver it is an I2C bus, and the input that its data-ready output leads to.
#[derive(Clone, Debug)]
pub struct ZForceModule(Rc<RefCell<Module>>);

/// A delay that takes one poll per millisecond.
#[derive(Debug)]
pub struct PolledDelay;

/// State of a touch, as the module reports it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum TouchEvent {
    /// The finger has touched down.
    Down = 0,
    /// The finger is still on the screen.
    Move = 1,
    /// The finger has lifted.
    Up = 2,
    /// The module marks its measurement as invalid.
    Invalid = 3,
}

impl ZForceModule {
    /// A module that has just been switched on. Each transfer takes `transfer_polls` polls.
    #[must_use]
    pub fn new(transfer_polls: u32) -> Self {
        let module = Self(Rc::new(RefCell::new(Module {
            is_connected: true,
            is_enabled: false,
            frequency_hz: None,
            waiting: VecDeque::new(),
            transfer_polls,
            corrupted_lengths: 0,
        })));
        module.restart();
        module
    }

    /// Discards the settings and the unread messages, as a short supply dip does.
    pub fn forget_settings(&self) {
        let mut module = self.0.borrow_mut();
        module.is_enabled = false;
        module.frequency_hz = None;
        module.waiting.clear();
    }

    /// Restarts the module, which loses its settings and announces its start.
    pub fn restart(&self) {
        self.forget_settings();
        self.0.borrow_mut().push(&[NOTIFICATION, 0x09, 0x40, 0x02, 0x00, 0x00, 0x63, 0x03, 0x80, 0x01, 0x00]);
    }

    /// Connects or disconnects the bus.
    pub fn connect(&self, connected: bool) {
        self.0.borrow_mut().is_connected = connected;
    }

    /// Number of unread messages, of which the first may be partly read.
    #[must_use]
    pub fn waiting(&self) -> usize {
        self.0.borrow().waiting.len()
    }

    /// Whether it acknowledges this address.
    #[must_use]
    pub fn acknowledges(&self, address: u8) -> bool {
        self.0.borrow().acknowledges(address)
    }

    /// Replaces the next message by a header with an invalid length.
    pub fn corrupt_length(&self) {
        self.0.borrow_mut().corrupted_lengths += 1;
    }

    /// Returns the scan rate in Hz; `None` before the host has set it.
    #[must_use]
    pub fn frequency_hz(&self) -> Option<u16> {
        self.0.borrow().frequency_hz
    }

    /// Whether the host has enabled reports since the module started.
    #[must_use]
    pub fn is_enabled(&self) -> bool {
        self.0.borrow().is_enabled
    }

    /// Reports a finger at a place, in tenths of a millimetre. Does nothing unless the module is enabled.
    pub fn touch(&self, event: TouchEvent, x: u16, y: u16) {
        let mut module = self.0.borrow_mut();
        if !module.is_enabled {
            return;
        }
        let mut message = vec![NOTIFICATION, 0x11, 0x40, 0x02, 0x02, 0x00, 0xa0, 0x0b, 0x42, 0x09, 0x00, event as u8];
        message.extend(x.to_be_bytes());
        message.extend(y.to_be_bytes());
        message.extend([0x10, 0x10, 0x80]);
        module.push(&message);
    }
}

impl Module {
    fn acknowledges(&self, address: u8) -> bool {
        address == ADDRESS && self.is_connected
    }

    fn push(&mut self, message: &[u8]) {
        if self.corrupted_lengths > 0 {
            self.corrupted_lengths -= 1;
            self.waiting.push_back(VecDeque::from([TRANSPORT, 0]));
            return;
        }
        self.waiting.push_back([TRANSPORT, message.len() as u8].into_iter().chain(message.iter().copied()).collect());
    }

    /// Receives a request and queues the answer.
    fn write(&mut self, bytes: &[u8]) {
        let [TRANSPORT, len, request @ ..] = bytes else { return };
        let [REQUEST, content_len, content @ ..] = request else { return };
        if usize::from(*len) != request.len() || usize::from(*content_len) != content.len() {
            return;
        }
        let [0x40, 0x02, _, 0x00, property, property_len, value @ ..] = content else { return };
        if usize::from(*property_len) != value.len() {
            return;
        }
        match (*property, value) {
            (ENABLE, [0x81, ..]) => self.is_enabled = true,
            (FREQUENCY, [0x80, 0x02, high, low, ..]) => self.frequency_hz = Some(u16::from_be_bytes([*high, *low])),
            _ => {}
        }
        let response: Vec<u8> = [RESPONSE].into_iter().chain(request.iter().copied().skip(1)).collect();
        self.push(&response);
    }

    fn read(&mut self, bytes: &mut [u8]) {
        let Some(message) = self.waiting.front_mut() else { return bytes.fill(0xff) };
        for byte in bytes {
            *byte = message.pop_front().unwrap_or(0xff);
        }
        if message.is_empty() {
            self.waiting.pop_front();
        }
    }
}

impl i2c::ErrorType for ZForceModule {
    type Error = ErrorKind;
}

impl I2c for ZForceModule {
    async fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        let polls = self.0.borrow().transfer_polls;
        wait(polls).await;
        let mut module = self.0.borrow_mut();
        if !module.acknowledges(address) {
            return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
        }
        for operation in operations {
            match operation {
                Operation::Read(bytes) => module.read(bytes),
                Operation::Write(bytes) => module.write(bytes),
            }
        }
        Ok(())
    }
}

impl digital::ErrorType for ZForceModule {
    type Error = Infallible;
}

impl InputPin for ZForceModule {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0.borrow().waiting.is_empty())
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.borrow().waiting.is_empty())
    }
}

impl DelayNs for PolledDelay {
    async fn delay_ns(&mut self, ns: u32) {
        wait(ns.div_ceil(1_000_000)).await;
    }
}

/// Returns after some polls.
async fn wait(polls: u32) {
    let mut left = polls;
    poll_fn(|context| {
        if left == 0 {
            return Poll::Ready(());
        }
        left -= 1;
        context.waker().wake_by_ref();
        Poll::Pending
    })
    .await;
}
