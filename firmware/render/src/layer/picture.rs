//! A bitmap under the finger.

use super::direction;
use crate::bitmap_pool::{Bitmap, BitmapPool};
use crate::turns;

/// Samples at a pitch, bilinear between their centres, turned about their corner, held at the border or tiled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Picture {
    offset: u32,
    width: u16,
    height: u16,
    tiled: bool,
    /// Place of the first sample's centre, in m.
    x_m: f32,
    y_m: f32,
    /// Samples along a row, and rows, for each metre along x and y.
    columns_per_m: [f32; 2],
    rows_per_m: [f32; 2],
    black_n: f32,
    per_level_n: f32,
}

/// Where a picture lies and how its samples do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    /// The corner that the first sample begins at.
    pub(super) x_m: f32,
    pub(super) y_m: f32,
    /// Distance of samples in a row, and of rows.
    pub(super) pitch_m: f32,
    pub(super) pitch_y_m: f32,
    /// How far it is turned about that corner.
    pub(super) angle_turns: f32,
    pub(super) tiled: bool,
}

impl Picture {
    pub(super) fn new(bitmap: Bitmap, place: &Placement, [black_n, white_n]: [f32; 2]) -> Self {
        let (along_x, along_y) = direction(place.angle_turns);
        let (across, down) = (0.5 * place.pitch_m, 0.5 * place.pitch_y_m);
        let (columns_per_m, rows_per_m) = (1.0 / place.pitch_m, 1.0 / place.pitch_y_m);
        Self {
            offset: bitmap.offset,
            width: bitmap.width,
            height: bitmap.height,
            tiled: place.tiled,
            x_m: place.x_m + (across * along_x - down * along_y),
            y_m: place.y_m + (across * along_y + down * along_x),
            columns_per_m: [columns_per_m * along_x, columns_per_m * along_y],
            rows_per_m: [-rows_per_m * along_y, rows_per_m * along_x],
            black_n,
            per_level_n: (white_n - black_n) / 255.0,
        }
    }

    /// Electric friction at a place, in N.
    #[inline(never)]
    pub(crate) fn electric_friction_n(&self, [x_m, y_m]: [f32; 2], pool: &BitmapPool) -> f32 {
        let (x_m, y_m) = (x_m - self.x_m, y_m - self.y_m);
        let place = |[per_m_x, per_m_y]: [f32; 2]| x_m * per_m_x + y_m * per_m_y;
        let neighbours = |place, count| {
            if self.tiled { neighbours_in_tiles(place, count) } else { neighbours_held(place, count) }
        };
        let (column, next_column, right) = neighbours(place(self.columns_per_m), self.width);
        let (row, next_row, down) = neighbours(place(self.rows_per_m), self.height);
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
fn neighbours_held(place: f32, count: u16) -> (usize, usize, f32) {
    let last = u32::from(count.saturating_sub(1));
    let place = if place > 0.0 { place } else { 0.0 };
    // Beyond the last sample both are the last, whatever the distance.
    let index = (place as u32).min(last);
    (index as usize, (index + 1).min(last) as usize, place - index as f32)
}

/// As [`neighbours_held`], with the first sample again behind the last.
#[inline]
fn neighbours_in_tiles(place: f32, count: u16) -> (usize, usize, f32) {
    let count = u32::from(count);
    let tile = turns::centred(place / count as f32);
    let place = count as f32 * if tile < 0.0 { tile + 1.0 } else { tile };
    let index = (place as u32).min(count.saturating_sub(1));
    let next = if index + 1 < count { index + 1 } else { 0 };
    (index as usize, next as usize, place - index as f32)
}

#[inline]
fn mix(from: f32, to: f32, part: f32) -> f32 {
    from + part * (to - from)
}
