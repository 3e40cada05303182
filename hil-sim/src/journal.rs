//! A journal: everything that crossed a board's pins, tick by tick.

use frixel_exchange::{Done, Given};

/// What a board was given and what it did at each of its first ticks, as words of [`frixel_exchange`].
///
/// [`Rig::start_journal`](crate::Rig::start_journal) begins one. Played to another board, it tells whether the two are
/// the same: a board that does at every tick what the first one did would have met the same world, feedback and all.
#[derive(Clone, Debug, Default)]
pub struct Journal {
    given: Vec<u32>,
    done: Vec<u32>,
    /// Where each tick ends in the two.
    ends: Vec<(usize, usize)>,
}

impl Journal {
    /// Nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Ticks in it.
    pub fn ticks(&self) -> usize {
        self.ends.len()
    }

    /// Adds a tick.
    pub fn push(&mut self, given: &Given, done: &Done) {
        given.write(|word| self.given.push(word));
        done.write(|word| self.done.push(word));
        self.ends.push((self.given.len(), self.done.len()));
    }

    /// What the board did at each tick.
    pub fn done(&self) -> impl Iterator<Item = Done> {
        let mut words = self.done.iter().copied();
        (0..self.ticks()).map(move |_| Done::read(|| words.next().unwrap_or_default()))
    }

    /// Words of what is given in some ticks.
    #[cfg(unix)]
    pub(crate) fn given_words(&self, from_tick: usize, ticks: usize) -> &[u32] {
        self.given.get(self.end(from_tick).0..self.end(from_tick + ticks).0).unwrap_or_default()
    }

    /// Words of what was done in some ticks.
    #[cfg(unix)]
    pub(crate) fn done_words(&self, from_tick: usize, ticks: usize) -> &[u32] {
        self.done.get(self.end(from_tick).1..self.end(from_tick + ticks).1).unwrap_or_default()
    }

    /// Where the first `ticks` ticks end.
    #[cfg(unix)]
    fn end(&self, ticks: usize) -> (usize, usize) {
        ticks.checked_sub(1).and_then(|last| self.ends.get(last)).copied().unwrap_or_default()
    }
}
