//! The tests of the crate as a whole, one program for all of them.

mod accuracy;
mod carried;
mod common;
mod documented;
mod empirical;
mod finite_answers;
mod inverse_table;
mod properties;
mod quantities;
mod refusals;
mod roundings;
mod sized_tables;
