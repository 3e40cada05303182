//! The session in the main loop, between the serial port and the tick.

use cortex_m::Peripherals;
use cortex_m::singleton;
use frixel_control::{Board, Status, Ticker};
use frixel_drivers::serial::SerialLink;
use frixel_session::{Queues, Session, SessionEnds};
use frixel_testkit::IdealMonitor;

use crate::tick::{self, HostWait, Tick};
use crate::uart::{self, Uart};
use crate::{fault, fault_injection, shared};

/// The session between the host and the tick.
struct MainLoop {
    session: &'static mut Session<'static>,
    tick: SessionEnds,
    serial: SerialLink<Uart>,
}

/// Starts the tick on the board's own timer, and runs the main loop with the host on the serial port.
pub fn run(
    board: &Board,
    session: &'static mut Session<'static>,
    ticker: Ticker<'static>,
    mut peripherals: Peripherals,
) -> ! {
    let (Some(queues), Some(bytes)) =
        (singleton!(: Queues = Queues::new()), singleton!(: uart::Queues = uart::Queues::new()))
    else {
        fault::never()
    };
    let (session_ends, tick_ends) = queues.split();
    let tick = Tick {
        ticker,
        queues: tick_ends,
        monitor: IdealMonitor::new(
            board.limits.full_scale_v_peak,
            board.amplifier.time_constant_s / board.tick_period_s(),
        ),
        count: 0,
        host_wait: HostWait::default(),
    };
    tick::start(tick, board.tick_hz, peripherals.SYST);
    let serial = SerialLink::new(Uart::start(bytes, &mut peripherals.NVIC));
    let mut main_loop = MainLoop { session, tick: session_ends, serial };
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
        self.tick.exchange(self.session, |_| {});
        self.session.poll(&status);
        let Ok(()) = self.serial.transmit(|bytes| self.session.transmit(bytes));
    }

    /// Waits for the status of the next tick.
    ///
    /// This waits without sleep: an emulator whose processor sleeps until the next tick wakes it late, sometimes by
    /// several ticks, which the tick treats as a missed deadline.
    fn status(&mut self) -> Status {
        // The status in the queue is that of a past tick.
        self.tick.next_status();
        loop {
            if let Some(status) = self.tick.next_status() {
                return status;
            }
        }
    }
}
