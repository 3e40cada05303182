//! The orders from the firmware's main loop to its tick, observed like a debugger does.

use super::protocol::Request;
use super::{PicoRig, no_answer};
use crate::emulated::EmulatorError;

/// Words of an order: the number of its kind, and a track, the largest one.
const ORDER_WORDS: usize = 17;
/// Numbers of the watched functions, in the order in which they are watched.
const APPLY: u32 = 0;
const TICK: u32 = 1;
/// Parts of their names, and the number of words to read at their argument after `self`: the order.
const NAMES: [(&str, usize); 2] = [("Ticker$GT$5apply", ORDER_WORDS), ("6Ticker4tick", 0)];

/// An order taken by the tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AppliedOrder {
    /// Ticks since the start of watching, including the one that follows the order.
    pub tick: u32,
    /// The number of its kind, as in [`Order`](frixel_control::Order), and the following words in memory.
    pub words: [u32; ORDER_WORDS],
}

/// The bytes received by the board, and the orders taken by its tick.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Watched {
    /// The bytes sent to it: frames of the host and of the touch source.
    pub bytes: Vec<u8>,
    /// The orders taken by its tick.
    pub orders: Vec<AppliedOrder>,
    /// Number of ticks.
    pub ticks: u32,
}

impl PicoRig {
    /// Records every byte received by the board and every order taken by its tick, until its next start. Returns
    /// `false` if the image lacks the names of the functions.
    pub fn watch_orders(&mut self) -> Result<bool, EmulatorError> {
        for (name, words) in NAMES {
            let Some(address) = self.address_of(name)? else { return Ok(false) };
            self.process.request(Request::Watch, &[address, words as u32])?;
        }
        self.watched_bytes = Some(Vec::new());
        Ok(true)
    }

    /// Returns the recording, and ends it.
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
