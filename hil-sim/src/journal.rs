//! A journal: everything that crossed a board's pins, tick by tick.

use frixel_exchange::{TickInput, TickOutput};

/// Input and output of a board at each of its first ticks, as words of [`frixel_exchange`].
///
/// [`Rig::start_journal`](crate::Rig::start_journal) begins one. Played to another board, it tells whether the two are
/// the same: a board that does at every tick what the first one did would have met the same world, feedback and all.
#[derive(Clone, Debug, Default)]
pub struct Journal {
    inputs: Vec<u32>,
    outputs: Vec<u32>,
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
    pub fn push(&mut self, input: &TickInput, output: &TickOutput) {
        input.write(|word| self.inputs.push(word));
        output.write(|word| self.outputs.push(word));
        self.ends.push((self.inputs.len(), self.outputs.len()));
    }

    /// What the board did at each tick.
    pub fn outputs(&self) -> impl Iterator<Item = TickOutput> {
        let mut words = self.outputs.iter().copied();
        (0..self.ticks()).map(move |_| TickOutput::read(|| words.next().unwrap_or_default()))
    }

    /// Words of the inputs of some ticks.
    #[cfg(unix)]
    pub(crate) fn input_words(&self, from_tick: usize, ticks: usize) -> &[u32] {
        self.inputs.get(self.end(from_tick).0..self.end(from_tick + ticks).0).unwrap_or_default()
    }

    /// Words of the outputs of some ticks.
    #[cfg(unix)]
    pub(crate) fn output_words(&self, from_tick: usize, ticks: usize) -> &[u32] {
        self.outputs.get(self.end(from_tick).1..self.end(from_tick + ticks).1).unwrap_or_default()
    }

    /// Where the first `ticks` ticks end.
    #[cfg(unix)]
    fn end(&self, ticks: usize) -> (usize, usize) {
        ticks.checked_sub(1).and_then(|last| self.ends.get(last)).copied().unwrap_or_default()
    }
}
