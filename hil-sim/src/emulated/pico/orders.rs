//! The orders that the firmware's main loop hands to its tick, seen as by a debugger.

use super::protocol::Request;
use super::{PicoRig, no_answer};
use crate::emulated::EmulatorError;

/// Words of an order: the number of its kind, and a track, the largest one.
const ORDER_WORDS: usize = 17;
/// Numbers of the watched functions, in the order in which they are watched.
const APPLY: u32 = 0;
const TICK: u32 = 1;
/// Parts of their names, and the words to read of what their argument behind `self` points at: the order.
const NAMES: [(&str, usize); 2] = [("Ticker$GT$5apply", ORDER_WORDS), ("6Ticker4tick", 0)];

/// An order that the tick has taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AppliedOrder {
    /// Ticks since the orders are watched, with the one that follows the order.
    pub tick: u32,
    /// The number of its kind, as [`Order`](frixel_control::Order) counts them, and what follows that in memory.
    pub words: [u32; ORDER_WORDS],
}

/// The bytes that the board has received, and the orders that its tick has taken.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Watched {
    /// The bytes that were sent to it: frames of the host and of the touch source.
    pub bytes: Vec<u8>,
    /// The orders that its tick has taken.
    pub orders: Vec<AppliedOrder>,
    /// Number of ticks.
    pub ticks: u32,
}

impl PicoRig {
    /// Notes every byte that the board receives and every order that its tick takes, until its next start. Returns
    /// `false` if the image does not name the functions.
    pub fn watch_orders(&mut self) -> Result<bool, EmulatorError> {
        for (name, words) in NAMES {
            let Some(address) = self.address_of(name)? else { return Ok(false) };
            self.process.request(Request::Watch, &[address, words as u32])?;
        }
        self.watched_bytes = Some(Vec::new());
        Ok(true)
    }

    /// Returns the notes, and ends them.
    pub fn take_watched(&mut self) -> Result<Watched, EmulatorError> {
        let words = self.process.request(Request::TakeCalls, &[])?;
        let mut watched = Watched { bytes: self.watched_bytes.take().unwrap_or_default(), ..Watched::default() };
        let mut rest = &words[..];
        while let Some((function, after)) = rest.split_first() {
            rest = after;
            if *function == TICK {
                watched.ticks += 1;
                continue;
            }
            let order = rest.split_first_chunk().filter(|_| *function == APPLY);
            let (words, after) = order.ok_or_else(|| no_answer("which orders the tick took"))?;
            watched.orders.push(AppliedOrder { tick: watched.ticks + 1, words: *words });
            rest = after;
        }
        Ok(watched)
    }
}
