//! The bytes of a record: what all kinds have.

use super::first_difference;
use crate::bytes::{get_f32, get_u8, put_f32, put_u8};
use crate::scene::{Blend, Layer, RECORD_LEN, Record, Region, SceneError};

const BLEND_REPLACE: u8 = 0;
const BLEND_ADD: u8 = 1;
const BLEND_MULTIPLY: u8 = 2;
const BLEND_MAX: u8 = 3;

const BLEND_AT: usize = 2;

impl Record {
    /// The record's bytes.
    pub fn write(&self) -> [u8; RECORD_LEN] {
        let mut b = [0; RECORD_LEN];
        let blend = match self.blend {
            Blend::Replace => BLEND_REPLACE,
            Blend::Add => BLEND_ADD,
            Blend::Multiply => BLEND_MULTIPLY,
            Blend::Max => BLEND_MAX,
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
            BLEND_MULTIPLY => Blend::Multiply,
            BLEND_MAX => Blend::Max,
            value => return Err(SceneError::UnknownChoice { record: number, offset: BLEND_AT as u8, value }),
        };
        let record = Self { region: Region::parse(b, number)?, blend, gain: get_f32::<20, _>(b), layer };
        match first_difference(b, &record.write()) {
            None => Ok(record),
            Some(offset) => Err(SceneError::NotZero { record: number, offset }),
        }
    }
}
