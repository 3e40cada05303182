//! The unsafe code that all Cortex-M boards share. Besides this crate, only the boards' own crates contain unsafe code.
//!
//! - [`TickOwner`]: the tick, owned by its interrupt and declared by [`tick_interrupt!`]; and [`Boot`], the token for
//!   giving it;
//! - [`Owned`]: any other value owned by an interrupt handler;
//! - [`fault_handlers!`]: the handlers of panics, hard faults and interrupts without a handler, and the record of the
//!   last fault;
//! - [`guard`]: turns a stack overflow into a fault;
//! - [`retained`]: a place that the start-up code does not clear;
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

pub use boot::{Boot, unreachable_state};
pub use delay::CycleDelay;
pub use fault::retained;
pub use owned::Owned;
pub use tick_owner::TickOwner;
