//! The soft finger of Xydas and Kao, whose stiffness depends on the force on it.

mod contact;
mod finger;
mod shape;

pub use contact::{SoftContact, SoftLoadedContact};
pub use finger::{SoftFinger, contact_exponent};
pub use lower::SoftLowerBound;
pub use shape::PowerLawShape;

mod lower;
