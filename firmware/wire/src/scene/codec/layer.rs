//! The bytes of what belongs to a kind of layer. A kind whose feature is off is not read.

use crate::bytes::{get_f32, get_u8, get_u32, put_u8, put_u32};
use crate::scene::{Beat, Burst, Click, Layer, RECORD_LEN, SceneError, Wave};

pub(super) const KIND_CONSTANT: u8 = 1;
const KIND_GRATING: u8 = 2;
const KIND_BITMAP: u8 = 3;
const KIND_NOISE: u8 = 4;
const KIND_EDGE: u8 = 5;
const KIND_BUTTON: u8 = 6;
const KIND_VIBRATION: u8 = 7;
const KIND_SPEED: u8 = 8;
pub(super) const KIND_STREAM: u8 = 9;

const WAVE_SINE: u8 = 0;
const WAVE_SQUARE: u8 = 1;
const WAVE_TRIANGLE: u8 = 2;
const WAVE_SAW: u8 = 3;

const BITMAP_HELD: u8 = 0;
const BITMAP_TILED: u8 = 1;

/// Wave of a grating or a vibration; whether a bitmap is tiled.
const FORM_AT: usize = 3;
/// Parameters that are `f32` stand from here on.
const PARAMETERS_AT: usize = 24;

impl Layer {
    /// The kind's number, which is all that is written of a kind whose feature is off.
    const fn kind(&self) -> u8 {
        match self {
            Self::Constant { .. } => KIND_CONSTANT,
            Self::Grating { .. } => KIND_GRATING,
            Self::Bitmap { .. } => KIND_BITMAP,
            Self::Noise { .. } => KIND_NOISE,
            Self::Edge { .. } => KIND_EDGE,
            Self::Button { .. } => KIND_BUTTON,
            Self::Vibration { .. } => KIND_VIBRATION,
            Self::Speed { .. } => KIND_SPEED,
            Self::Stream { .. } => KIND_STREAM,
        }
    }

