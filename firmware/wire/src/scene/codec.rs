//! The bytes of headers and records.
//!
//! A layout has one form for each value: what a kind does not use is zero. Parsing writes the value again and compares.

use super::{
    Blend, Carrier, HEADER_LEN, Header, Layer, RECORD_LEN, RECORDS_MAX, Record, Region, SCENE_VERSION, SceneError, Wave,
};
use crate::bytes::{get_f32, get_u8, get_u16, get_u32, put_f32, put_u8, put_u16, put_u32};

const AUTONOMOUS: u8 = 1;
const PREDICTION: u8 = 1 << 1;

const CARRIER_SQUARE: u8 = 0;
const CARRIER_SINE: u8 = 1;

const KIND_CONSTANT: u8 = 1;
const KIND_GRATING: u8 = 2;
const KIND_BITMAP: u8 = 3;
const KIND_STREAM: u8 = 9;

const REGION_SCREEN: u8 = 0;
const REGION_RECTANGLE: u8 = 1;

const BLEND_REPLACE: u8 = 0;
const BLEND_ADD: u8 = 1;

const WAVE_SINE: u8 = 0;
const WAVE_SQUARE: u8 = 1;

const REGION_AT: usize = 1;
const BLEND_AT: usize = 2;
const WAVE_AT: usize = 3;

impl Header {
    /// The header's bytes in front of `records` records.
    pub fn write(&self, records: u8) -> [u8; HEADER_LEN] {
        let mut b = [0; HEADER_LEN];
        put_u16::<0, _>(&mut b, SCENE_VERSION);
        put_u8::<2, _>(&mut b, records);
        let autonomous = if self.autonomous { AUTONOMOUS } else { 0 };
        let prediction = if self.prediction { PREDICTION } else { 0 };
        put_u8::<3, _>(&mut b, autonomous | prediction);
        put_f32::<4, _>(&mut b, self.screen_width_m);
        put_f32::<8, _>(&mut b, self.screen_height_m);
        put_f32::<12, _>(&mut b, self.finger_radius_m);
        put_f32::<16, _>(&mut b, self.stiffness_pa_per_m);
        put_f32::<20, _>(&mut b, self.friction_coefficient);
        put_f32::<24, _>(&mut b, self.normal_load_n);
        put_f32::<28, _>(&mut b, self.effective_gap_m);
        put_f32::<32, _>(&mut b, self.voltage_max_v_rms);
        put_f32::<36, _>(&mut b, self.voltage_max_v_peak);
        put_f32::<40, _>(&mut b, self.slew_v_per_s);
        put_f32::<44, _>(&mut b, self.carrier_hz);
        put_f32::<48, _>(&mut b, self.host_timeout_s);
        let carrier = match self.carrier {
            Carrier::Square => CARRIER_SQUARE,
            Carrier::Sine => CARRIER_SINE,
        };
        put_u8::<52, _>(&mut b, carrier);
        b
    }

    /// The header, and the number of records that follow it.
    pub fn parse(b: &[u8; HEADER_LEN]) -> Result<(Self, u8), SceneError> {
        let version = get_u16::<0, _>(b);
        if version != SCENE_VERSION {
            return Err(SceneError::Version { found: version });
        }
        let records = get_u8::<2, _>(b);
        if usize::from(records) > RECORDS_MAX {
            return Err(SceneError::TooManyRecords { found: records });
        }
        let flags = get_u8::<3, _>(b);
        if flags & !(AUTONOMOUS | PREDICTION) != 0 {
            return Err(SceneError::UnknownFlags(flags));
        }
        let carrier = match get_u8::<52, _>(b) {
            CARRIER_SQUARE => Carrier::Square,
            CARRIER_SINE => Carrier::Sine,
            other => return Err(SceneError::UnknownCarrier(other)),
        };
        let header = Self {
            screen_width_m: get_f32::<4, _>(b),
            screen_height_m: get_f32::<8, _>(b),
            finger_radius_m: get_f32::<12, _>(b),
            stiffness_pa_per_m: get_f32::<16, _>(b),
            friction_coefficient: get_f32::<20, _>(b),
            normal_load_n: get_f32::<24, _>(b),
            effective_gap_m: get_f32::<28, _>(b),
            voltage_max_v_rms: get_f32::<32, _>(b),
            voltage_max_v_peak: get_f32::<36, _>(b),
            slew_v_per_s: get_f32::<40, _>(b),
            carrier_hz: get_f32::<44, _>(b),
            host_timeout_s: get_f32::<48, _>(b),
            carrier,
            autonomous: flags & AUTONOMOUS != 0,
            prediction: flags & PREDICTION != 0,
        };
        match first_difference(b, &header.write(records)) {
            None => Ok((header, records)),
            Some(offset) => Err(SceneError::NotZero { record: SceneError::HEADER, offset }),
        }
    }
}

impl Record {
    /// The record's bytes.
    pub fn write(&self) -> [u8; RECORD_LEN] {
        let mut b = [0; RECORD_LEN];
        let blend = match self.blend {
            Blend::Replace => BLEND_REPLACE,
            Blend::Add => BLEND_ADD,
        };
        put_u8::<BLEND_AT, _>(&mut b, blend);
        put_f32::<20, _>(&mut b, self.gain);
        self.region.write(&mut b);
        self.layer.write(&mut b);
        b
    }

