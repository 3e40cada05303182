//! Bracketed root-finding with a proven bound on its steps.

use crate::Real;

/// Newton steps taken on trust before every other step halves the bracket.
const TRUSTED_STEPS: u32 = 12;
/// No more than this: a bracket of floats has fewer than 2^64 members, and every second step after the trusted ones
/// leaves at most half of them.
const STEPS: u32 = TRUSTED_STEPS + 2 * 64 + 2;

/// One evaluation: on which side of the root, and where to look next.
pub(crate) struct Step<T> {
    /// Below zero left of the root, above zero right of it.
    pub(crate) residual: T,
    /// Newton's next point. It is tried when it falls into the bracket.
    pub(crate) next: T,
}

/// The root-finder met a not-a-number.
#[derive(Debug, PartialEq)]
pub(crate) struct NotConverged;

/// The root of a function that rises through zero between `low >= 0` and `high`, within the rounding of `step`.
///
/// At most 142 evaluations; five or six where Newton's method does well.
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
