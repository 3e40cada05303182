//! The orders that wait for the ticker.

use frixel_control::Order;
use frixel_wire::message::Refusal;
use heapless::Deque;

/// Largest number of waiting orders. A command is refused as busy if there is no room.
const ORDERS_MAX: usize = 8;
/// Places reserved for Stop and Disarm, which are thus never refused for lack of room.
const ORDERS_RESERVED: usize = 2;

/// The waiting orders for the ticker, except orders of the finger and signs of life.
pub(crate) struct Orders<'a> {
    waiting: Deque<Order<'a>, ORDERS_MAX>,
    /// Orders since power-on, modulo 2^32.
    sent: u32,
}

impl<'a> Orders<'a> {
    pub(super) const fn new() -> Self {
        Self { waiting: Deque::new(), sent: 0 }
    }

    /// Orders since power-on, modulo 2^32, as [`Status::orders_applied`](frixel_control::Status) counts them.
    pub(super) fn sent(&self) -> u32 {
        self.sent
    }

    /// Refuses if there is no room for another order, not counting the room reserved for Stop and Disarm.
    pub(crate) fn check_room(&self) -> Result<(), Refusal> {
        if self.waiting.len() + ORDERS_RESERVED >= ORDERS_MAX { Err(Refusal::Busy) } else { Ok(()) }
    }

    #[inline(never)]
    pub(crate) fn send(&mut self, order: Order<'a>) -> Result<(), Refusal> {
        if !matches!(order, Order::Stop | Order::Disarm) {
            self.check_room()?;
        }
        self.waiting.push_back(order).map_err(|_| Refusal::Busy)?;
        self.sent = self.sent.wrapping_add(1);
        Ok(())
    }

    /// Whether the newest waiting order is a Disarm.
    pub(super) fn ends_with_disarm(&self) -> bool {
        matches!(self.waiting.back(), Some(Order::Disarm))
    }

    pub(super) fn next(&mut self) -> Option<Order<'a>> {
        self.waiting.pop_front()
    }
}
