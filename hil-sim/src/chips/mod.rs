//! Models of the chips on a driver board at register and message level, behind the `embedded-hal` traits of real buses,
//! so that the drivers of `frixel-drivers` run against them.
//!
//! They are written from the data sheets, not from the drivers. Each model has two sides: the bus
//! ([`Ad5761rChip::spi`], [`ZForceModule::bus`], ...), which a driver owns, and the model itself, through which a test
//! powers, breaks and inspects the chip.

mod ad5761r;
mod held_bus;
mod zforce;

pub use ad5761r::{Ad5761rChip, ChipDelay, ChipPin, ChipSpi};
pub use held_bus::{HeldBus, SclPin, SdaPin, Transfer};
pub use zforce::{BusFault, DataReadyPin, ModuleBus, PolledDelay, TouchEvent, ZForceModule};
