//! Points of polygons and curves, which stand behind a scene's records.

use super::{CURVE_POINTS_MAX, Layer, POINT_LEN, POLYGON_POINTS_MAX, Record, Region, SceneError};
use crate::bytes::{get_f32, put_f32};

/// A point: a polygon's vertex, in m, or a speed in m/s and what a curve has there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Place along x, m, or speed, m/s.
    pub x: f32,
    /// Place along y, m, or what the curve has there: electric friction in N, or a factor.
    pub y: f32,
}

impl Point {
    /// The point's bytes.
    pub fn write(&self) -> [u8; POINT_LEN] {
        let mut b = [0; POINT_LEN];
        put_f32::<0, _>(&mut b, self.x);
        put_f32::<4, _>(&mut b, self.y);
        b
    }

    /// Reads a point.
    pub fn parse(b: &[u8; POINT_LEN]) -> Self {
        Self { x: get_f32::<0, _>(b), y: get_f32::<4, _>(b) }
    }
}

impl Record {
    /// Checks what one record asks of the rest of the scene, and its kind of its region.
    pub(super) fn check(&self, record: u8, points: u8) -> Result<(), SceneError> {
        let inside = |first: u8, count: u8, least: usize, most: usize| {
            let fits = usize::from(first) + usize::from(count) <= usize::from(points);
            if fits && (least..=most).contains(&usize::from(count)) {
                Ok(())
            } else {
                Err(SceneError::Points { record, first, count })
            }
        };
        if cfg!(feature = "polygon")
            && let Region::Polygon { first, count } = self.region
        {
            inside(first, count, 3, POLYGON_POINTS_MAX)?;
        }
        match (&self.layer, self.region) {
            (Layer::Speed { first, count }, _) if cfg!(feature = "speed") => {
                inside(*first, *count, 2, CURVE_POINTS_MAX)
            }
            (Layer::Button { .. }, Region::Screen | Region::Polygon { .. }) if cfg!(feature = "edge") => {
                Err(SceneError::ButtonRegion { record })
            }
            _ => Ok(()),
        }
    }
}
