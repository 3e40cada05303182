//! Identity and limits of this board. The limits are defined in `Board::PICO_2` and `Board::PICO`, which the host also
//! uses.

use frixel_board::fault::LastReset;
use frixel_board::hardware::Hardware;
use frixel_board::serial::RECEIVE_WINDOW;
use frixel_board::start::describe;
use frixel_control::Board;
use frixel_session::store::{CeilingPolicy, check_touched_board};
use frixel_wire::hello::BoardLimits;

use crate::adc::Adc;
use crate::chip::{BOARD, TICK_HZ};
use crate::dac::{Dac, Frames};
use crate::flash::StoreFlash;
use crate::output::Output;
use crate::period::Period;
use crate::pins::Pin;
use crate::serial::Serial;
use crate::unique_number::unique_number;
use crate::watchdog::Watchdog;

/// The parts of this board.
pub enum Pico {}

impl Hardware for Pico {
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

/// Limits until others are stored.
pub const LIMITS: BoardLimits = BoardLimits {
    voltage_max_v_peak: Board::UNMEASURED_V_PEAK,
    receive_window_bytes: RECEIVE_WINDOW as u16,
    ..BOARD.limits
};

const _: () = assert!(check_touched_board(&LIMITS).is_ok());

/// Whether stored limits above the ceilings are refused.
pub const CEILINGS: CeilingPolicy =
    if cfg!(feature = "limits-above-ceilings") { CeilingPolicy::Lifted } else { CeilingPolicy::InForce };

/// The board's description, with the cause of the last reset.
pub fn board(last_reset: &LastReset) -> Board {
    let mut id = *b"pico\0\0\0\0\0\0\0\0";
    if let (Some(place), Some(number)) = (id.last_chunk_mut(), unique_number()) {
        *place = number;
    }
    let built_in = Board { id, limits: LIMITS, touch_from_host: !cfg!(feature = "optical-frame"), ..BOARD };
    describe(built_in, Some(&StoreFlash), CEILINGS, last_reset)
}
