//! What the host streams.

use frixel_wire::scene::Blend;

use super::Around;

/// `low + span` times the stream's sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Streamed {
    low_n: f32,
    span_n: f32,
}

impl Streamed {
    pub(super) fn new(low_n: f32, high_n: f32) -> Self {
        Self { low_n, span_n: high_n - low_n }
    }

    #[inline(never)]
    pub(super) fn electric_friction_n(&self, around: &Around) -> f32 {
        self.low_n + self.span_n * around.moment.stream.value
    }
}

/// Blends a layer that is there by the stream's weight, from 0 to 1.
#[inline(never)]
pub(super) fn fading(blend: Blend, below_n: f32, own_n: f32, around: &Around) -> f32 {
    let blended_n = match blend {
        Blend::Replace => own_n,
        Blend::Add => below_n + own_n,
        Blend::Multiply => below_n * own_n,
        Blend::Max => own_n.max(below_n),
    };
    below_n + around.moment.stream.weight * (blended_n - below_n)
}
