//! Identity and limits of this board. The numbers here belong to the parts that `docs/hardware.md` lists: another
//! amplifier or electrode needs other numbers.

use frixel_control::{AmplifierSpec, Board, ReadyWhileDisabled, SwitchingTime};
use frixel_drivers::monitor::MonitorScale;
use frixel_layers::BITMAP_POOL_LEN;
use frixel_session::store::{Ceilings, Flash, Slot, check_ceilings, load_limits};
use frixel_wire::hello::{BoardKind, BoardLimits};
use frixel_wire::scene::RECORDS_MAX;
use stm32_metapac::UID;

use crate::fault::LastReset;
use crate::flash::{BankTwo, PAGES};

/// Ticks a second.
pub const TICK_HZ: u32 = 40_000;
/// Number of bytes that the host may have under way.
pub const RECEIVE_WINDOW: usize = 4096;

/// The monitor's ADC: 12 bits of 3.3 V. The amplifier's monitor gives 1 V for 100 V, which the level shifter converts
/// to 0.75 V around 1.65 V, so that 220 V use the full range.
pub const MONITOR: MonitorScale = MonitorScale::new(12, 3.3, 0.75 / 100.0);

/// Limits until bring-up has stored others.
pub const LIMITS: BoardLimits = BoardLimits {
    bitmap_pool_bytes: BITMAP_POOL_LEN as u32,
    records_max: RECORDS_MAX as u8,
    receive_window_bytes: RECEIVE_WINDOW as u16,
    // Until the board has been measured.
    voltage_max_v_peak: 50.0,
    // 10 V of the DAC behind an amplifier of gain 20.
    full_scale_v_peak: 200.0,
    // The one lag that takes as much of the mean square as 68 kOhm in series with the electrode below, 36 us, behind an
    // amplifier of 20 kHz, 8 us.
    edge_time_constant_s: 37.5e-6,
    // 2 cm^2 of bare 10 um polymer, relative permittivity 3.
    electrode_capacitance_max_f: 0.53e-9,
    // The limit for touch currents in normal use of IEC 61010-1, without its weighting by frequency.
    current_max_a_rms: 0.5e-3,
    // The current through the series resistor when an edge goes from 50 V to -50 V, 1.47 mA, and a fifth more.
    current_max_a_peak: 1.8e-3,
    touch_report_period_s: 10e-3,
    tick_cycles_max: BoardLimits::SMALLEST_TICK_CYCLES_MAX,
};

const _: () = assert!(check_ceilings(&LIMITS).is_ok());

/// Whether stored limits above the ceilings are refused.
pub const CEILINGS: Ceilings =
    if cfg!(feature = "limits-above-ceilings") { Ceilings::Lifted } else { Ceilings::InForce };
/// The amplifier, as `docs/hardware.md` demands it.
pub const AMPLIFIER: AmplifierSpec = AmplifierSpec {
    // A large-signal bandwidth of 20 kHz. The series resistor is behind the monitor.
    time_constant_s: 8e-6,
    // Assumed.
    turn_on: SwitchingTime::from_s(1e-3),
    turn_off: SwitchingTime::from_s(1e-3),
    ready_while_disabled: ReadyWhileDisabled::High,
};

/// Where the limits are stored: the first two pages of bank 2.
pub const LIMITS_SLOT: Slot = Slot { first_page: 0, pages: 1 };
/// Where the last scene is stored: the rest of bank 2, 126 KiB a copy. 64 KiB of bitmaps and the largest scene need 71
/// KiB.
pub const SCENE_SLOT: Slot = Slot { first_page: 2, pages: (PAGES - 2) / 2 };

const _: () = assert!(
    SCENE_SLOT.capacity::<BankTwo>() as usize
        >= frixel_layers::BITMAP_POOL_LEN + frixel_layers::SCENE_MAX_LEN + (1 + RECORDS_MAX) * 16
);

/// The board's description, with the cause of the last reset.
pub fn board(last_reset: &LastReset, flash: Option<&BankTwo>) -> Board {
    let (limits, notices) = load_limits(flash, LIMITS_SLOT, &LIMITS, CEILINGS);
    Board {
        kind: BoardKind::NucleoG474re,
        id: unique_number(),
        tick_hz: TICK_HZ,
        limits,
        amplifier: AMPLIFIER,
        hold_to_run: true,
        reset_cause: last_reset.cause,
        reset_fault: last_reset.fault,
        reset_text: last_reset.text,
        reset_fault_starts: last_reset.fault_starts,
        touch_from_host: !cfg!(feature = "optical-frame"),
        notices,
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

const _: () = assert!(BankTwo::PAGE_LEN == 2048);
