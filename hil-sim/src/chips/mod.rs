//! Models of the chips on a driver board at the level of their registers and messages, behind the `embedded-hal` traits
//! that the real buses implement: the drivers of `frixel-drivers` run against them.
//!
//! They are written from the data sheets, not from the drivers. Each model has two sides: the bus side
//! ([`Ad5761rChip::spi`], [`ZForceModule::bus`], ...), which a driver owns, and the model itself, with which a test
//! supplies, breaks and reads the chip.

mod ad5761r;
mod held_bus;
mod zforce;

pub use ad5761r::{Ad5761rChip, ChipDelay, ChipPin, ChipSpi};
pub use held_bus::{HeldBus, SclPin, SdaPin, Transfer};
pub use zforce::{BusFault, DataReadyPin, ModuleBus, PolledDelay, TouchEvent, ZForceModule};
