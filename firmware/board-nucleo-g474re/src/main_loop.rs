//! The main loop: runs the session between serial port and tick, and all work that is not urgent.

use frixel_control::{Order, Status};
use frixel_drivers::serial::SerialLink;
use frixel_drivers::state_light::StateLight;
#[cfg(feature = "store")]
use frixel_session::store::SceneStore;
use frixel_session::{Session, SessionEnds, Touch};
use frixel_wire::fault::State;

use crate::dac::Dac;
#[cfg(feature = "store")]
use crate::flash::BankTwo;
#[cfg(feature = "optical-frame")]
use crate::optical_frame::OpticalFrame;
use crate::pins::Pin;
use crate::serial::Serial;
use crate::tick;
use crate::watchdog::Watchdog;
use crate::{arming, clock, fault};

/// All that runs in the main loop.
pub struct MainLoop {
    /// Its ends of the queues between it and the tick.
    pub tick: SessionEnds,
    /// The session with the host.
    pub session: &'static mut Session<'static>,
    /// The last status from the tick.
    pub status: Status,
    /// The serial link to the host; `None` when the host is on the board, as in bring-up.
    pub serial: Option<SerialLink<Serial>>,
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
        loop {
            #[cfg(feature = "optical-frame")]
            let touch = touch_source.next_touch();
            #[cfg(not(feature = "optical-frame"))]
            let touch = None;
            self.turn(touch);
        }
    }

    /// Runs the loop once. `touch` is a report of the board's own touch source.
    #[inline]
    pub fn turn(&mut self, touch: Option<Touch>) {
        self.follow_status();
        if let Some(serial) = &mut self.serial {
            let (session, status) = (&mut self.session, &self.status);
            let Ok(()) = serial.receive(|bytes| session.receive(bytes, status));
        }
        if let Some(touch) = touch {
            self.session.touch(touch, tick::count());
        }
        self.exchange();
        self.session.poll(&self.status);
        if let Some(serial) = &mut self.serial {
            let Ok(()) = serial.transmit(|bytes| self.session.transmit(bytes));
        }
        let now_tick = tick::count();
        #[cfg(feature = "store")]
        if let Some((store, flash)) = &mut self.store {
            store.step(flash, self.session, now_tick);
        }
        self.light.show(self.status.telemetry.state, now_tick);
        fault::has_run_for(now_tick);
        self.watchdog.feed();
    }

    /// Takes a new status, if there is one.
    fn follow_status(&mut self) {
        if let Some(status) = self.tick.next_status() {
            log_change(&self.status, &status);
            self.status = status;
            // An order to arm may still be queued behind this status.
            let disarmed = [self.status.telemetry.state, self.session.state()] == [State::Disarmed; 2];
            self.watchdog.freeze_with_debugger(disarmed);
            clock::keep_timers_running_in_debug();
        }
    }

    /// Passes orders to the tick, and takes back the coefficients that the tick no longer uses.
    fn exchange(&mut self) {
        let (watchdog, dac) = (&mut self.watchdog, &mut self.dac);
        self.tick.exchange(self.session, |order| {
            if matches!(order, Order::Arm) {
                watchdog.freeze_with_debugger(false);
            }
            arming::check_before(order, dac);
        });
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
