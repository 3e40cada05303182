//! Replacement for streams in a firmware without the feature `stream`; takes no space.

use core::marker::PhantomData;

use frixel_control::Order;

/// Never used: no progress is reported.
pub(crate) const PROGRESS_PERIOD_S: f32 = 0.0;

/// Takes no samples.
pub(crate) struct Stream<'a>(PhantomData<Order<'a>>);

#[allow(clippy::unused_self, reason = "the interface of a stream")]
impl<'a> Stream<'a> {
    pub(super) const fn new() -> Self {
        Self(PhantomData)
    }

    pub(crate) fn is_attached(&self) -> bool {
        false
    }

    pub(super) fn start(&mut self, _: u32, _: u32, _: u16) -> Option<Order<'a>> {
        None
    }

    pub(crate) fn end(&mut self) -> Option<Order<'a>> {
        None
    }

    pub(crate) fn take(&mut self, _: u32, _: &[[u8; 2]]) {}

    pub(crate) fn progress_due(&self, _: u32, _: u32) -> Option<(u32, u16)> {
        None
    }

    pub(crate) fn reported(&mut self, _: u32) {}
}
