//! The serial contract between a host and a frixel board. `PROTOCOL.md` beside this crate says it byte by byte.
//!
//! A frame is COBS-encoded, ends in a zero byte and carries a CRC-32 ([`frame`]). Its first payload byte says what it
//! is ([`payload`]): the frozen [`hello`], a [`message`], or a chunk of an upload. What is uploaded is a scene
//! (`frixel-layers`) or a bitmap; [`scene`] has what messages say of them.
#![no_std]
#![forbid(unsafe_code)]

pub mod bytes;
pub mod dac_code;
pub mod fault;
pub mod frame;
pub mod hello;
pub mod message;
pub mod payload;
pub mod scene;
