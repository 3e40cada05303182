//! Points of polygons and curves, stored after a scene's records.

use core::ops::RangeInclusive;

use frixel_wire::bytes::{get_at, put_at};
use frixel_wire::scene::SceneError;

/// Bytes of a point.
pub const POINT_LEN: usize = 8;

const X_AT: usize = 0;
const Y_AT: usize = 4;

/// A point: a polygon's vertex, in m, or a speed in m/s and a curve's value at that speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Place along x, m, or speed, m/s.
    pub x: f32,
    /// Place along y, m, or the curve's value: electric friction in N, or a factor.
    pub y: f32,
}

impl Point {
    /// The point's bytes.
    pub fn write(&self) -> [u8; POINT_LEN] {
        let mut bytes = [0; POINT_LEN];
        put_at(&mut bytes, X_AT, self.x.to_le_bytes());
        put_at(&mut bytes, Y_AT, self.y.to_le_bytes());
        bytes
    }

    /// Reads a point.
    pub fn parse(bytes: &[u8; POINT_LEN]) -> Self {
        Self { x: f32::from_le_bytes(get_at(bytes, X_AT)), y: f32::from_le_bytes(get_at(bytes, Y_AT)) }
    }
}

/// The points that a record refers to, among those of a scene; empty if one of them does not exist.
#[inline]
pub(crate) fn points_of(points: &[Point], first: u8, count: u8) -> &[Point] {
    let first = usize::from(first);
    points.get(first..first + usize::from(count)).unwrap_or_default()
}

/// Checks that a record refers to as many points as its kind accepts, and that the scene has them.
pub(crate) fn check_count(
    first: u8,
    count: u8,
    takes: RangeInclusive<usize>,
    point_count: u8,
    record: u8,
) -> Result<(), SceneError> {
    let fits = usize::from(first) + usize::from(count) <= usize::from(point_count);
    if fits && takes.contains(&usize::from(count)) { Ok(()) } else { Err(SceneError::Points { record, first, count }) }
}
