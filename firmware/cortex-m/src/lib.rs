//! What every board with a Cortex-M needs unsafe code for. Beside this crate, only the boards' own crates have any.
//!
//! - [`TickOwner`]: the tick, which its interrupt owns, declared by [`tick_interrupt!`]; and [`Boot`], the token with
//!   which it is given;
//! - [`Owned`]: any other value that an interrupt handler owns;
//! - [`fault_handlers!`]: the handlers of panics, hard faults and interrupts without a handler, and the record of the
//!   last fault;
//! - [`guard`]: makes a stack overflow a fault;
//! - [`outlasting`]: a place that the start-up code does not clear;
//! - [`runs_from_ram!`]: an image that runs from RAM;
//! - [`CycleDelay`]: waits by the core's clock.
#![no_std]

mod boot;
mod delay;
pub mod fault;
pub mod guard;
mod owned;
pub mod ram_image;
mod tick_owner;

pub use boot::{Boot, never};
pub use delay::CycleDelay;
pub use fault::outlasting;
pub use owned::Owned;
pub use tick_owner::TickOwner;
