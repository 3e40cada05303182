//! A bitmap under the finger.

use super::Moment;
use crate::bitmap_pool::{Bitmap, BitmapPool};

/// Samples at a pitch, bilinear between their centres, held at the border.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Picture {
    offset: u32,
    width: u16,
    height: u16,
    samples_per_m: f32,
    /// Place of the first sample's centre, in m.
    x_m: f32,
    y_m: f32,
    black_n: f32,
    per_level_n: f32,
}

impl Picture {
    /// `[x_m, y_m]` is the top left corner of the first sample.
    pub(super) fn new(bitmap: Bitmap, [x_m, y_m]: [f32; 2], pitch_m: f32, [black_n, white_n]: [f32; 2]) -> Self {
        Self {
            offset: bitmap.offset,
            width: bitmap.width,
            height: bitmap.height,
            samples_per_m: 1.0 / pitch_m,
            x_m: x_m + 0.5 * pitch_m,
            y_m: y_m + 0.5 * pitch_m,
            black_n,
            per_level_n: (white_n - black_n) / 255.0,
        }
    }

    #[inline]
    pub(super) fn electric_friction_n(&self, moment: &Moment, pool: &BitmapPool) -> f32 {
        let (column, next_column, right) = neighbours((moment.x_m - self.x_m) * self.samples_per_m, self.width);
        let (row, next_row, down) = neighbours((moment.y_m - self.y_m) * self.samples_per_m, self.height);
        let first = self.offset as usize + row * usize::from(self.width);
        let second = self.offset as usize + next_row * usize::from(self.width);
        let level = |row: usize, column: usize| f32::from(pool.sample(row + column));
        let upper = mix(level(first, column), level(first, next_column), right);
        let lower = mix(level(second, column), level(second, next_column), right);
        self.black_n + self.per_level_n * mix(upper, lower, down)
    }
}

/// The two samples on either side of a place, and how far it is from the first to the second. Held at the border.
#[inline]
fn neighbours(place: f32, count: u16) -> (usize, usize, f32) {
    let last = u32::from(count.saturating_sub(1));
    let place = if place > 0.0 { place } else { 0.0 };
    // Beyond the last sample both are the last, whatever the distance.
    let index = (place as u32).min(last);
    (index as usize, (index + 1).min(last) as usize, place - index as f32)
}

#[inline]
fn mix(from: f32, to: f32, part: f32) -> f32 {
    from + part * (to - from)
}
