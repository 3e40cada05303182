//! The bytes of a region.

use crate::bytes::{get_f32, get_u8, put_f32, put_u8};
use crate::scene::{RECORD_LEN, Region, SceneError};

const REGION_SCREEN: u8 = 0;
const REGION_RECTANGLE: u8 = 1;
const REGION_ELLIPSE: u8 = 2;
pub(super) const REGION_POLYGON: u8 = 3;

pub(super) const REGION_AT: usize = 1;

impl Region {
    pub(super) fn write(&self, b: &mut [u8; RECORD_LEN]) {
        match *self {
            Self::Screen => put_u8::<REGION_AT, _>(b, REGION_SCREEN),
            Self::Rectangle { x_m, y_m, width_m, height_m } => {
                put_u8::<REGION_AT, _>(b, REGION_RECTANGLE);
                put_box(b, [x_m, y_m, width_m, height_m]);
            }
            Self::Ellipse { x_m, y_m, width_m, height_m } => {
                put_u8::<REGION_AT, _>(b, REGION_ELLIPSE);
                put_box(b, [x_m, y_m, width_m, height_m]);
            }
            Self::Polygon { first, count } if cfg!(feature = "polygon") => {
                put_u8::<REGION_AT, _>(b, REGION_POLYGON);
                put_u8::<4, _>(b, first);
                put_u8::<5, _>(b, count);
            }
            // Left out: nobody reads more of it.
            Self::Polygon { .. } => put_u8::<REGION_AT, _>(b, REGION_POLYGON),
        }
    }

    pub(super) fn parse(b: &[u8; RECORD_LEN], record: u8) -> Result<Self, SceneError> {
        let [x_m, y_m, width_m, height_m] = get_box(b);
        match get_u8::<REGION_AT, _>(b) {
            REGION_SCREEN => Ok(Self::Screen),
            REGION_RECTANGLE => Ok(Self::Rectangle { x_m, y_m, width_m, height_m }),
            REGION_ELLIPSE => Ok(Self::Ellipse { x_m, y_m, width_m, height_m }),
            REGION_POLYGON if cfg!(feature = "polygon") => {
                Ok(Self::Polygon { first: get_u8::<4, _>(b), count: get_u8::<5, _>(b) })
            }
            value => Err(SceneError::UnknownChoice { record, offset: REGION_AT as u8, value }),
        }
    }
}

fn put_box(b: &mut [u8; RECORD_LEN], [x_m, y_m, width_m, height_m]: [f32; 4]) {
    put_f32::<4, _>(b, x_m);
    put_f32::<8, _>(b, y_m);
    put_f32::<12, _>(b, width_m);
    put_f32::<16, _>(b, height_m);
}

fn get_box(b: &[u8; RECORD_LEN]) -> [f32; 4] {
    [get_f32::<4, _>(b), get_f32::<8, _>(b), get_f32::<12, _>(b), get_f32::<16, _>(b)]
}
