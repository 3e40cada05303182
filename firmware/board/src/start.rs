//! The start of a board with any processor: the description in its hello, and the assembly of tick and main loop from
//! the board's parts.
//!
//! A board starts in this order, as shown by its `main`:
//!
//! 1. the output is set to zero, before anything else;
//! 2. the stack is guarded, and the cause of the last reset is read and logged;
//! 3. the clocks, and the enable behind its one-shot;
//! 4. [`prepare`] configures the DAC, which has the settings of the last start until then. It therefore precedes the
//!    search of the flash, which takes up to 0.2 s;
//! 5. [`describe`] reads the stored limits;
//! 6. [`Parts::start`] starts the tick, and the watchdog last, because only the main loop feeds it.

use frixel_control::Board;
use frixel_drivers::amplifier::Amplifier;
use frixel_drivers::arm_switch::ArmSwitch;
use frixel_drivers::serial::BufferedSerial;
use frixel_drivers::state_light::StateLight;
use frixel_session::store::{CeilingPolicy, Flash, Slot, load_limits};

use crate::fault::LastReset;
use crate::hardware::{Dac, Hardware};
use crate::main_loop::MainLoop;
use crate::memory::BoardParts;
use crate::tick::{Tick, TickShared};

/// Location of the stored limits: the first pages of the flash for stores.
pub const LIMITS_SLOT: Slot = Slot { first_page: 0 };

/// Configures the DAC and reads it back. A missing DAC is not a fault yet, since it is checked again before the board
/// arms.
pub fn prepare(dac: &mut impl Dac) {
    if let Err(detail) = dac.prepare() {
        log_dac(detail);
    }
}

/// The description of a starting board: `built_in` with the limits stored in `flash`, the notices of both, and the
/// cause of the last reset.
#[inline]
pub fn describe<F: Flash>(
    built_in: Board,
    flash: Option<&F>,
    ceilings: CeilingPolicy,
    last_reset: &LastReset,
) -> Board {
    let (limits, notices) = load_limits(flash, LIMITS_SLOT, &built_in.limits, ceilings);
    let board = Board {
        limits,
        notices: built_in.notices | notices,
        reset_cause: last_reset.cause,
        reset_fault: last_reset.fault,
        reset_text: last_reset.text,
        ..built_in
    };
    log(&board);
    board
}

/// The parts of a board before its tick runs. Each is ready, and the output is zero.
pub struct Parts<H: Hardware> {
    /// The timer of the tick, which runs without its interrupt.
    pub period: H::Period,
    /// The tick's half of the DAC.
    pub frames: H::Frames,
    /// The main loop's half.
    pub dac: H::Dac,
    /// The amplifier's enable.
    pub enable: H::Enable,
    /// The amplifier's ready line.
    pub ready: H::Ready,
    /// The amplifier's monitor.
    pub monitor: H::Monitor,
    /// The contact of the arm switch.
    pub switch: H::Switch,
    /// The light that shows the state.
    pub light: H::Light,
    /// The serial port to the host; `None` if the host is on the board, as in bring-up.
    pub serial: Option<H::Serial>,
}

impl<H: Hardware> Parts<H> {
    /// Creates tick and main loop. Passes the tick to `start_tick`, which starts its interrupt, and then starts the
    /// watchdog.
    #[inline]
    pub fn start(
        self,
        made: BoardParts,
        shared: &'static TickShared,
        start_tick: impl FnOnce(Tick<H>),
        start_watchdog: impl FnOnce() -> H::Watchdog,
    ) -> MainLoop<H> {
        let BoardParts { ticker, session, session_ends, tick_ends } = made;
        #[cfg(feature = "telemetry")]
        session.attach_tick_meter(&shared.meter);
        let status = ticker.status();
        start_tick(Tick {
            shared,
            ticker,
            queues: tick_ends,
            period: self.period,
            frames: self.frames,
            amplifier: Amplifier::new(self.enable, self.ready),
            monitor: self.monitor,
            arm_switch: ArmSwitch::new(self.switch, H::SWITCH_HZ),
        });
        MainLoop {
            shared,
            queues: session_ends,
            session,
            status,
            serial: self.serial.map(BufferedSerial::new),
            dac: self.dac,
            light: StateLight::new(self.light, H::TICK_HZ),
            watchdog: start_watchdog(),
        }
    }
}

#[cfg(feature = "defmt")]
fn log(board: &Board) {
    defmt::info!("at most {=f32} V peak, notices {=u8:#b}", board.limits.voltage_max_v_peak, board.notices);
}

#[cfg(not(feature = "defmt"))]
fn log(_: &Board) {}

#[cfg(feature = "defmt")]
fn log_dac(detail: u32) {
    defmt::warn!("the DAC is not ready: detail {=u32:#x}", detail);
}

#[cfg(not(feature = "defmt"))]
fn log_dac(_: u32) {}
