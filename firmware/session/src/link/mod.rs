//! The serial line's side of the session.

pub(crate) mod credit;
pub(crate) mod transmit_queue;
