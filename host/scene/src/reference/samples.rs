//! A picture's samples.

use std::f64::consts::TAU;

use crate::Bitmap;

/// A picture's samples, bilinear between their centres, turned about their corner, held at the border or tiled.
#[derive(Clone, Debug)]
pub(crate) struct Samples {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) pitch_m: f64,
    pub(crate) pitch_y_m: f64,
    pub(crate) angle_turns: f64,
    pub(crate) tiled: bool,
    pub(crate) width: usize,
    pub(crate) height: usize,
    along_x: f64,
    along_y: f64,
    black_n: f64,
    step_n: f64,
    bytes: Vec<u8>,
}

/// Where a picture lies: its corner, the distances of samples and of rows, and how far it is turned.
pub(super) struct Placement {
    pub(super) corner_m: (f32, f32),
    pub(super) pitches_m: (f32, f32),
    pub(super) angle_turns: f32,
    pub(super) tiled: bool,
}

impl Samples {
    pub(super) fn new(bitmap: &Bitmap, place: &Placement, black_n: f64, white_n: f64) -> Self {
        let angle_turns = f64::from(place.angle_turns);
        Self {
            x_m: f64::from(place.corner_m.0),
            y_m: f64::from(place.corner_m.1),
            pitch_m: f64::from(place.pitches_m.0),
            pitch_y_m: f64::from(place.pitches_m.1),
            angle_turns,
            tiled: place.tiled,
            width: usize::from(bitmap.width),
            height: usize::from(bitmap.height),
            along_x: libm::cos(TAU * angle_turns),
            along_y: libm::sin(TAU * angle_turns),
            black_n,
            step_n: (white_n - black_n) / 255.0,
            bytes: bitmap.samples.clone(),
        }
    }

    pub(super) fn at(&self, x_m: f64, y_m: f64) -> f64 {
        let (u, v) = self.position(x_m, y_m);
        let (column, next_column, right) = self.between(u, self.width);
        let (row, next_row, below) = self.between(v, self.height);
        let upper = mix(self.sample(column, row), self.sample(next_column, row), right);
        let lower = mix(self.sample(column, next_row), self.sample(next_column, next_row), right);
        self.black_n + self.step_n * mix(upper, lower, below)
    }

    /// A place in samples from the first one's centre, along a row and across the rows.
    pub(crate) fn position(&self, x_m: f64, y_m: f64) -> (f64, f64) {
        let (x_m, y_m) = (x_m - self.x_m, y_m - self.y_m);
        let along_m = self.along_x * x_m + self.along_y * y_m;
        let across_m = self.along_x * y_m - self.along_y * x_m;
        (along_m / self.pitch_m - 0.5, across_m / self.pitch_y_m - 0.5)
    }

    /// Friction of the samples in these columns and rows, which go on beyond the picture as it is held or tiled.
    pub(crate) fn frictions(
        &self,
        columns: std::ops::RangeInclusive<i64>,
        rows: std::ops::RangeInclusive<i64>,
    ) -> impl Iterator<Item = f64> {
        let index = |number: i64, count: usize| {
            let count = count as i64;
            (if self.tiled { number.rem_euclid(count) } else { number.clamp(0, count - 1) }) as usize
        };
        rows.flat_map(move |row| columns.clone().map(move |column| (column, row))).map(move |(column, row)| {
            self.black_n + self.step_n * self.sample(index(column, self.width), index(row, self.height))
        })
    }

    /// The samples before and behind a position, and how far the position lies behind the one before.
    fn between(&self, position: f64, samples: usize) -> (usize, usize, f64) {
        let last = samples - 1;
        if self.tiled {
            let place = position.rem_euclid(samples as f64);
            let before = (place as usize).min(last);
            return (before, if before == last { 0 } else { before + 1 }, place - before as f64);
        }
        let held = position.clamp(0.0, last as f64);
        let before = held as usize;
        (before, (before + 1).min(last), held - before as f64)
    }

    fn sample(&self, column: usize, row: usize) -> f64 {
        self.bytes.get(row * self.width + column).map_or(f64::NAN, |sample| f64::from(*sample))
    }
}

fn mix(one: f64, other: f64, part: f64) -> f64 {
    one + (other - one) * part
}