    pub(super) fn write(&self, b: &mut [u8; RECORD_LEN]) {
        put_u8::<0, _>(b, self.kind());
        match *self {
            Self::Constant { electric_friction_n } => put(b, &[electric_friction_n]),
            Self::Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n }
                if cfg!(feature = "grating") =>
            {
                let (form, duty) = match wave {
                    Wave::Sine => (WAVE_SINE, 0.0),
                    Wave::Square { duty } => (WAVE_SQUARE, duty),
                    Wave::Triangle => (WAVE_TRIANGLE, 0.0),
                    Wave::Saw => (WAVE_SAW, 0.0),
                };
                put_u8::<FORM_AT, _>(b, form);
                put(b, &[cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n, duty]);
            }
            Self::Bitmap { crc32, x_m, y_m, pitch_m, black_n, white_n, pitch_y_m, angle_turns, tiled }
                if cfg!(feature = "bitmap") =>
            {
                put_u8::<FORM_AT, _>(b, if tiled { BITMAP_TILED } else { BITMAP_HELD });
                put_u32::<52, _>(b, crc32);
                put(b, &[x_m, y_m, pitch_m, black_n, white_n, pitch_y_m, angle_turns]);
            }
            Self::Noise { seed, wavelength_min_m, wavelength_max_m, low_n, high_n } if cfg!(feature = "noise") => {
                put_u32::<52, _>(b, seed);
                put(b, &[wavelength_min_m, wavelength_max_m, low_n, high_n]);
            }
            Self::Edge { x_m, y_m, angle_turns, width_m, level_n, ridge_n, click: Click { height_n, decay_s } }
                if cfg!(feature = "edge") =>
            {
                put(b, &[x_m, y_m, angle_turns, width_m, level_n, ridge_n, height_n, decay_s]);
            }
            Self::Button { rim_width_m, rim_n, face_n, click: Click { height_n, decay_s } }
                if cfg!(feature = "edge") =>
            {
                put(b, &[rim_width_m, rim_n, face_n, height_n, decay_s]);
            }
            Self::Vibration { beat, frequency_hz, low_n, high_n, burst: Burst { period_s, on_s, ramp_s } }
                if cfg!(feature = "vibration") =>
            {
                let form = match beat {
                    Beat::Sine => WAVE_SINE,
                    Beat::Square => WAVE_SQUARE,
                };
                put_u8::<FORM_AT, _>(b, form);
                put(b, &[frequency_hz, low_n, high_n, period_s, on_s, ramp_s]);
            }
            Self::Speed { first, count } if cfg!(feature = "speed") => {
                put_u8::<52, _>(b, first);
                put_u8::<53, _>(b, count);
            }
            Self::Stream { low_n, high_n } if cfg!(feature = "stream") => put(b, &[low_n, high_n]),
            _ => {}
        }
    }

    pub(super) fn parse(b: &[u8; RECORD_LEN], record: u8) -> Result<Self, SceneError> {
        let form = get_u8::<FORM_AT, _>(b);
        let unknown_form = SceneError::UnknownChoice { record, offset: FORM_AT as u8, value: form };
        let [p0, p1, p2, p3, p4, p5, p6, p7] = parameters(b);
        match get_u8::<0, _>(b) {
            KIND_CONSTANT => Ok(Self::Constant { electric_friction_n: p0 }),
            KIND_GRATING if cfg!(feature = "grating") => {
                let wave = match form {
                    WAVE_SINE => Wave::Sine,
                    WAVE_SQUARE => Wave::Square { duty: p5 },
                    WAVE_TRIANGLE => Wave::Triangle,
                    WAVE_SAW => Wave::Saw,
                    _ => return Err(unknown_form),
                };
                let (cycles_per_m_x, cycles_per_m_y, phase_turns) = (p0, p1, p2);
                Ok(Self::Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n: p3, crest_n: p4 })
            }
            KIND_BITMAP if cfg!(feature = "bitmap") => Ok(Self::Bitmap {
                crc32: get_u32::<52, _>(b),
                x_m: p0,
                y_m: p1,
                pitch_m: p2,
                black_n: p3,
                white_n: p4,
                pitch_y_m: p5,
                angle_turns: p6,
                tiled: match form {
                    BITMAP_HELD => false,
                    BITMAP_TILED => true,
                    _ => return Err(unknown_form),
                },
            }),
            KIND_NOISE if cfg!(feature = "noise") => {
                let seed = get_u32::<52, _>(b);
                Ok(Self::Noise { seed, wavelength_min_m: p0, wavelength_max_m: p1, low_n: p2, high_n: p3 })
            }
            KIND_EDGE if cfg!(feature = "edge") => {
                let click = Click { height_n: p6, decay_s: p7 };
                Ok(Self::Edge { x_m: p0, y_m: p1, angle_turns: p2, width_m: p3, level_n: p4, ridge_n: p5, click })
            }
            KIND_BUTTON if cfg!(feature = "edge") => {
                let click = Click { height_n: p3, decay_s: p4 };
                Ok(Self::Button { rim_width_m: p0, rim_n: p1, face_n: p2, click })
            }
            KIND_VIBRATION if cfg!(feature = "vibration") => Ok(Self::Vibration {
                beat: match form {
                    WAVE_SINE => Beat::Sine,
                    WAVE_SQUARE => Beat::Square,
                    _ => return Err(unknown_form),
                },
                frequency_hz: p0,
                low_n: p1,
                high_n: p2,
                burst: Burst { period_s: p3, on_s: p4, ramp_s: p5 },
            }),
            KIND_SPEED if cfg!(feature = "speed") => {
                Ok(Self::Speed { first: get_u8::<52, _>(b), count: get_u8::<53, _>(b) })
            }
            KIND_STREAM if cfg!(feature = "stream") => Ok(Self::Stream { low_n: p0, high_n: p1 }),
            kind => Err(SceneError::UnknownKind { record, kind }),
        }
    }
}

/// Puts the parameters that are `f32`.
fn put(b: &mut [u8; RECORD_LEN], parameters: &[f32]) {
    let (places, _) = b.get_mut(PARAMETERS_AT..).unwrap_or_default().as_chunks_mut();
    for (place, parameter) in places.iter_mut().zip(parameters) {
        *place = parameter.to_le_bytes();
    }
}

fn parameters(b: &[u8; RECORD_LEN]) -> [f32; 8] {
    [
        get_f32::<24, _>(b),
        get_f32::<28, _>(b),
        get_f32::<32, _>(b),
        get_f32::<36, _>(b),
        get_f32::<40, _>(b),
        get_f32::<44, _>(b),
        get_f32::<48, _>(b),
        get_f32::<52, _>(b),
    ]
}
