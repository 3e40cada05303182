//! Fits recover people, and scenarios show what they expect.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod columns;
mod coverage;
mod empirical;
mod examples;
mod filters;
mod floors;
mod goodput;
mod model_csv;
mod person;
mod refusals;
mod scenarios;
mod simulated;
mod slow_sensors;
mod tally;
