//! Contact model of an electrovibration touchscreen (Argatov and Borodich).
#![no_std]
#![forbid(unsafe_code)]

mod contact;
mod edges;
mod real;
mod table;

pub use contact::{Contact, Finger, LoadedContact, ParameterError};
pub use edges::{sine_mean_square_left, square_mean_square_left};
pub use real::Real;
pub use table::{InverseTable, TableError};
