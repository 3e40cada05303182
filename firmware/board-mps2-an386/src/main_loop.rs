//! The session in the main loop, between the serial port and the tick.

use cortex_m::Peripherals;
use cortex_m::singleton;
use frixel_control::{Active, Board, Order, Status, Ticker};
use frixel_drivers::serial::SerialLink;
use frixel_session::Session;
use heapless::spsc::{Consumer, Producer, Queue};

use crate::tick::{self, Monitor, Tick};
use crate::uart::{Queues, Uart};
use crate::{fault, fault_injection, shared};

/// Length of the queue of orders for the tick; the queue keeps one place free. Further orders wait in the session.
const ORDERS_LEN: usize = 5;

/// The session's ends of the queues to and from the tick.
struct MainLoop {
    session: &'static mut Session<'static>,
    orders: Producer<'static, Order<'static>>,
    spares: Consumer<'static, &'static mut Active>,
    statuses: Consumer<'static, Status>,
    serial: SerialLink<Uart>,
}

/// Starts the tick on the board's own timer, and runs the main loop with the host on the serial port.
pub fn run(
    board: &Board,
    session: &'static mut Session<'static>,
    ticker: Ticker<'static>,
    mut peripherals: Peripherals,
) -> ! {
    let (Some(orders), Some(spares), Some(statuses), Some(queues)) = (
        singleton!(: Queue<Order<'static>, ORDERS_LEN> = Queue::new()),
        singleton!(: Queue<&'static mut Active, 3> = Queue::new()),
        singleton!(: Queue<Status, 2> = Queue::new()),
        singleton!(: Queues = Queues::new()),
    ) else {
        fault::never()
    };
    let (order_producer, order_consumer) = orders.split();
    let (spare_producer, spare_consumer) = spares.split();
    let (status_producer, status_consumer) = statuses.split();
    let tick = Tick {
        ticker,
        orders: order_consumer,
        spares: spare_producer,
        statuses: status_producer,
        monitor: Monitor::new(board),
        count: 0,
    };
    tick::start(tick, board.tick_hz, peripherals.SYST);
    let serial = SerialLink::new(Uart::start(queues, &mut peripherals.NVIC));
    let mut main_loop =
        MainLoop { session, orders: order_producer, spares: spare_consumer, statuses: status_consumer, serial };
    loop {
        main_loop.once();
        fault_injection::in_main();
    }
}

impl MainLoop {
    fn once(&mut self) {
        let status = self.status();
        let Ok(()) = self.serial.receive(|bytes| self.session.receive(bytes, &status));
        if let Some(touch) = shared::touch(status.telemetry.tick) {
            self.session.touch(touch, status.telemetry.tick);
        }
        while self.orders.ready()
            && let Some(order) = self.session.next_order()
        {
            // Cannot fail: the condition of the loop ensures room.
            let _ = self.orders.enqueue(order);
        }
        while let Some(spare) = self.spares.dequeue() {
            self.session.take_back(spare);
        }
        self.session.poll(&status);
        let Ok(()) = self.serial.transmit(|bytes| self.session.transmit(bytes));
    }

    /// Requests the board's status from the next tick, and waits for it.
    ///
    /// This waits without sleep: an emulator whose processor sleeps until the next tick wakes it late, sometimes by
    /// several ticks, which the tick treats as a missed deadline.
    fn status(&mut self) -> Status {
        tick::request_status();
        loop {
            if let Some(status) = self.statuses.dequeue() {
                return status;
            }
        }
    }
}
