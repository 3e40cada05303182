//! The main loop: the session between serial port and tick, and all that has time.

use frixel_control::{Active, Order, Status};
use frixel_drivers::serial::SerialLink;
use frixel_drivers::state_light::StateLight;
use frixel_session::Session;
#[cfg(feature = "store")]
use frixel_session::store::SceneKeeper;
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

/// Orders that may wait for the tick, one place left free. The session keeps the others.
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
pub struct Talk {
    /// Its ends of the queues.
    pub ends: Ends,
    /// The host's partner.
    pub session: &'static mut Session<'static>,
    /// What the tick said last.
    pub status: Status,
    /// The host's line.
    pub serial: SerialLink<Serial>,
    /// The DAC, while the board is not armed.
    pub dac: Dac,
    /// The light that shows the state.
    pub light: StateLight<Pin>,
    #[cfg(feature = "store")]
    /// The last scene, and where it is kept; `None` without a bank for it.
    pub store: Option<(SceneKeeper, BankTwo)>,
    /// Resets when this loop stands still.
    pub watchdog: Watchdog,
}

impl Talk {
    /// Runs for ever.
    pub fn run(mut self, #[cfg(feature = "optical-frame")] mut touch_source: OpticalFrame<'_>) -> ! {
        tick::want_status();
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
            if let Some((keeper, flash)) = &mut self.store {
                keeper.step(flash, self.session, now_tick);
            }
            self.light.show(self.status.telemetry.state, now_tick);
            self.watchdog.feed();
        }
    }

    /// Takes a status, as soon as there is a new one.
    fn follow_status(&mut self) {
        if let Some(status) = self.ends.statuses.dequeue() {
            log_change(&self.status, &status);
            self.status = status;
            tick::want_status();
            // An order to arm may be on its way behind this status.
            let disarmed = [self.status.telemetry.state, self.session.state()] == [State::Disarmed; 2];
            self.watchdog.freeze_with_debugger(disarmed);
            clock::keep_timers_running_in_debug();
        }
    }

    /// Hands orders to the tick, as many as there is room for, and takes back the coefficients that the tick no longer uses.
    fn hand_over(&mut self) {
        while self.ends.orders.ready()
            && let Some(order) = self.session.next_order()
        {
            if matches!(order, Order::Arm) {
                self.watchdog.freeze_with_debugger(false);
                arming::prepare(&mut self.dac);
            }
            // There is room: the condition of the loop says so.
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
