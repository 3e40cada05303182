//! The main loop: runs the session between serial port and tick, and all work that is not urgent.

use frixel_control::{Order, Status};
use frixel_drivers::serial::BufferedSerial;
use frixel_drivers::state_light::StateLight;
use frixel_session::{Session, SessionEnds, Touch};
use frixel_wire::fault::{Fault, State};

use crate::hardware::{Dac, Hardware, Watchdog};
use crate::tick::TickShared;

/// Everything that runs in the main loop.
pub struct MainLoop<H: Hardware> {
    /// Data shared with the tick.
    pub shared: &'static TickShared,
    /// Its ends of the queues between it and the tick.
    pub queues: SessionEnds,
    /// The session with the host.
    pub session: &'static mut Session<'static>,
    /// The last status from the tick.
    pub status: Status,
    /// The serial link to the host; `None` if the host is on the board, as in bring-up.
    pub serial: Option<BufferedSerial<H::Serial>>,
    /// The DAC, for use while its frames are paused.
    pub dac: H::Dac,
    /// The light that shows the state.
    pub light: StateLight<H::Light>,
    /// Resets the processor if this loop or the tick stops.
    pub watchdog: H::Watchdog,
}

impl<H: Hardware> MainLoop<H> {
    /// Runs the loop forever, with the board's own touch source, which returns a report if it has one.
    #[inline]
    pub fn run(mut self, mut next_touch: impl FnMut() -> Option<Touch>) -> ! {
        loop {
            self.turn(next_touch());
        }
    }

    /// Runs the loop once; call this repeatedly. `touch` is a report of the board's own touch source.
    #[inline]
    pub fn turn(&mut self, touch: Option<Touch>) {
        self.follow_status();
        if let Some(serial) = &mut self.serial {
            let (session, status) = (&mut self.session, &self.status);
            // A failing port is a silent host, whose timeout acts.
            let _ = serial.receive(|bytes| session.receive(bytes, status));
        }
        if let Some(touch) = touch {
            self.session.touch(touch, self.shared.count());
        }
        self.exchange();
        self.session.poll(&self.status);
        if let Some(serial) = &mut self.serial {
            let _ = serial.transmit(|bytes| self.session.transmit(bytes));
        }
        self.light.show(self.status.telemetry.state, self.shared.count());
    }

    /// Takes a new status, if there is one, and only then feeds the watchdog: a stopped tick sends none.
    fn follow_status(&mut self) {
        let Some(status) = self.queues.next_status() else { return };
        log_change(&self.status, &status);
        self.status = status;
        // An order to arm may still be queued after this status.
        let is_disarmed = [self.status.telemetry.state, self.session.state()] == [State::Disarmed; 2];
        self.watchdog.let_debugger_stop_it(is_disarmed);
        self.watchdog.feed();
    }

    /// Passes orders to the tick, and takes back unused coefficients.
    fn exchange(&mut self) {
        let Self { queues, session, dac, watchdog, shared, .. } = self;
        queues.exchange(session, |order| {
            if matches!(order, Order::Arm) {
                watchdog.let_debugger_stop_it(false);
            }
            check_dac_before::<H>(order, dac, shared);
        });
    }
}

/// Checks the DAC before an order reaches the ticker: configures it and reads it back before [`Order::Arm`], and reads
/// it back before [`Order::Play`], so that a DAC whose supply dipped while the board was armed is not driven. On a
/// wrong configuration, this raises [`Fault::Dac`], which the order does not clear.
///
/// The tick sends no frames meanwhile; the output is zero and the amplifier disabled. On the NUCLEO it takes about 0.2
/// ms, up to five frames and the handover; if a stop is in progress, it begins once the output is zero. It waits for
/// the tick without limit: without ticks, the watchdog resets the board.
fn check_dac_before<H: Hardware>(order: &Order, dac: &mut H::Dac, shared: &TickShared) {
    let configures = match order {
        Order::Arm => true,
        Order::Play => false,
        _ => return,
    };
    let work = || if configures { dac.prepare() } else { dac.check() };
    if let Err(detail) = shared.bus.while_frames_rest(H::wait_for_tick, work) {
        log_dac(detail);
        shared.raise(Fault::Dac, detail);
    }
}

#[cfg(feature = "defmt")]
fn log_change(before: &Status, after: &Status) {
    let (from, to) = (before.telemetry.state, after.telemetry.state);
    if from != to {
        let (fault, detail) = after.fault.map_or((0, 0), |(fault, detail)| (fault.number(), detail));
        defmt::info!("state {=u8} to {=u8}, last fault {=u8}, {=u32:#x}", from.number(), to.number(), fault, detail);
    }
}

#[cfg(not(feature = "defmt"))]
fn log_change(_: &Status, _: &Status) {}

#[cfg(feature = "defmt")]
fn log_dac(detail: u32) {
    defmt::error!("the DAC is not ready: detail {=u32:#x}", detail);
}

#[cfg(not(feature = "defmt"))]
fn log_dac(_: u32) {}
