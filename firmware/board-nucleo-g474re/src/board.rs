//! Identity and limits of this board. The limits are defined in `Board::NUCLEO_G474RE`, which the host also uses.

use frixel_board::fault::LastReset;
use frixel_board::hardware::Hardware;
use frixel_board::serial::RECEIVE_WINDOW;
use frixel_board::start::describe;
use frixel_control::Board;
use frixel_session::store::{CeilingPolicy, check_touched_board};
use frixel_wire::hello::{BoardLimits, notice};
use stm32_metapac::UID;

use crate::adc::Adc;
use crate::dac::{Dac, Frames};
use crate::flash::{self, BankTwo};
use crate::output::Output;
use crate::period::Period;
use crate::pins::Pin;
use crate::serial::Serial;
use crate::watchdog::Watchdog;

/// The parts of this board.
pub enum Nucleo {}

impl Hardware for Nucleo {
    const TICK_HZ: u32 = TICK_HZ;

    type Period = Period;
    type Frames = Frames;
    type Dac = Dac;
    type Enable = Output;
    type Ready = Pin;
    type Monitor = Adc;
    type Switch = Pin;
    type Light = Pin;
    type Serial = Serial;
    type Watchdog = Watchdog;
}

/// Ticks a second.
pub const TICK_HZ: u32 = Board::NUCLEO_G474RE.tick_hz;
/// Limits until bring-up has stored others.
pub const LIMITS: BoardLimits =
    BoardLimits { receive_window_bytes: RECEIVE_WINDOW as u16, ..limits_behind(option_env!("FRIXEL_SERIES_KOHM")) };

/// Limits for the series resistance in the build's environment, kOhm, or else for that of `docs/board/hardware.md`.
/// Build firmware and bring-up with the same resistance; otherwise the firmware refuses the limits that bring-up has
/// stored.
const fn limits_behind(series_kohm: Option<&str>) -> BoardLimits {
    let of_docs = Board::NUCLEO_G474RE.limits;
    let Some(series_kohm) = series_kohm else { return of_docs };
    let Ok(series_kohm) = u32::from_str_radix(series_kohm, 10) else {
        panic!("FRIXEL_SERIES_KOHM must be a whole number of kOhm, 42 or more")
    };
    let behind = Board::NUCLEO_G474RE.behind(1e3 * series_kohm as f32).limits;
    BoardLimits { voltage_max_v_peak: Board::UNMEASURED_V_PEAK, ..behind }
}

const _: () = assert!(
    check_touched_board(&LIMITS).is_ok(),
    "FRIXEL_SERIES_KOHM must be a whole number of kOhm, 42 or more: behind less, an amplifier that is stuck drives more \
     than 5 mA through a person"
);

/// Whether stored limits above the ceilings are refused.
pub const CEILINGS: CeilingPolicy =
    if cfg!(feature = "limits-above-ceilings") { CeilingPolicy::Lifted } else { CeilingPolicy::InForce };
/// The board's description, with the cause of the last reset. Wrong option bytes are one of its notices, and refuse
/// arming.
pub fn board(last_reset: &LastReset, flash: Option<&BankTwo>) -> Board {
    let built_in = Board {
        id: unique_number(),
        limits: LIMITS,
        touch_from_host: !cfg!(feature = "optical-frame"),
        notices: if flash::option_bytes_are_right() { 0 } else { notice::OPTION_BYTES },
        ..Board::NUCLEO_G474RE
    };
    describe(built_in, flash, CEILINGS, last_reset)
}

/// The processor's unique number, 96 bits (RM0440, "Unique device ID register").
fn unique_number() -> [u8; 12] {
    let mut id = [0; 12];
    for (index, word) in id.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        *word = UID.uid(index).read().to_le_bytes();
    }
    id
}
