//! Identity and limits of this board. The limits stand in `Board::NUCLEO_G474RE`, where the host finds them,
//! too.

use frixel_board::fault::LastReset;
use frixel_board::hardware::Hardware;
use frixel_control::{AmplifierSpec, Board};
use frixel_drivers::monitor::MonitorScale;
use frixel_session::store::{Ceilings, Slot, check_touched_board, load_limits};
use frixel_wire::hello::{BoardKind, BoardLimits, notice};
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
pub const TICK_HZ: u32 = 40_000;
/// Number of bytes that the host may have under way.
pub const RECEIVE_WINDOW: usize = 4096;

/// The monitor's ADC: 12 bits of 3.3 V. The amplifier's monitor gives 1 V for 100 V, which the level shifter converts
/// to 0.75 V around 1.65 V, so that 220 V use the full range.
pub const MONITOR: MonitorScale = MonitorScale::new(12, 3.3, 0.75 / 100.0);

/// Limits until bring-up has stored others.
pub const LIMITS: BoardLimits =
    BoardLimits { receive_window_bytes: RECEIVE_WINDOW as u16, ..limits_behind(option_env!("FRIXEL_SERIES_KOHM")) };

/// The limits behind a series resistance in kOhm that the environment of the build names, or else behind the one of
/// `docs/hardware.md`. Firmware and bring-up are built with the same, or the firmware refuses what bring-up has stored.
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
pub const CEILINGS: Ceilings =
    if cfg!(feature = "limits-above-ceilings") { Ceilings::Lifted } else { Ceilings::InForce };
/// The amplifier.
pub const AMPLIFIER: AmplifierSpec = Board::NUCLEO_G474RE.amplifier;

/// Where the limits are stored: the first two pages of bank 2.
pub const LIMITS_SLOT: Slot = Slot { first_page: 0 };
/// The board's description, with the cause of the last reset. Wrong option bytes are one of its notices, and refuse
/// arming.
pub fn board(last_reset: &LastReset, flash: Option<&BankTwo>) -> Board {
    let (limits, notices) = load_limits(flash, LIMITS_SLOT, &LIMITS, CEILINGS);
    let wrong = if flash::option_bytes_are_right() { 0 } else { notice::OPTION_BYTES };
    // Field by field: the rest of `Board::NUCLEO_G474RE` copied would take 90 bytes of flash.
    Board {
        kind: BoardKind::NucleoG474re,
        id: unique_number(),
        tick_hz: TICK_HZ,
        limits,
        amplifier: AMPLIFIER,
        reset_cause: last_reset.cause,
        reset_fault: last_reset.fault,
        reset_text: last_reset.text,
        touch_from_host: !cfg!(feature = "optical-frame"),
        notices: notices | wrong,
    }
}

/// The processor's unique number, 96 bits (RM0440, "Unique device ID register").
fn unique_number() -> [u8; 12] {
    let mut id = [0; 12];
    for (index, word) in id.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        *word = UID.uid(index).read().to_le_bytes();
    }
    id
}
