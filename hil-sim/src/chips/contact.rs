//! A switch whose contact bounces.

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::digital::{ErrorType, InputPin};

use crate::random::{Purpose, Random};

#[derive(Debug)]
struct Contact {
    is_pressed: bool,
    bounce_ticks: u32,
    /// Ticks for which the contact still bounces.
    left_ticks: u32,
    level: bool,
    random: Random,
}

/// A normally open push button between a pin and the supply, with a pull-down at the pin.
#[derive(Clone, Debug)]
pub struct BouncingContact(Rc<RefCell<Contact>>);

/// The pin that reads the button.
#[derive(Debug)]
pub struct ContactPin(Rc<RefCell<Contact>>);

impl BouncingContact {
    /// A button, pressed or not, that bounces for `bounce_ticks` whenever that changes.
    #[must_use]
    pub fn new(is_pressed: bool, bounce_ticks: u32, seed: u64) -> Self {
        let random = Random::new(seed, Purpose::ContactBounce);
        Self(Rc::new(RefCell::new(Contact { is_pressed, bounce_ticks, left_ticks: 0, level: is_pressed, random })))
    }

    /// The pin for a driver.
    #[must_use]
    pub fn pin(&self) -> ContactPin {
        ContactPin(Rc::clone(&self.0))
    }

    /// Presses or releases the button.
    pub fn press(&self, pressed: bool) {
        let mut contact = self.0.borrow_mut();
        if contact.is_pressed != pressed {
            contact.is_pressed = pressed;
            contact.left_ticks = contact.bounce_ticks;
        }
    }

    /// Advances one tick.
    pub fn tick(&self) {
        let mut contact = self.0.borrow_mut();
        let bounces = contact.left_ticks > 0;
        contact.left_ticks = contact.left_ticks.saturating_sub(1);
        contact.level = if bounces { contact.random.uniform() < 0.5 } else { contact.is_pressed };
    }
}

impl ErrorType for ContactPin {
    type Error = Infallible;
}

impl InputPin for ContactPin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.borrow().level)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0.borrow().level)
    }
}
