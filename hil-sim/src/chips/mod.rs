//! Models of the chips on a driver board at register and message level, behind the `embedded-hal` traits of real buses,
//! so that the drivers of `frixel-drivers` run against them.
//!
//! They are written from the data sheets, not from the drivers. A driver owns one clone of a model. Through another, a
//! test powers, breaks and inspects the chip.

mod ad5761r;
mod held_bus;
mod zforce;

pub use ad5761r::{Ad5761rChip, ChipPin};
pub use held_bus::{HeldBus, Transfer};
pub use zforce::{PolledDelay, TouchEvent, ZForceModule};
