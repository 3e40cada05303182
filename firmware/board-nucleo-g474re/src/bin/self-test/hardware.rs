//! Tick and main loop in the self-test: the board's own parts, except the ones that could drive anything.

use core::sync::atomic::{AtomicBool, Ordering};

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::board::{Nucleo, TICK_HZ};
use board_nucleo_g474re::dac::Frames;
use board_nucleo_g474re::period::Period;
use board_nucleo_g474re::watchdog::Watchdog;
use frixel_board::hardware::{DacFrames, Hardware, Late};
use frixel_drivers::amplifier::KickedEnable;
use frixel_drivers::pin::{DirectPin, ReadLevel};
use frixel_wire::dac_code::DacCode;

/// Simulated contact of the arm switch, as the tick reads it.
pub(crate) static SWITCH_HELD: AtomicBool = AtomicBool::new(false);

/// The parts of the self-test's tick and main loop.
pub(crate) struct Wired;

impl Hardware for Wired {
    const TICK_HZ: u32 = TICK_HZ;

    type Period = Period;
    type Frames = ZeroFrames;
    type Dac = ();
    type Enable = NoEnable;
    type Ready = DirectPin<AlwaysHigh>;
    type Monitor = Adc;
    type Switch = DirectPin<ScriptedSwitch>;
    type Light = <Nucleo as Hardware>::Light;
    type Serial = <Nucleo as Hardware>::Serial;
    type Watchdog = Watchdog;
}

/// The tick's frames, with their code replaced by zero.
pub(crate) struct ZeroFrames(pub(crate) Frames);

impl DacFrames for ZeroFrames {
    #[inline]
    fn send(&mut self, _code: DacCode) -> Result<(), Late> {
        self.0.send(DacCode::ZERO)
    }
}

/// Placeholder for the enable: the one-shot stays at rest, whatever the tick does.
pub(crate) struct NoEnable;

impl KickedEnable for NoEnable {
    #[inline]
    fn kick(&mut self) {}

    #[inline]
    fn disable(&mut self) {}
}

/// Ready line without an amplifier, always high.
pub(crate) struct AlwaysHigh;

impl ReadLevel for AlwaysHigh {
    #[inline]
    fn is_high(&self) -> bool {
        true
    }
}

/// The arm switch, which the script holds.
pub(crate) struct ScriptedSwitch;

impl ReadLevel for ScriptedSwitch {
    #[inline]
    fn is_high(&self) -> bool {
        SWITCH_HELD.load(Ordering::Relaxed)
    }
}
