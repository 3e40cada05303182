//! Measurement of the time per call on this computer.

use std::hint::black_box;
use std::ops::{Add, Mul};
use std::time::Instant;

/// Number of measurements. The shortest counts, since other load on the computer only lengthens a measurement.
const ROUNDS: usize = 24;

/// A number type whose calls can be chained, so that each call depends on the result of the previous one.
pub(super) trait Sample: Copy + Default + Add<Output = Self> + Mul<Output = Self> {}

impl<T: Copy + Default + Add<Output = T> + Mul<Output = T>> Sample for T {}

/// Seconds per call when each call waits for the result of the previous one, as in a control loop. The time of the
/// chain itself is subtracted.
pub(super) fn seconds_per_call<T: Sample>(inputs: &[T], call: impl Fn(T) -> T) -> f64 {
    let chain = shortest(inputs, call) - shortest(inputs, |x| x);
    // Clocks cannot resolve a call of a fraction of a nanosecond.
    (chain / inputs.len() as f64).max(1e-10)
}

fn shortest<T: Sample>(inputs: &[T], call: impl Fn(T) -> T) -> f64 {
    // Zero, hidden from the compiler.
    let zero = black_box(T::default());
    let round = |_| {
        let start = Instant::now();
        let last = inputs.iter().fold(T::default(), |last, x| call(black_box(*x) + last * zero));
        black_box(last);
        start.elapsed().as_secs_f64()
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}
