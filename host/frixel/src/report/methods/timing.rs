//! How long a call takes, on this computer.

use std::hint::black_box;
use std::ops::{Add, Mul};
use std::time::Instant;

/// The shortest of so many rounds counts: whatever else the computer does only makes one longer.
const ROUNDS: usize = 24;

/// A number that a chain of calls can be made of.
pub(super) trait Sample: Copy + Default {
    /// This number, computed from the last answer as well: `self + last * nothing`, where `nothing` is zero and nobody
    /// knows.
    fn behind(self, last: Self, nothing: Self) -> Self;
}

fn chained<T: Add<Output = T> + Mul<Output = T>>(this: T, last: T, nothing: T) -> T {
    this + last * nothing
}

impl Sample for f64 {
    fn behind(self, last: Self, nothing: Self) -> Self {
        chained(self, last, nothing)
    }
}

impl Sample for f32 {
    fn behind(self, last: Self, nothing: Self) -> Self {
        chained(self, last, nothing)
    }
}

impl Sample for u32 {
    fn behind(self, last: Self, nothing: Self) -> Self {
        self.wrapping_add(last.wrapping_mul(nothing))
    }
}

/// Seconds from one call's beginning to the next one's, when each waits for the last one's answer as a control loop
/// does, less the waiting itself.
pub(super) fn seconds_per_call<T: Sample>(inputs: &[T], call: impl Fn(T) -> T) -> f64 {
    let chain = shortest(inputs, call) - shortest(inputs, |x| x);
    // Clocks are too coarse to tell a call of a fraction of a nanosecond from none.
    (chain / inputs.len() as f64).max(1e-10)
}

fn shortest<T: Sample>(inputs: &[T], call: impl Fn(T) -> T) -> f64 {
    let nothing = black_box(T::default());
    let round = |_| {
        let start = Instant::now();
        let last = inputs.iter().fold(T::default(), |last, x| call(black_box(*x).behind(last, nothing)));
        black_box(last);
        start.elapsed().as_secs_f64()
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}
