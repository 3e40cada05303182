//! A detection threshold by a two-alternative staircase: values in, values out.
//!
//! In each trial the finger makes two strokes, one with the stimulus and one without, in random order, and the person
//! says which one had it: [`samples`] are what is played. [`Staircase`] chooses the next level and, in the end, states
//! the threshold with its interval, or that the answers could have been guessed. [`Observer`] answers in a person's
//! place.
//!
//! The level is the amplitude of the electric friction relative to the board's largest, in decibels. Which newtons that
//! are nobody knows, so the result is a level above threshold, never a force.

mod curve;
mod observer;
mod staircase;
mod trial;

pub use observer::Observer;
pub use staircase::{Guessed, Staircase, Threshold};
pub use trial::{FADE_S, STIMULUS_HZ, STROKE_S, level_v_rms, samples};
