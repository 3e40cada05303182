//! Whether the numbers of a scene are ones that the board can play. Refused, never silently clamped.

use frixel_wire::message::{ConfigField, ConfigRefusal};
use frixel_wire::scene::{Header, Layer, Point, Record, Region, Scene, Wave};

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
/// Least width and height of a region, in m: their inverses are finite, and a rectangle is a step wide at least.
const SIZE_MIN_M: f32 = 4e-9;
/// Finest stripes and noise, in cycles per metre.
const CYCLES_PER_M_MAX: f32 = 2e4;
/// Distances of a bitmap's samples, in m.
const PITCH_MIN_M: f32 = 1e-5;
const PITCH_MAX_M: f32 = 0.1;
/// Least width of a ridge or a rim, in m.
const WIDTH_MIN_M: f32 = 1e-5;
/// Longest click, in s.
const CLICK_MAX_S: f32 = 1.0;
/// Longest period of a burst, in s.
const BURST_MAX_S: f32 = 60.0;
/// Largest speed of a curve, and least distance of two, in m/s.
const SPEED_MAX_M_PER_S: f32 = 10.0;
const SPEED_STEP_MIN_M_PER_S: f32 = 1e-5;

// Code of its own: nearly every line below calls it.
/// Takes a number when it is from `min` to `max`; not-a-number never is.
#[inline(never)]
pub(crate) fn within(field: ConfigField, found: f32, min: f32, max: f32, layer: u8) -> Result<(), ConfigRefusal> {
    if found >= min && found <= max { Ok(()) } else { Err(ConfigRefusal { field, found, min, max, layer }) }
}

/// Checks what holds for the whole scene, but for the drive (see [`crate::active`]).
#[inline]
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

/// Checks the numbers of layer number `layer` of a scene.
#[inline]
pub(crate) fn check_record(record: &Record, scene: &Scene, layer: u8) -> Result<(), ConfigRefusal> {
    within(ConfigField::Gain, record.gain, -GAIN_MAX, GAIN_MAX, layer)?;
    check_region(record.region, scene, layer)?;
    check_kind(&record.layer, scene, layer)
}

#[inline]
fn check_region(region: Region, scene: &Scene, layer: u8) -> Result<(), ConfigRefusal> {
    match region {
        Region::Rectangle { x_m, y_m, width_m, height_m } | Region::Ellipse { x_m, y_m, width_m, height_m } => {
            lengths(ConfigField::Region, [x_m, y_m], layer)?;
            sizes(ConfigField::Region, [width_m, height_m], layer)
        }
        Region::Polygon { first, count } if cfg!(feature = "polygon") => {
            points(scene, first, count).try_for_each(|vertex| lengths(ConfigField::Vertex, [vertex.x, vertex.y], layer))
        }
        // A polygon that is left out is refused when it is read.
        Region::Screen | Region::Polygon { .. } => Ok(()),
    }
}

