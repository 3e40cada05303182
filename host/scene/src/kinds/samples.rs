//! A picture's samples.

use std::f64::consts::TAU;

use frixel_layers::Bitmap as Record;

use crate::Bitmap;

/// A picture's samples: bilinear between their centres, rotated about their corner, and held at the border or tiled.
#[derive(Debug)]
pub(super) struct Samples {
    pub(super) x_m: f64,
    pub(super) y_m: f64,
    pub(super) pitch_m: f64,
    pub(super) pitch_y_m: f64,
    angle_turns: f64,
    tiled: bool,
    pub(super) width: u32,
    pub(super) height: u32,
    along_x: f64,
    along_y: f64,
    black_n: f64,
    step_n: f64,
    bytes: Vec<u8>,
}

impl Samples {
    pub(super) fn new(bitmap: &Bitmap, record: &Record) -> Self {
        let angle_turns = f64::from(record.angle_turns);
        let (black_n, white_n) = (f64::from(record.black_n), f64::from(record.white_n));
        Self {
            x_m: f64::from(record.x_m),
            y_m: f64::from(record.y_m),
            pitch_m: f64::from(record.pitch_m),
            pitch_y_m: f64::from(record.pitch_y_m),
            angle_turns,
            tiled: record.tiled,
            width: bitmap.width.into(),
            height: bitmap.height.into(),
            along_x: libm::cos(TAU * angle_turns),
            along_y: libm::sin(TAU * angle_turns),
            black_n,
            step_n: (white_n - black_n) / 255.0,
            bytes: bitmap.samples.clone(),
        }
    }

    pub(super) fn is_turned(&self) -> bool {
        self.angle_turns.abs() > 0.0
    }

    /// Friction at a place, N.
    pub(super) fn at_place(&self, x_m: f64, y_m: f64) -> f64 {
        let (u, v) = self.position(x_m, y_m);
        let (column, next_column, right) = self.between(u, self.width);
        let (row, next_row, below) = self.between(v, self.height);
        let upper = mix(self.sample(column, row), self.sample(next_column, row), right);
        let lower = mix(self.sample(column, next_row), self.sample(next_column, next_row), right);
        self.black_n + self.step_n * mix(upper, lower, below)
    }

    /// Position of a place in units of samples, along a row and across the rows, from the centre of the first sample.
    pub(super) fn position(&self, x_m: f64, y_m: f64) -> (f64, f64) {
        let (x_m, y_m) = (x_m - self.x_m, y_m - self.y_m);
        let along_m = self.along_x * x_m + self.along_y * y_m;
        let across_m = self.along_x * y_m - self.along_y * x_m;
        (along_m / self.pitch_m - 0.5, across_m / self.pitch_y_m - 0.5)
    }

    /// Friction of the samples in these columns and rows. Outside the picture, samples are held at the border or tiled.
    pub(super) fn frictions(
        &self,
        columns: std::ops::RangeInclusive<i64>,
        rows: std::ops::RangeInclusive<i64>,
    ) -> impl Iterator<Item = f64> {
        let index = |number: i64, count: u32| {
            let count = i64::from(count);
            (if self.tiled { number.rem_euclid(count) } else { number.clamp(0, count - 1) }) as u32
        };
        rows.flat_map(move |row| columns.clone().map(move |column| (column, row))).map(move |(column, row)| {
            self.black_n + self.step_n * self.sample(index(column, self.width), index(row, self.height))
        })
    }

    /// The samples before and after a position, and the fraction of the distance between them.
    fn between(&self, position: f64, samples: u32) -> (u32, u32, f64) {
        let last = samples - 1;
        if self.tiled {
            let place = position.rem_euclid(f64::from(samples));
            let before = (place as u32).min(last);
            return (before, if before == last { 0 } else { before + 1 }, place - f64::from(before));
        }
        let held = position.clamp(0.0, f64::from(last));
        let before = held as u32;
        (before, (before + 1).min(last), held - f64::from(before))
    }

    fn sample(&self, column: u32, row: u32) -> f64 {
        self.bytes.get((row * self.width + column) as usize).map_or(f64::NAN, |sample| f64::from(*sample))
    }
}

fn mix(one: f64, other: f64, part: f64) -> f64 {
    one + (other - one) * part
}
