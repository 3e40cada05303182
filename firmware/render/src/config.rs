//! Whether the numbers of a scene are ones that the board can play. Refused, never silently clamped.

use frixel_wire::message::{ConfigField, ConfigRefusal};
use frixel_wire::scene::{Header, Layer, Record, Region};

use crate::Board;

/// Lowest carrier frequency: charge leaks through skin below about 250 Hz (arXiv 2409.18725); at less than half of
/// that the drive is no alternating carrier any more.
const CARRIER_MIN_HZ: f32 = 125.0;
/// Fewest ticks in a half period of the carrier.
const HALF_PERIOD_MIN_TICKS: f32 = 4.0;
/// Farthest from the screen's corner that anything may be, in m.
pub(crate) const LENGTH_MAX_M: f32 = 2.0;
/// Largest gain of a layer, either way.
pub(crate) const GAIN_MAX: f32 = 100.0;
/// Largest friction that a layer may name, in N, either way.
const FRICTION_MAX_N: f32 = 100.0;

/// Takes a number when it is from `min` to `max`; not-a-number never is.
pub(crate) fn within(field: ConfigField, found: f32, min: f32, max: f32, layer: u8) -> Result<(), ConfigRefusal> {
    if found >= min && found <= max { Ok(()) } else { Err(ConfigRefusal { field, found, min, max, layer }) }
}

/// Checks what holds for the whole scene, but for the drive (see [`crate::active`]).
pub(crate) fn check_header(header: &Header, board: &Board) -> Result<(), ConfigRefusal> {
    let limits = &board.limits;
    let carrier_max_hz = board.tick_hz as f32 / (2.0 * HALF_PERIOD_MIN_TICKS);
    for (field, found, min, max) in [
        (ConfigField::ScreenWidth, header.screen_width_m, 1e-3, LENGTH_MAX_M),
        (ConfigField::ScreenHeight, header.screen_height_m, 1e-3, LENGTH_MAX_M),
        (ConfigField::FingerRadius, header.finger_radius_m, 1e-4, 1.0),
        (ConfigField::Stiffness, header.stiffness_pa_per_m, 1e3, 1e14),
        (ConfigField::FrictionCoefficient, header.friction_coefficient, 1e-3, 100.0),
        (ConfigField::NormalLoad, header.normal_load_n, 0.0, 50.0),
        (ConfigField::EffectiveGap, header.effective_gap_m, 1e-12, 1e-2),
        (ConfigField::VoltageRms, header.voltage_max_v_rms, 1.0, limits.voltage_max_v_peak),
        (ConfigField::VoltagePeak, header.voltage_max_v_peak, 1.0, limits.voltage_max_v_peak),
        (ConfigField::Slew, header.slew_v_per_s, 1.0, 1e9),
        (ConfigField::CarrierFrequency, header.carrier_hz, CARRIER_MIN_HZ, carrier_max_hz),
        (ConfigField::HostTimeout, header.host_timeout_s, 0.02, 1.0),
    ] {
        within(field, found, min, max, ConfigRefusal::WHOLE_SCENE)?;
    }
    Ok(())
}

/// Checks the numbers of layer number `layer`.
pub(crate) fn check_record(record: &Record, layer: u8) -> Result<(), ConfigRefusal> {
    let length = |field, found| within(field, found, -LENGTH_MAX_M, LENGTH_MAX_M, layer);
    let size = |field, found| within(field, found, f32::MIN_POSITIVE, LENGTH_MAX_M, layer);
    let friction = |found| within(ConfigField::Friction, found, -FRICTION_MAX_N, FRICTION_MAX_N, layer);
    within(ConfigField::Gain, record.gain, -GAIN_MAX, GAIN_MAX, layer)?;
    if let Region::Rectangle { x_m, y_m, width_m, height_m } = record.region {
        length(ConfigField::Region, x_m)?;
        length(ConfigField::Region, y_m)?;
        size(ConfigField::Region, width_m)?;
        size(ConfigField::Region, height_m)?;
    }
    match record.layer {
        Layer::Constant { electric_friction_n } => friction(electric_friction_n),
        Layer::Stream { low_n, high_n } => {
            friction(low_n)?;
            friction(high_n)
        }
        Layer::Grating { cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n, .. } => {
            within(ConfigField::WaveVector, cycles_per_m_x, -2e4, 2e4, layer)?;
            within(ConfigField::WaveVector, cycles_per_m_y, -2e4, 2e4, layer)?;
            within(ConfigField::Phase, phase_turns, -1000.0, 1000.0, layer)?;
            friction(trough_n)?;
            friction(crest_n)
        }
        Layer::Bitmap { x_m, y_m, pitch_m, black_n, white_n, .. } => {
            length(ConfigField::BitmapPlacement, x_m)?;
            length(ConfigField::BitmapPlacement, y_m)?;
            within(ConfigField::BitmapPlacement, pitch_m, 1e-5, 0.1, layer)?;
            friction(black_n)?;
            friction(white_n)
        }
    }
}
