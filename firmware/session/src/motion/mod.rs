//! The finger's motion: touch reports in, tracks out.

mod estimator;
pub(crate) mod fingers;
mod standstill;
pub(crate) mod tracker;
