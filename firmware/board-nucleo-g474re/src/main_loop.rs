//! The main loop: runs the session between serial port and tick, and all work that is not urgent.

use frixel_control::{Active, Order, Status};
use frixel_drivers::serial::SerialLink;
use frixel_drivers::state_light::StateLight;
use frixel_session::Session;
#[cfg(feature = "store")]
use frixel_session::store::SceneStore;
use frixel_wire::fault::State;
use heapless::spsc::{Consumer, Producer, Queue};

use crate::dac::Dac;
#[cfg(feature = "store")]
use crate::flash::BankTwo;
#[cfg(feature = "optical-frame")]
use crate::optical_frame::OpticalFrame;
use crate::pins::Pin;
use crate::serial::Serial;
use crate::tick::{self, Queues};
use crate::watchdog::Watchdog;
use crate::{arming, clock};

/// Length of the queue of orders for the tick; the queue keeps one place free. Further orders wait in the session.
const ORDERS_LEN: usize = 5;

/// The main loop's ends of the queues.
pub struct Ends {
    orders: Producer<'static, Order<'static>>,
    spares: Consumer<'static, &'static mut Active>,
    statuses: Consumer<'static, Status>,
}

/// The queues between main loop and tick.
pub struct QueuePairs {
    orders: Queue<Order<'static>, ORDERS_LEN>,
    spares: Queue<&'static mut Active, 3>,
    statuses: Queue<Status, 2>,
}

impl QueuePairs {
    /// Empty queues.
    pub const fn new() -> Self {
        Self { orders: Queue::new(), spares: Queue::new(), statuses: Queue::new() }
    }

    /// The main loop's ends, and the tick's.
    pub fn split(&'static mut self) -> (Ends, Queues) {
        let (orders, orders_end) = self.orders.split();
        let (spares_end, spares) = self.spares.split();
        let (statuses_end, statuses) = self.statuses.split();
        (Ends { orders, spares, statuses }, Queues { orders: orders_end, spares: spares_end, statuses: statuses_end })
    }
}

/// All that runs in the main loop.
pub struct MainLoop {
    /// Its ends of the queues.
    pub ends: Ends,
    /// The session with the host.
    pub session: &'static mut Session<'static>,
    /// The last status from the tick.
    pub status: Status,
    /// The serial link to the host.
    pub serial: SerialLink<Serial>,
    /// The DAC, while the board is not armed.
    pub dac: Dac,
    /// The light that shows the state.
    pub light: StateLight<Pin>,
    #[cfg(feature = "store")]
    /// The last scene and its storage; `None` without a usable flash bank.
    pub store: Option<(SceneStore, BankTwo)>,
    /// Resets the processor when this loop stops.
    pub watchdog: Watchdog,
}

impl MainLoop {
    /// Runs the loop for ever.
    pub fn run(mut self, #[cfg(feature = "optical-frame")] mut touch_source: OpticalFrame<'_>) -> ! {
        tick::request_status();
        loop {
            self.follow_status();
            let (serial, session, status) = (&mut self.serial, &mut self.session, &self.status);
            let Ok(()) = serial.receive(|bytes| session.receive(bytes, status));
            #[cfg(feature = "optical-frame")]
            if let Some(touch) = touch_source.next_touch() {
                self.session.touch(touch, tick::count());
            }
            self.hand_over();
            self.session.poll(&self.status);
            let Ok(()) = self.serial.transmit(|bytes| self.session.transmit(bytes));
            let now_tick = tick::count();
            #[cfg(feature = "store")]
            if let Some((store, flash)) = &mut self.store {
                store.step(flash, self.session, now_tick);
            }
            self.light.show(self.status.telemetry.state, now_tick);
            self.watchdog.feed();
        }
    }

    /// Takes a new status, if there is one.
    fn follow_status(&mut self) {
        if let Some(status) = self.ends.statuses.dequeue() {
            log_change(&self.status, &status);
            self.status = status;
            tick::request_status();
            // An order to arm may still be queued behind this status.
            let disarmed = [self.status.telemetry.state, self.session.state()] == [State::Disarmed; 2];
            self.watchdog.freeze_with_debugger(disarmed);
            clock::keep_timers_running_in_debug();
        }
    }

    /// Passes orders to the tick while there is room, and takes back the coefficients that the tick no longer uses.
    fn hand_over(&mut self) {
        while self.ends.orders.ready()
            && let Some(order) = self.session.next_order()
        {
            if matches!(order, Order::Arm) {
                self.watchdog.freeze_with_debugger(false);
                arming::prepare(&mut self.dac);
            }
            // Cannot fail: the condition of the loop ensures room.
            let _ = self.ends.orders.enqueue(order);
        }
        while let Some(spare) = self.ends.spares.dequeue() {
            self.session.take_back(spare);
        }
    }
}

#[cfg(feature = "log")]
fn log_change(before: &Status, after: &Status) {
    let (from, to) = (before.telemetry.state, after.telemetry.state);
    if from != to {
        let (fault, detail) = after.fault.map_or((0, 0), |(fault, detail)| (fault.number(), detail));
        defmt::info!("state {=u8} to {=u8}, last fault {=u8}, {=u32:#x}", from.number(), to.number(), fault, detail);
    }
}

#[cfg(not(feature = "log"))]
fn log_change(_: &Status, _: &Status) {}
