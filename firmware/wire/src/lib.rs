//! The serial protocol between a host and a frixel board. `PROTOCOL.md` in this crate specifies it byte by byte.
//!
//! A frame is COBS-encoded, ends in a zero byte and carries a CRC-32 ([`frame`]). Its first payload byte is the kind
//! of the payload ([`payload`]): the [`hello`], whose layout is frozen, a [`message`], stream samples, or a chunk of an
//! upload. An upload is a scene (`frixel-layers`) or a bitmap; [`scene`] defines what messages need to know of them.
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
pub mod touch;
