//! An I2C bus whose target was interrupted in a transfer by a reset of the controller (NXP UM10204, "Byte format",
//! "Acknowledge (ACK) and Not Acknowledge (NACK)", unread).

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

/// Number of the clock that carries the acknowledgement.
const ACKNOWLEDGE: u32 = 8;

/// The interrupted transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// The target sends this byte repeatedly, as long as it is acknowledged.
    Sends(u8),
    /// The target receives bytes and acknowledges each.
    Receives,
    /// None: the target waits for a START condition.
    Idle,
}

#[derive(Debug)]
struct Bus {
    transfer: Transfer,
    /// Clock of the byte, 0 to 8.
    clock: u32,
    scl_is_high: bool,
    is_shorted: bool,
    pulses: u32,
}

/// A bus with one target, and a controller that releases both lines. All clones are the same bus.
///
/// To the controller's driver, SCL is an open-drain output, and SDA an input.
#[derive(Clone, Debug)]
pub struct HeldBus(Rc<RefCell<Bus>>);

impl HeldBus {
    /// A bus whose target is at clock `clock` (0 to 8) of a byte, with SCL high.
    #[must_use]
    pub fn new(transfer: Transfer, clock: u32) -> Self {
        let bus = Bus { transfer, clock, scl_is_high: true, is_shorted: false, pulses: 0 };
        Self(Rc::new(RefCell::new(bus)))
    }

    /// Shorts SDA to ground.
    pub fn short_sda(&self) {
        self.0.borrow_mut().is_shorted = true;
    }

    /// Issues a START condition, which resets the target. Returns whether this was possible, which requires both lines
    /// to be high.
    #[must_use]
    pub fn start(&self) -> bool {
        let mut bus = self.0.borrow_mut();
        let can_start = bus.scl_is_high && bus.sda_is_high();
        if can_start {
            bus.transfer = Transfer::Idle;
        }
        can_start
    }

    /// Number of clock pulses so far.
    #[must_use]
    pub fn pulses(&self) -> u32 {
        self.0.borrow().pulses
    }
}

impl Bus {
    fn sda_is_high(&self) -> bool {
        let released = match self.transfer {
            Transfer::Sends(byte) => self.clock == ACKNOWLEDGE || byte >> (7 - self.clock) & 1 != 0,
            Transfer::Receives => self.clock != ACKNOWLEDGE,
            Transfer::Idle => true,
        };
        released && !self.is_shorted
    }

    fn set_scl(&mut self, high: bool) {
        if high && !self.scl_is_high {
            self.pulses += 1;
            // The missing acknowledgement stops a sending target.
            if matches!(self.transfer, Transfer::Sends(_)) && self.clock == ACKNOWLEDGE && self.sda_is_high() {
                self.transfer = Transfer::Idle;
            }
        } else if !high && self.scl_is_high {
            self.clock = (self.clock + 1) % (ACKNOWLEDGE + 1);
        }
        self.scl_is_high = high;
    }
}

impl ErrorType for HeldBus {
    type Error = Infallible;
}

impl OutputPin for HeldBus {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().set_scl(false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().set_scl(true);
        Ok(())
    }
}

impl InputPin for HeldBus {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.borrow().sda_is_high())
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0.borrow().sda_is_high())
    }
}
