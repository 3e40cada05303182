//! Contact model of an electrovibration touchscreen (Argatov and Borodich).
#![no_std]
#![forbid(unsafe_code)]

mod carrier;
mod contact;
mod real;
mod table;

pub use carrier::{Carrier, ElectrodeCurrent, Waveform};
pub use contact::{Contact, Finger, LoadedContact, ParameterError};
pub use real::Real;
pub use table::{InverseTable, TableError};
