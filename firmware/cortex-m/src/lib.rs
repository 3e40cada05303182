//! What every board with a Cortex-M needs unsafe code for. Beside this crate, only the boards' own crates have any.
//!
//! - [`Owned`]: a value that an interrupt handler owns, and [`TickOwner`], the tick that its interrupt owns;
//! - [`guard`]: makes a stack overflow a fault;
//! - [`hard_fault_handler!`]: the handler of hard faults, on a stack of its own;
//! - [`outlasting`]: a place that the start-up code does not clear.
#![no_std]

pub mod fault;
pub mod guard;
mod owned;
mod tick_owner;

pub use fault::outlasting;
pub use owned::Owned;
pub use tick_owner::TickOwner;
