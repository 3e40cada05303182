//! A record: one layer of a scene, 56 bytes. All kinds have region, blend and gain in common.
//!
//! Every value has exactly one encoding: bytes not used by a kind are zero. To check this, parsing writes the value
//! again and compares the bytes.

use frixel_wire::bytes::{first_difference, get_at, put_at};
use frixel_wire::message::ConfigRefusal;
use frixel_wire::scene::SceneError;

use crate::blend::Blend;
use crate::kinds::{self, Layer};
use crate::layout::{BLEND_AT, GAIN_AT, KIND_AT, RECORD_LEN, REGION_AT};
use crate::parameters::{Parameter, range};
use crate::point::Point;
use crate::region::{POLYGON, Region};

/// One layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Where the layer acts.
    pub region: Region,
    /// How it is combined with the layers below.
    pub blend: Blend,
    /// Factor on the layer's friction.
    pub gain: f32,
    /// Kind and parameters of the layer.
    pub layer: Layer,
}

impl Record {
    /// The record's bytes.
    pub fn write(&self) -> [u8; RECORD_LEN] {
        let mut bytes = [0; RECORD_LEN];
        put_at(&mut bytes, KIND_AT, [self.layer.number()]);
        put_at(&mut bytes, BLEND_AT, [self.blend.number()]);
        self.gain.write(&mut bytes, GAIN_AT);
        self.region.write(&mut bytes);
        self.layer.write(&mut bytes);
        bytes
    }

    /// Reads a record and checks that it has no other encoding; `number` is its index in the scene, for errors.
    pub fn parse(bytes: &[u8; RECORD_LEN], number: u8) -> Result<Self, SceneError> {
        let record = Self::read(bytes, number)?;
        match first_difference(bytes, &record.write()) {
            None => Ok(record),
            Some(offset) => Err(SceneError::NotZero { record: number, offset }),
        }
    }

    /// [`Record::parse`] for bytes that were parsed before; does not check the encoding.
    pub(crate) fn read(bytes: &[u8; RECORD_LEN], number: u8) -> Result<Self, SceneError> {
        let [kind] = get_at(bytes, KIND_AT);
        let [blend] = get_at(bytes, BLEND_AT);
        let layer = Layer::read(kind, bytes, number)?;
        let blend = Blend::from_number(blend).ok_or(SceneError::UnknownChoice {
            record: number,
            offset: BLEND_AT as u8,
            value: blend,
        })?;
        let gain = f32::from_le_bytes(get_at(bytes, GAIN_AT));
        Ok(Self { region: Region::read(bytes, number)?, blend, gain, layer })
    }

    /// Checks the record's requirements on the scene's points, and its kind's requirements on the region.
    pub(crate) fn check_structure(&self, point_count: u8, record: u8) -> Result<(), SceneError> {
        self.region.check_structure(point_count, record)?;
        self.layer.check_structure(&self.region, point_count, record)
    }

    /// Checks the ranges of all numbers of layer number `layer`; `points` are the scene's.
    pub fn check(&self, points: &[Point], layer: u8) -> Result<(), ConfigRefusal> {
        range::GAIN.check(self.gain, layer)?;
        self.region.check(points, layer)?;
        self.layer.check(points, layer)
    }
}

/// Number of the record that is unknown only because a feature of this crate is disabled.
pub const fn disabled_record(error: &SceneError) -> Option<u8> {
    match *error {
        SceneError::UnknownKind { record, kind } if kinds::is_known(kind) => Some(record),
        SceneError::UnknownChoice { record, offset, value: POLYGON } if offset as usize == REGION_AT => Some(record),
        _ => None,
    }
}
