//! The bytes of the header.

use super::first_difference;
use crate::bytes::{get_f32, get_u8, get_u16, put_f32, put_u8, put_u16};
use crate::scene::{Carrier, HEADER_LEN, Header, Leader, POINTS_MAX, RECORDS_MAX, SCENE_VERSION, SceneError};

const AUTONOMOUS: u8 = 1;
const PREDICTION: u8 = 1 << 1;
const LEADER_LATEST: u8 = 1 << 2;
const LAYERS_FIXED: u8 = 1 << 3;

const CARRIER_SQUARE: u8 = 0;
const CARRIER_SINE: u8 = 1;

impl Header {
    /// The header's bytes in front of `records` records and `points` points.
    pub fn write(&self, records: u8, points: u8) -> [u8; HEADER_LEN] {
        let mut b = [0; HEADER_LEN];
        put_u16::<0, _>(&mut b, SCENE_VERSION);
        put_u8::<2, _>(&mut b, records);
        let autonomous = if self.autonomous { AUTONOMOUS } else { 0 };
        let prediction = if self.prediction { PREDICTION } else { 0 };
        let leader = if self.leader == Leader::Latest { LEADER_LATEST } else { 0 };
        let layers_fixed = if self.layers_fixed { LAYERS_FIXED } else { 0 };
        put_u8::<3, _>(&mut b, autonomous | prediction | leader | layers_fixed);
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
        put_u8::<53, _>(&mut b, points);
        b
    }

    /// The header, and how many records and points follow it.
    pub fn parse(b: &[u8; HEADER_LEN]) -> Result<(Self, u8, u8), SceneError> {
        let version = get_u16::<0, _>(b);
        if version != SCENE_VERSION {
            return Err(SceneError::Version { found: version });
        }
        let records = get_u8::<2, _>(b);
        if usize::from(records) > RECORDS_MAX {
            return Err(SceneError::TooManyRecords { found: records });
        }
        let points = get_u8::<53, _>(b);
        if usize::from(points) > POINTS_MAX {
            return Err(SceneError::TooManyPoints { found: points });
        }
        let flags = get_u8::<3, _>(b);
        if flags & !(AUTONOMOUS | PREDICTION | LEADER_LATEST | LAYERS_FIXED) != 0 {
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
            leader: if flags & LEADER_LATEST == 0 { Leader::First } else { Leader::Latest },
            layers_fixed: flags & LAYERS_FIXED != 0,
        };
        match first_difference(b, &header.write(records, points)) {
            None => Ok((header, records, points)),
            Some(offset) => Err(SceneError::NotZero { record: SceneError::HEADER, offset }),
        }
    }
}
