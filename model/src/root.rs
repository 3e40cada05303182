//! Bracketed root-finding with a proven bound on the number of steps.

use crate::Real;

/// Number of Newton steps before every second step halves the bracket instead.
const TRUSTED_STEPS: u32 = 12;
/// Maximum number of steps. There are fewer than 2^63 numbers between two numbers of zero or more, and after the
/// trusted steps, every second step at least halves their number.
const STEPS: u32 = TRUSTED_STEPS + 2 * 64 + 2;

/// One evaluation of the function: its sign, and Newton's next point.
pub(crate) struct Step<T> {
    /// Negative to the left of the root, positive to the right of it.
    pub(crate) residual: T,
    /// Newton's next point. It is evaluated if it is inside the bracket, and returned as the root if it equals the
    /// current point within rounding.
    pub(crate) next: T,
}

/// The function returned NaN, or the step limit was reached.
#[derive(Debug, PartialEq)]
pub(crate) struct NotConverged;

/// The root of a function that rises through zero between `low >= 0` and `high`, within the rounding of `step`.
///
/// Takes at most 142 evaluations; five or six where Newton's method converges well.
pub(crate) fn rising_root<T: Real>(low: T, high: T, start: T, step: impl Fn(T) -> Step<T>) -> Result<T, NotConverged> {
    let (mut low, mut high) = (low, high);
    let mut x = start.max(low).min(high);
    for count in 0..STEPS {
        let Step { residual, next } = step(x);
        if residual < T::ZERO {
            low = x;
        } else if residual > T::ZERO {
            high = x;
        } else if residual == T::ZERO {
            return Ok(x);
        } else {
            return Err(NotConverged);
        }
        if (next - x).abs() <= T::EPSILON * x {
            return Ok(next);
        }
        let inside = next > low && next < high;
        let (bottom, top) = (low.to_rank(), high.to_rank());
        if top.saturating_sub(bottom) <= 1 {
            return Ok(x);
        }
        let halve = !inside || (count >= TRUSTED_STEPS && count % 2 == 0);
        x = if halve { T::from_rank(bottom + (top - bottom) / 2) } else { next };
    }
    Err(NotConverged)
}

#[cfg(test)]
mod tests {
    use core::cell::Cell;

    use super::*;

    /// The root of `step`, and the number of evaluations.
    fn counted(low: f64, high: f64, step: impl Fn(f64) -> Step<f64>) -> (Result<f64, NotConverged>, u32) {
        let count = Cell::new(0);
        let root = rising_root(low, high, high, |x| {
            count.set(count.get() + 1);
            step(x)
        });
        (root, count.get())
    }

    #[test]
    fn newton_takes_a_few_steps() {
        let (root, count) = counted(0.0, 4.0, |x| Step { residual: x * x - 2.0, next: x - (x * x - 2.0) / (2.0 * x) });
        assert!((root.unwrap() - core::f64::consts::SQRT_2).abs() <= f64::EPSILON);
        assert!(count <= 8, "{count}");
    }

    /// The bound on the steps holds for any Newton proposal: outside the bracket, not-a-number, or slow progress
    /// inside.
    #[test]
    fn bad_proposals_are_bisected_within_the_bound() {
        let proposals: [fn(f64) -> f64; 5] = [|_| -1.0, |_| f64::NAN, |x| x * (1.0 - 1e-9), |x| x * 0.999, |x| x * 2.0];
        for (low, high) in [(0.0, f64::MAX), (1e-200, 1e200), (0.0, 3.0)] {
            for next in proposals {
                for target in [1e-150, 1.0, 2.5] {
                    let (root, count) = counted(low, high, |x| Step { residual: x - target, next: next(x) });
                    let root = root.unwrap();
                    assert!((root / target - 1.0).abs() <= 1e-15, "{root} for {target}");
                    assert!(count <= STEPS, "{count} steps to {target}");
                }
            }
        }
    }

    #[test]
    fn not_a_number_is_no_root() {
        let (root, count) = counted(0.0, 1.0, |x| Step { residual: f64::NAN, next: x });
        assert_eq!((root, count), (Err(NotConverged), 1));
    }
}
