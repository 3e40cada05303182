//! A picture of samples at a pitch: bilinear between their centres, rotated about its corner, and held at its border or
//! tiled.

use frixel_wire::message::Refusal;

use crate::context::Context;
use crate::cosine::{centred, direction};
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, measured_cost};
use crate::parameters::{parameters, range};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::ActiveRegion;

parameters! {
    /// A picture of samples at a pitch, bilinear between their centres.
    pub struct Bitmap {
        /// CRC-32 of the samples: the bitmap's name in the pool.
        crc32: u32 = 52,
        /// x of the first sample's corner, m.
        x_m: f32 = 24 in range::BITMAP_PLACE_M,
        /// y of the first sample's corner, m.
        y_m: f32 = 28 in range::BITMAP_PLACE_M,
        /// Spacing of samples in a row, m.
        pitch_m: f32 = 32 in range::PITCH_M,
        /// Electric friction of sample 0, N.
        black_n: f32 = 36 in range::FRICTION_N,
        /// Electric friction of sample 255, N.
        white_n: f32 = 40 in range::FRICTION_N,
        /// Spacing of rows, m.
        pitch_y_m: f32 = 44 in range::PITCH_M,
        /// Rotation of the rows about that corner, from x towards y, in turns.
        angle_turns: f32 = 48 in range::ANGLE_TURNS,
        /// Whether the picture is repeated in both directions. Otherwise the samples at its border extend outwards.
        tiled: bool = 3,
    }
}

impl Kind for Bitmap {
    type Coefficients = BitmapCoefficients;

    fn cost(&self) -> Cost {
        if self.tiled { const { measured_cost("bitmap_tiled") } } else { const { measured_cost("bitmap") } }
    }

    fn bounds(&self, _points: &[Point]) -> Interval<f32> {
        Interval::of([self.black_n, self.white_n])
    }

    fn bitmap_crc32(&self) -> Option<u32> {
        Some(self.crc32)
    }

    fn prepare(&self, _layer: u8, preparation: &mut Preparation) -> Result<BitmapCoefficients, Refusal> {
        let crc32 = self.crc32;
        let samples = (preparation.find_bitmap)(crc32).ok_or(Refusal::BitmapMissing { crc32 })?;
        let (along_x, along_y) = direction(self.angle_turns);
        let (across, down) = (0.5 * self.pitch_m, 0.5 * self.pitch_y_m);
        let (columns_per_m, rows_per_m) = (1.0 / self.pitch_m, 1.0 / self.pitch_y_m);
        Ok(BitmapCoefficients {
            offset: samples.offset,
            width: samples.width,
            height: samples.height,
            tiled: self.tiled,
            x_m: self.x_m + (across * along_x - down * along_y),
            y_m: self.y_m + (across * along_y + down * along_x),
            columns_per_m: [columns_per_m * along_x, columns_per_m * along_y],
            rows_per_m: [-rows_per_m * along_y, rows_per_m * along_x],
            black_n: self.black_n,
            per_level_n: (self.white_n - self.black_n) / 255.0,
        })
    }
}

/// The location of the samples in the pool, and the mapping from the screen to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BitmapCoefficients {
    offset: u32,
    width: u16,
    height: u16,
    tiled: bool,
    /// Position of the first sample's centre, in m.
    x_m: f32,
    y_m: f32,
    /// Samples along a row, and rows, per metre along x and y.
    columns_per_m: [f32; 2],
    rows_per_m: [f32; 2],
    black_n: f32,
    per_level_n: f32,
}

impl Evaluate for BitmapCoefficients {
    #[inline]
    fn electric_friction_n(&self, _region: &ActiveRegion, context: &mut Context) -> f32 {
        let [x_m, y_m] = context.inputs.place_m;
        let (x_m, y_m) = (x_m - self.x_m, y_m - self.y_m);
        let position = |[per_m_x, per_m_y]: [f32; 2]| x_m * per_m_x + y_m * per_m_y;
        let neighbours = |position, count| {
            if self.tiled { neighbours_tiled(position, count) } else { neighbours_held(position, count) }
        };
        let (column, next_column, right) = neighbours(position(self.columns_per_m), self.width);
        let (row, next_row, down) = neighbours(position(self.rows_per_m), self.height);
        let first = self.offset as usize + row * usize::from(self.width);
        let second = self.offset as usize + next_row * usize::from(self.width);
        let level = |row: usize, column: usize| f32::from(context.pool.sample(row + column));
        let upper = mix(level(first, column), level(first, next_column), right);
        let lower = mix(level(second, column), level(second, next_column), right);
        self.black_n + self.per_level_n * mix(upper, lower, down)
    }
}

/// The samples before and after a position, and the fraction of the interval between them. Positions are clamped to the
/// border.
#[inline]
fn neighbours_held(position: f32, count: u16) -> (usize, usize, f32) {
    let last = u32::from(count.saturating_sub(1));
    let position = if position > 0.0 { position } else { 0.0 };
    // Beyond the last sample, both are the last one, so the fraction has no effect.
    let index = (position as u32).min(last);
    (index as usize, (index + 1).min(last) as usize, position - index as f32)
}

/// As [`neighbours_held`], but the first sample follows the last.
#[inline]
fn neighbours_tiled(position: f32, count: u16) -> (usize, usize, f32) {
    let count = u32::from(count);
    let tile = centred(position / count as f32);
    let position = count as f32 * if tile < 0.0 { tile + 1.0 } else { tile };
    let index = (position as u32).min(count.saturating_sub(1));
    let next = if index + 1 < count { index + 1 } else { 0 };
    (index as usize, next as usize, position - index as f32)
}

#[inline]
fn mix(from: f32, to: f32, part: f32) -> f32 {
    from + part * (to - from)
}
