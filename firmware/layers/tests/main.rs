//! The tests of the crate as a whole, one program for all of them.

mod bounds;
mod cost;
mod grid;
mod manifests;
mod protocol;
