//! Blending of a layer with the layers below.

use crate::interval::{Interval, Number};

/// How a layer is combined with the layers below.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// Replaces them.
    #[default]
    Replace,
    /// Adds to them.
    Add,
    /// Multiplies them: its numbers are dimensionless factors.
    Multiply,
    /// Uses the larger of the two values.
    Max,
}

impl Blend {
    /// The number in records.
    pub(crate) const fn number(self) -> u8 {
        match self {
            Self::Replace => 0,
            Self::Add => 1,
            Self::Multiply => 2,
            Self::Max => 3,
        }
    }

    pub(crate) const fn from_number(number: u8) -> Option<Self> {
        match number {
            0 => Some(Self::Replace),
            1 => Some(Self::Add),
            2 => Some(Self::Multiply),
            3 => Some(Self::Max),
            _ => None,
        }
    }

    /// Combines a layer's friction with that of the layers below.
    #[inline]
    pub(crate) fn of(self, below_n: f32, own_n: f32) -> f32 {
        match self {
            Self::Replace => own_n,
            Self::Add => below_n + own_n,
            Self::Multiply => below_n * own_n,
            Self::Max => {
                if own_n > below_n {
                    own_n
                } else {
                    below_n
                }
            }
        }
    }

    /// The interval after a layer is blended over the layers below. Unless the layer `always` acts, the interval below
    /// is included.
    pub fn of_intervals<T: Number>(self, below: Interval<T>, own: Interval<T>, always: bool) -> Interval<T> {
        let blended = match self {
            Self::Replace => own,
            Self::Add => below.plus(own),
            Self::Multiply => below.times(own),
            Self::Max => below.max(own),
        };
        if always { blended } else { below.hull(blended) }
    }
}
