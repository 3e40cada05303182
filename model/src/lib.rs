//! Contact model of an electrovibration touchscreen (Argatov and Borodich).
#![no_std]
#![forbid(unsafe_code)]

mod contact;
mod edges;
mod real;
mod table;

pub use contact::{Contact, Finger, LoadedContact, ParameterError};
pub use edges::{sine_peak_per_rms, square_peak_per_rms};
pub use real::Real;
pub use table::{InverseTable, TableError};
