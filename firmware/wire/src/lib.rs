//! The serial contract between a host and a frixel board. `PROTOCOL.md` beside this crate says it byte by byte.
//!
//! A frame is COBS-encoded, ends in a zero byte and carries a CRC-32 ([`frame`]). Its first payload byte says what it
//! is ([`payload`]): the frozen [`hello`], a [`message`], or a chunk of an upload. What is uploaded is a [`scene`] or
//! a bitmap.
//!
//! Every Cargo feature is a kind of layer or of region, and all are on by default. A board whose image has no code for one
//! is built without reading it, too: such a record is refused as unknown, and [`scene::SceneError::left_out`] tells it from
//! one that nobody knows. Of what is left out only the number is written. Messages are the same with any features.
#![no_std]
#![forbid(unsafe_code)]

mod bytes;
pub mod fault;
pub mod frame;
pub mod hello;
pub mod message;
pub mod payload;
pub mod scene;