#[inline]
fn check_kind(kind: &Layer, scene: &Scene, layer: u8) -> Result<(), ConfigRefusal> {
    match *kind {
        Layer::Constant { electric_friction_n } => frictions([electric_friction_n], layer),
        Layer::Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n }
            if cfg!(feature = "grating") =>
        {
            within(ConfigField::WaveVector, cycles_per_m_x, -CYCLES_PER_M_MAX, CYCLES_PER_M_MAX, layer)?;
            within(ConfigField::WaveVector, cycles_per_m_y, -CYCLES_PER_M_MAX, CYCLES_PER_M_MAX, layer)?;
            within(ConfigField::Phase, phase_turns, -1000.0, 1000.0, layer)?;
            if let Wave::Square { duty } = wave {
                within(ConfigField::Duty, duty, 0.01, 0.99, layer)?;
            }
            frictions([trough_n, crest_n], layer)
        }
        Layer::Bitmap { x_m, y_m, pitch_m, pitch_y_m, angle_turns, black_n, white_n, .. }
            if cfg!(feature = "bitmap") =>
        {
            lengths(ConfigField::BitmapPlacement, [x_m, y_m], layer)?;
            within(ConfigField::BitmapPlacement, pitch_m, PITCH_MIN_M, PITCH_MAX_M, layer)?;
            within(ConfigField::BitmapPlacement, pitch_y_m, PITCH_MIN_M, PITCH_MAX_M, layer)?;
            angle(angle_turns, layer)?;
            frictions([black_n, white_n], layer)
        }
        Layer::Noise { wavelength_min_m, wavelength_max_m, low_n, high_n, .. } if cfg!(feature = "noise") => {
            let least_m = 1.0 / CYCLES_PER_M_MAX;
            within(ConfigField::Wavelength, wavelength_max_m, least_m, LENGTH_MAX_M, layer)?;
            within(ConfigField::Wavelength, wavelength_min_m, least_m, wavelength_max_m, layer)?;
            frictions([low_n, high_n], layer)
        }
        Layer::Edge { x_m, y_m, angle_turns, width_m, level_n, ridge_n, click } if cfg!(feature = "edge") => {
            lengths(ConfigField::Shape, [x_m, y_m], layer)?;
            within(ConfigField::Shape, width_m, WIDTH_MIN_M, LENGTH_MAX_M, layer)?;
            angle(angle_turns, layer)?;
            frictions([level_n, ridge_n, click.height_n], layer)?;
            within(ConfigField::Duration, click.decay_s, 0.0, CLICK_MAX_S, layer)
        }
        Layer::Button { rim_width_m, rim_n, face_n, click } if cfg!(feature = "edge") => {
            within(ConfigField::Shape, rim_width_m, WIDTH_MIN_M, LENGTH_MAX_M, layer)?;
            frictions([rim_n, face_n, click.height_n], layer)?;
            within(ConfigField::Duration, click.decay_s, 0.0, CLICK_MAX_S, layer)
        }
        Layer::Vibration { frequency_hz, low_n, high_n, burst, .. } if cfg!(feature = "vibration") => {
            within(ConfigField::VibrationFrequency, frequency_hz, 0.01, 1000.0, layer)?;
            within(ConfigField::Duration, burst.period_s, 0.0, BURST_MAX_S, layer)?;
            within(ConfigField::Duration, burst.on_s, 0.0, burst.period_s, layer)?;
            within(ConfigField::Duration, burst.ramp_s, 0.0, 0.5 * burst.on_s, layer)?;
            frictions([low_n, high_n], layer)
        }
        Layer::Speed { first, count } if cfg!(feature = "speed") => check_curve(points(scene, first, count), layer),
        Layer::Stream { low_n, high_n } if cfg!(feature = "stream") => frictions([low_n, high_n], layer),
        // Left out: refused when it is read.
        _ => Ok(()),
    }
}

/// Speeds rise from point to point.
#[inline]
fn check_curve(points: impl Iterator<Item = Point>, layer: u8) -> Result<(), ConfigRefusal> {
    let mut least_m_per_s = 0.0;
    for point in points {
        within(ConfigField::CurveSpeed, point.x, least_m_per_s, SPEED_MAX_M_PER_S, layer)?;
        frictions([point.y], layer)?;
        least_m_per_s = point.x + SPEED_STEP_MIN_M_PER_S;
    }
    Ok(())
}

#[inline]
fn points(scene: &Scene, first: u8, count: u8) -> impl Iterator<Item = Point> {
    scene.points().skip(usize::from(first)).take(usize::from(count))
}

#[inline]
fn frictions<const N: usize>(found: [f32; N], layer: u8) -> Result<(), ConfigRefusal> {
    let mut found = found.into_iter();
    found.try_for_each(|found| within(ConfigField::Friction, found, -FRICTION_MAX_N, FRICTION_MAX_N, layer))
}

#[inline]
fn lengths(field: ConfigField, found: [f32; 2], layer: u8) -> Result<(), ConfigRefusal> {
    found.into_iter().try_for_each(|found| within(field, found, -LENGTH_MAX_M, LENGTH_MAX_M, layer))
}

#[inline]
fn sizes(field: ConfigField, found: [f32; 2], layer: u8) -> Result<(), ConfigRefusal> {
    found.into_iter().try_for_each(|found| within(field, found, SIZE_MIN_M, LENGTH_MAX_M, layer))
}

#[inline]
fn angle(found: f32, layer: u8) -> Result<(), ConfigRefusal> {
    within(ConfigField::Angle, found, -1.0, 1.0, layer)
}
