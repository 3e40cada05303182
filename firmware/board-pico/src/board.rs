//! Identity, stores and limits of this board. The limits stand in `Board::PICO_2` and `Board::PICO`, where the host
//! finds them, too.

use frixel_board::fault::LastReset;
use frixel_board::hardware::Hardware;
use frixel_control::Board;
use frixel_drivers::monitor::MonitorScale;
use frixel_drivers::rp2::LIMITS_PAGES;
#[cfg(feature = "store")]
use frixel_session::store::SceneStore;
use frixel_session::store::{Ceilings, Slot, check_touched_board, load_limits};
use frixel_wire::hello::BoardLimits;
use frixel_wire::scene::RECORDS_MAX;

use crate::adc::Adc;
use crate::chip::{BOARD, TICK_HZ};
use crate::dac::{Dac, Frames};
use crate::flash::{PAGES, StoreFlash};
use crate::output::Output;
use crate::period::Period;
use crate::pins::Pin;
use crate::serial::Serial;
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
    #[cfg(feature = "store")]
    type Store = Option<(SceneStore, StoreFlash)>;
    #[cfg(not(feature = "store"))]
    type Store = ();
    type Watchdog = Watchdog;
}

/// Number of bytes that the host may have under way.
pub const RECEIVE_WINDOW: usize = 4096;

/// The monitor's ADC: 12 bits of 3.3 V. The amplifier's monitor gives 1 V for 100 V, which the level shifter converts
/// to 0.75 V around 1.65 V, so that 220 V use the full range.
pub const MONITOR: MonitorScale = MonitorScale::new(12, 3.3, 0.75 / 100.0);

/// Limits until others are stored.
pub const LIMITS: BoardLimits = BoardLimits {
    voltage_max_v_peak: Board::UNMEASURED_V_PEAK,
    receive_window_bytes: RECEIVE_WINDOW as u16,
    ..BOARD.limits
};

const _: () = assert!(check_touched_board(&LIMITS).is_ok());

/// Whether stored limits above the ceilings are refused.
pub const CEILINGS: Ceilings =
    if cfg!(feature = "limits-above-ceilings") { Ceilings::Lifted } else { Ceilings::InForce };

/// Where the limits are stored: at the beginning of the stores.
pub const LIMITS_SLOT: Slot = Slot { first_page: 0, pages: LIMITS_PAGES };
/// Where the last scene is stored: the rest, 124 KiB a copy. 64 KiB of bitmaps and the largest scene need 71 KiB.
pub const SCENE_SLOT: Slot = Slot { first_page: 2 * LIMITS_PAGES, pages: (PAGES - 2 * LIMITS_PAGES) / 2 };

const _: () = assert!(
    SCENE_SLOT.capacity::<StoreFlash>() as usize
        >= frixel_layers::BITMAP_POOL_LEN + frixel_layers::SCENE_MAX_LEN + (1 + RECORDS_MAX) * 16
);

/// The board's description, with the cause of the last reset.
pub fn board(last_reset: &LastReset, flash: Option<&StoreFlash>) -> Board {
    let (limits, notices) = load_limits(flash, LIMITS_SLOT, &LIMITS, CEILINGS);
    let mut id = *b"pico\0\0\0\0\0\0\0\0";
    if let (Some(number), Some(flash)) = (id.last_chunk_mut(), flash) {
        *number = flash.unique_number();
    }
    Board {
        id,
        limits,
        reset_cause: last_reset.cause,
        reset_fault: last_reset.fault,
        reset_text: last_reset.text,
        reset_fault_starts: last_reset.fault_starts,
        touch_from_host: !cfg!(feature = "optical-frame"),
        notices,
        ..BOARD
    }
}
