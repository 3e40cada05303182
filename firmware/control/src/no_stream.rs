//! Replacement for streams in a firmware without the feature `stream`: its player takes no space.

use core::marker::PhantomData;

use frixel_layers::StreamSample;

/// Plays nothing.
pub(crate) struct Player<'a>(PhantomData<&'a ()>);

#[allow(clippy::unused_self, reason = "the interface of a player that plays")]
impl Player<'_> {
    pub(crate) fn new(_: f32) -> Self {
        Self(PhantomData)
    }

    pub(crate) fn stop(&mut self, _: &mut StreamSample) {}

    pub(crate) fn is_dry(&self) -> bool {
        false
    }

    pub(crate) fn counts(&self) -> (u32, u32) {
        (0, 0)
    }

    #[inline]
    pub(crate) fn advance(&mut self, _: &mut StreamSample) {}
}
