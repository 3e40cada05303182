//! Stores the board's measured limits in flash.

use board_nucleo_g474re::board::{CEILINGS, LIMITS, LIMITS_SLOT};
use board_nucleo_g474re::flash::BankTwo;
use defmt::{Display2Format, error, info, println, warn};
use frixel_session::store::{LIMITS_LEN, WORD_LEN, Writer, Writing, load_limits, write_limits};
use frixel_wire::hello::{BoardLimits, notice};

/// Stores the limits that were set in the environment at build time, and logs the limits in effect.
pub(crate) fn limits() {
    let Some(mut flash) = BankTwo::new() else {
        error!("the flash is not in two banks: set the option byte DBANK, which ST's programmer does");
        return;
    };
    match built_in() {
        Some(limits) => write(&mut flash, &limits),
        None => println!("no limits were built in (docs/hardware.md says how); the stored ones stay"),
    }
    let (limits, notices) = load_limits(Some(&flash), LIMITS_SLOT, &LIMITS, CEILINGS);
    if notices & notice::STORED_LIMITS_REFUSED != 0 {
        error!("the stored limits are not used: one exceeds a ceiling, or a build with other ceilings stored them");
    }
    if notices & notice::LIMITS_ABOVE_CEILINGS != 0 {
        warn!("this build stores limits above the ceilings: nobody touches this board");
    }
    info!(
        "largest voltage {=f32} V peak, full scale {=f32} V peak",
        limits.voltage_max_v_peak, limits.full_scale_v_peak
    );
    info!(
        "edges {=f32} us, electrode {=f32} pF",
        limits.edge_time_constant_s * 1e6,
        limits.electrode_capacitance_max_f * 1e12
    );
    info!("current {=f32} mA rms, {=f32} mA peak", limits.current_max_a_rms * 1e3, limits.current_max_a_peak * 1e3);
}

fn write(flash: &mut BankTwo, limits: &BoardLimits) {
    let bytes = match write_limits(limits, CEILINGS) {
        Ok(bytes) => bytes,
        Err(refused) => return error!("not stored: {}", Display2Format(&refused)),
    };
    let found = LIMITS_SLOT.find(flash);
    let Some(mut writer) = Writer::new::<BankTwo>(LIMITS_SLOT, found.as_ref(), LIMITS_LEN as u32) else {
        error!("the limits do not fit");
        return;
    };
    let word = |offset: u32| {
        let mut word = [0; WORD_LEN];
        for (to, from) in word.iter_mut().zip(bytes.iter().skip(offset as usize)) {
            *to = *from;
        }
        word
    };
    loop {
        match writer.step(flash, word) {
            Writing::UnderWay => {}
            Writing::Done(_) => return info!("stored"),
            Writing::Failed => return error!("the flash could not be written"),
        }
    }
}

/// Returns the limits from the environment; `None` without a voltage. Other missing limits keep their values from
/// `src/board.rs`.
fn built_in() -> Option<BoardLimits> {
    let number = |text: Option<&str>, unit: f32, default: f32| match text {
        None => Some(default),
        Some(text) => text.parse::<f32>().ok().map(|number| number * unit),
    };
    option_env!("FRIXEL_VOLTAGE_MAX_V_PEAK")?;
    let limits = (|| {
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
    })();
    if limits.is_none() {
        error!("one of the limits in the environment is not a number");
    }
    limits
}
