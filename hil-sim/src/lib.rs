//! A simulator that stands in for amplifier, screen and finger, in virtual time.
#![forbid(unsafe_code)]
