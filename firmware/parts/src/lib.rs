//! What stands on a driver board beside the processor, as far as it can be told without the hardware, so that it is
//! tested on the desktop. A board's own crate holds registers and wiring only.
//!
//! | module | part |
//! |---|---|
//! | [`ad5761r`] | 16-bit bipolar DAC |
//! | [`zforce`] | optical touch frame |
//! | [`arm_switch`] | switch that a person holds |
//! | [`monitor`] | the amplifier's monitor output behind an ADC |
//! | [`ring`] | serial bytes that DMA puts into a ring |
//! | [`fault_record`] | what went wrong, kept in RAM over a reset |
//! | [`reset`] | why the processor started |
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod ad5761r;
pub mod arm_switch;
pub mod fault_record;
pub mod monitor;
pub mod reset;
pub mod ring;
pub mod zforce;
