//! Contact model of an electrovibration touchscreen (Argatov and Borodich).
#![no_std]
#![forbid(unsafe_code)]

mod carrier;
mod coating;
mod contact;
mod error;
mod finger;
mod real;
mod root;
mod shear;
mod soft;
mod state;
mod table;

pub use carrier::{Carrier, ElectrodeCurrent, Waveform};
pub use coating::{Slab, VACUUM_PERMITTIVITY_F_PER_M, attraction_pa, contact_attraction_pa, effective_gap_m};
pub use contact::{Contact, FiniteContact, LoadedContact, LowerBound, PulledContact};
pub use error::{Expected, InverseError, ParameterError, StateError};
pub use finger::Finger;
pub use real::Real;
pub use shear::{ShearOnset, TissueSpring};
pub use soft::{PowerLawShape, SoftContact, SoftFinger, SoftLoadedContact, SoftLowerBound, contact_exponent};
pub use state::{ContactModel, ContactState, Sensitivity};
pub use table::{InverseTable, TableError};
