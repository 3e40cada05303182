//! The limits that bring-up starts from, and their place in flash.

use board_nucleo_g474re::board::{CEILINGS, LIMITS};
use board_nucleo_g474re::flash::BankTwo;
use frixel_board::start::LIMITS_SLOT;
use frixel_session::store::{LIMITS_LEN, LimitsError, Writer, Writing, load_limits, write_limits};
use frixel_wire::hello::BoardLimits;

/// The limits of `src/board.rs`, with overrides from the build's environment; `None` if one is not a number.
pub(crate) fn built_in() -> Option<BoardLimits> {
    let number = |text: Option<&str>, unit: f32, default: f32| match text {
        None => Some(default),
        Some(text) => text.parse::<f32>().ok().map(|number| number * unit),
    };
    Some(BoardLimits {
        voltage_max_v_peak: number(option_env!("FRIXEL_VOLTAGE_MAX_V_PEAK"), 1.0, LIMITS.voltage_max_v_peak)?,
        full_scale_v_peak: number(option_env!("FRIXEL_FULL_SCALE_V_PEAK"), 1.0, LIMITS.full_scale_v_peak)?,
        edge_time_constant_s: number(option_env!("FRIXEL_EDGE_US"), 1e-6, LIMITS.edge_time_constant_s)?,
        electrode_capacitance_max_f: number(
            option_env!("FRIXEL_ELECTRODE_PF"),
            1e-12,
            LIMITS.electrode_capacitance_max_f,
        )?,
        current_max_a_rms: number(option_env!("FRIXEL_CURRENT_MA_RMS"), 1e-3, LIMITS.current_max_a_rms)?,
        current_max_a_peak: number(option_env!("FRIXEL_CURRENT_MA_PEAK"), 1e-3, LIMITS.current_max_a_peak)?,
        ..LIMITS
    })
}

/// Encodes limits for storage. Refuses limits that this board must not store.
pub(crate) fn written(limits: &BoardLimits) -> Result<[u8; LIMITS_LEN], LimitsError> {
    write_limits(limits, CEILINGS)
}

/// Stores limits in both copies and reads them back, so that no earlier limits remain; `false` if that failed.
/// `goes_on` is called repeatedly meanwhile; it returns `false` to give up on a flash that never ends an operation.
pub(crate) fn store(flash: &mut BankTwo, limits: &BoardLimits, mut goes_on: impl FnMut() -> bool) -> bool {
    let Ok(bytes) = written(limits) else { return false };
    for _ in 0..2 {
        let mut writer = Writer::new(LIMITS_SLOT, flash, &bytes);
        loop {
            if !goes_on() {
                return false;
            }
            match writer.step(flash) {
                Writing::UnderWay => {}
                Writing::Done => break,
                Writing::Failed => return false,
            }
        }
    }
    load_limits(Some(&*flash), LIMITS_SLOT, &LIMITS, CEILINGS).0 == *limits
}
