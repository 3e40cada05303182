//! The queues between a session in a board's main loop and a ticker in its interrupt.

use frixel_control::{Active, Order, Status, Ticker};
use heapless::spsc::{Consumer, Producer, Queue};

use crate::Session;

/// Length of the queue of orders, of which one place stays free. Further orders wait in the session.
const ORDERS_LEN: usize = 5;

/// Memory of the queues.
#[derive(Default)]
pub struct Queues {
    orders: Queue<Order<'static>, ORDERS_LEN>,
    spares: Queue<&'static mut Active, 3>,
    statuses: Queue<Status, 2>,
}

/// The main loop's ends of the queues.
pub struct SessionEnds {
    orders: Producer<'static, Order<'static>>,
    spares: Consumer<'static, &'static mut Active>,
    statuses: Consumer<'static, Status>,
}

/// The interrupt's ends of the queues.
pub struct TickEnds {
    orders: Consumer<'static, Order<'static>>,
    spares: Producer<'static, &'static mut Active>,
    statuses: Producer<'static, Status>,
}

impl Queues {
    /// Empty queues.
    pub const fn new() -> Self {
        Self { orders: Queue::new(), spares: Queue::new(), statuses: Queue::new() }
    }

    /// Both ends.
    pub fn split(&'static mut self) -> (SessionEnds, TickEnds) {
        let (orders, orders_out) = self.orders.split();
        let (spares_in, spares) = self.spares.split();
        let (statuses_in, statuses) = self.statuses.split();
        let tick_ends = TickEnds { orders: orders_out, spares: spares_in, statuses: statuses_in };
        (SessionEnds { orders, spares, statuses }, tick_ends)
    }
}

impl SessionEnds {
    /// The ticker's status after the first tick since the last returned status; `None` until that tick has run.
    pub fn next_status(&mut self) -> Option<Status> {
        self.statuses.dequeue()
    }

    /// Passes the session's orders to the ticker while there is room, and returns unused coefficients of the ticker to
    /// the session. `prepare` sees each order before the ticker does.
    pub fn exchange(&mut self, session: &mut Session<'static>, mut prepare: impl FnMut(&Order<'static>)) {
        while self.orders.ready()
            && let Some(order) = session.next_order()
        {
            prepare(&order);
            // Cannot fail: the condition of the loop ensures room.
            let _ = self.orders.enqueue(order);
        }
        while let Some(spare) = self.spares.dequeue() {
            session.take_back(spare);
        }
    }
}

impl TickEnds {
    /// Whether an order waits for the next tick.
    #[inline]
    pub fn has_order(&self) -> bool {
        self.orders.ready()
    }

    /// Applies the next order, if there is one. Call this once before each tick.
    #[inline]
    pub fn apply_order(&mut self, ticker: &mut Ticker<'static>) {
        if let Some(order) = self.orders.dequeue()
            && let Some(spare) = ticker.apply(order)
        {
            // Cannot fail: there are two buffers, and room for both.
            let _ = self.spares.enqueue(spare);
        }
    }

    /// Passes on the ticker's status if the session has taken the previous one. Call this after each tick.
    #[inline]
    pub fn offer_status(&mut self, ticker: &Ticker<'static>) {
        if self.statuses.ready() {
            // Cannot fail: there is room.
            let _ = self.statuses.enqueue(ticker.status());
        }
    }
}
