//! A journal: all input and output of a board, tick by tick.

use frixel_exchange::{TickInput, TickOutput};

/// Input and output of a board at each of its first ticks, as words of [`frixel_exchange`].
///
/// [`Rig::start_journal`](crate::Rig::start_journal) starts one. Replay its inputs on another board and compare the
/// outputs to check whether both boards behave identically. The inputs stay valid as long as the outputs are equal,
/// since the world would have responded identically.
#[derive(Clone, Debug, Default)]
pub struct Journal {
    inputs: Vec<u32>,
    outputs: Vec<u32>,
    /// The end of each tick in the input words and in the output words.
    ends: Vec<(usize, usize)>,
}

impl Journal {
    /// An empty journal.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of ticks.
    pub fn ticks(&self) -> usize {
        self.ends.len()
    }

    /// Appends a tick.
    pub fn push(&mut self, input: &TickInput, output: &TickOutput) {
        input.write(|word| self.inputs.push(word));
        output.write(|word| self.outputs.push(word));
        self.ends.push((self.inputs.len(), self.outputs.len()));
    }

    /// Iterates over the board's output at each tick.
    pub fn outputs(&self) -> impl Iterator<Item = TickOutput> {
        let mut words = self.outputs.iter().copied();
        (0..self.ticks()).map(move |_| TickOutput::read(|| words.next().unwrap_or_default()))
    }

    /// Returns the input words of a range of ticks.
    #[cfg(unix)]
    pub(crate) fn input_words(&self, from_tick: usize, ticks: usize) -> &[u32] {
        self.inputs.get(self.end(from_tick).0..self.end(from_tick + ticks).0).unwrap_or_default()
    }

    /// Returns the output words of a range of ticks.
    #[cfg(unix)]
    pub(crate) fn output_words(&self, from_tick: usize, ticks: usize) -> &[u32] {
        self.outputs.get(self.end(from_tick).1..self.end(from_tick + ticks).1).unwrap_or_default()
    }

    /// Returns where the first `ticks` ticks end.
    #[cfg(unix)]
    fn end(&self, ticks: usize) -> (usize, usize) {
        ticks.checked_sub(1).and_then(|last| self.ends.get(last)).copied().unwrap_or_default()
    }
}