    /// Reads a record; `number` is its place in the scene, which errors tell again.
    pub fn parse(b: &[u8; RECORD_LEN], number: u8) -> Result<Self, SceneError> {
        let layer = Layer::parse(b, number)?;
        let blend = match get_u8::<BLEND_AT, _>(b) {
            BLEND_REPLACE => Blend::Replace,
            BLEND_ADD => Blend::Add,
            value => return Err(SceneError::UnknownChoice { record: number, offset: BLEND_AT as u8, value }),
        };
        let record = Self { region: Region::parse(b, number)?, blend, gain: get_f32::<20, _>(b), layer };
        match first_difference(b, &record.write()) {
            None => Ok(record),
            Some(offset) => Err(SceneError::NotZero { record: number, offset }),
        }
    }
}

impl Region {
    fn write(&self, b: &mut [u8; RECORD_LEN]) {
        match *self {
            Self::Screen => put_u8::<REGION_AT, _>(b, REGION_SCREEN),
            Self::Rectangle { x_m, y_m, width_m, height_m } => {
                put_u8::<REGION_AT, _>(b, REGION_RECTANGLE);
                put_f32::<4, _>(b, x_m);
                put_f32::<8, _>(b, y_m);
                put_f32::<12, _>(b, width_m);
                put_f32::<16, _>(b, height_m);
            }
        }
    }

    fn parse(b: &[u8; RECORD_LEN], record: u8) -> Result<Self, SceneError> {
        match get_u8::<REGION_AT, _>(b) {
            REGION_SCREEN => Ok(Self::Screen),
            REGION_RECTANGLE => Ok(Self::Rectangle {
                x_m: get_f32::<4, _>(b),
                y_m: get_f32::<8, _>(b),
                width_m: get_f32::<12, _>(b),
                height_m: get_f32::<16, _>(b),
            }),
            value => Err(SceneError::UnknownChoice { record, offset: REGION_AT as u8, value }),
        }
    }
}

impl Layer {
    fn write(&self, b: &mut [u8; RECORD_LEN]) {
        match *self {
            Self::Constant { electric_friction_n } => {
                put_u8::<0, _>(b, KIND_CONSTANT);
                put_f32::<24, _>(b, electric_friction_n);
            }
            Self::Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n } => {
                put_u8::<0, _>(b, KIND_GRATING);
                let wave = match wave {
                    Wave::Sine => WAVE_SINE,
                    Wave::Square => WAVE_SQUARE,
                };
                put_u8::<WAVE_AT, _>(b, wave);
                put_f32::<24, _>(b, cycles_per_m_x);
                put_f32::<28, _>(b, cycles_per_m_y);
                put_f32::<32, _>(b, phase_turns);
                put_f32::<36, _>(b, trough_n);
                put_f32::<40, _>(b, crest_n);
            }
            Self::Bitmap { crc32, x_m, y_m, pitch_m, black_n, white_n } => {
                put_u8::<0, _>(b, KIND_BITMAP);
                put_f32::<24, _>(b, x_m);
                put_f32::<28, _>(b, y_m);
                put_f32::<32, _>(b, pitch_m);
                put_f32::<36, _>(b, black_n);
                put_f32::<40, _>(b, white_n);
                put_u32::<52, _>(b, crc32);
            }
            Self::Stream { low_n, high_n } => {
                put_u8::<0, _>(b, KIND_STREAM);
                put_f32::<24, _>(b, low_n);
                put_f32::<28, _>(b, high_n);
            }
        }
    }

    fn parse(b: &[u8; RECORD_LEN], record: u8) -> Result<Self, SceneError> {
        match get_u8::<0, _>(b) {
            KIND_CONSTANT => Ok(Self::Constant { electric_friction_n: get_f32::<24, _>(b) }),
            KIND_GRATING => Ok(Self::Grating {
                wave: match get_u8::<WAVE_AT, _>(b) {
                    WAVE_SINE => Wave::Sine,
                    WAVE_SQUARE => Wave::Square,
                    value => return Err(SceneError::UnknownChoice { record, offset: WAVE_AT as u8, value }),
                },
                cycles_per_m_x: get_f32::<24, _>(b),
                cycles_per_m_y: get_f32::<28, _>(b),
                phase_turns: get_f32::<32, _>(b),
                trough_n: get_f32::<36, _>(b),
                crest_n: get_f32::<40, _>(b),
            }),
            KIND_BITMAP => Ok(Self::Bitmap {
                crc32: get_u32::<52, _>(b),
                x_m: get_f32::<24, _>(b),
                y_m: get_f32::<28, _>(b),
                pitch_m: get_f32::<32, _>(b),
                black_n: get_f32::<36, _>(b),
                white_n: get_f32::<40, _>(b),
            }),
            KIND_STREAM => Ok(Self::Stream { low_n: get_f32::<24, _>(b), high_n: get_f32::<28, _>(b) }),
            kind => Err(SceneError::UnknownKind { record, kind }),
        }
    }
}

/// Offset of the first byte in which two layouts differ.
fn first_difference<const LEN: usize>(found: &[u8; LEN], canonical: &[u8; LEN]) -> Option<u8> {
    found.iter().zip(canonical).position(|(a, b)| a != b).map(|offset| offset as u8)
}
