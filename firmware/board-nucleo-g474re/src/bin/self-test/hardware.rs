//! The parts of the tick and the main loop in the self-test: those of this board, but for what could drive anything.

use core::sync::atomic::{AtomicBool, Ordering};

use board_nucleo_g474re::adc::Adc;
use board_nucleo_g474re::board::{Nucleo, TICK_HZ};
use board_nucleo_g474re::dac::Frames;
use board_nucleo_g474re::period::Period;
use board_nucleo_g474re::watchdog::Watchdog;
use frixel_board::hardware::{Dac, DacFrames, Hardware, Late};
use frixel_drivers::amplifier::KickedEnable;
use frixel_drivers::pin::{DirectPin, ReadLevel};
use frixel_wire::dac_code::DacCode;

/// What the tick takes for the contact of the arm switch.
pub(crate) static SWITCH_HELD: AtomicBool = AtomicBool::new(false);

/// The parts.
pub(crate) struct Wired;

impl Hardware for Wired {
    const TICK_HZ: u32 = TICK_HZ;

    type Period = Period;
    type Frames = ZeroFrames;
    type Dac = NoDac;
    type Enable = NoEnable;
    type Ready = DirectPin<AlwaysHigh>;
    type Monitor = Adc;
    type Switch = DirectPin<ScriptedSwitch>;
    type Light = <Nucleo as Hardware>::Light;
    type Serial = <Nucleo as Hardware>::Serial;
    type Watchdog = Watchdog;
}

/// Frames as the tick sends them, but for their code, which is zero.
pub(crate) struct ZeroFrames(pub(crate) Frames);

impl DacFrames for ZeroFrames {
    #[inline]
    fn send(&mut self, _code: DacCode) -> Result<(), Late> {
        self.0.send(DacCode::ZERO)
    }
}

/// No enable: the one-shot rests, whatever the tick does.
pub(crate) struct NoEnable;

impl KickedEnable for NoEnable {
    #[inline]
    fn kick(&mut self) {}

    #[inline]
    fn disable(&mut self) {}
}

/// A DAC that is always in order, because there is none.
pub(crate) struct NoDac;

impl Dac for NoDac {
    fn prepare(&mut self) -> Result<(), u32> {
        Ok(())
    }

    fn check(&mut self) -> Result<(), u32> {
        Ok(())
    }
}

/// The ready line of an amplifier that is not there.
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
