//! The tests of the crate as a whole, one program for all of them.

mod chips;
mod dac;
mod live;
mod looped_board;
mod properties;
mod resting;
mod rig;
mod script;
mod world;
