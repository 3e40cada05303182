//! The friction that a program wants, evaluated in `f64` and independently of the firmware.

use std::f64::consts::TAU;

use frixel_wire::scene::{Blend, Layer, Record, Region, Wave};

use crate::scene::Program;

/// Evaluates the friction that a program wants at a place on the screen.
///
/// What is wanted is defined by the compiled program: frictions as rounded to `f32`, pictures as resampled. It is
/// not clipped to what can be reached.
#[derive(Clone, Debug)]
pub struct Wanted {
    natural_friction_n: f64,
    pieces: Vec<Piece>,
}

/// A record made ready to be evaluated; its gain is multiplied in.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub(crate) left_m: f64,
    pub(crate) top_m: f64,
    pub(crate) right_m: f64,
    pub(crate) bottom_m: f64,
    pub(crate) adds: bool,
    pub(crate) field: Field,
}

/// Electric friction over the plane, in newtons.
#[derive(Clone, Debug)]
pub(crate) enum Field {
    Constant(f64),
    Grating(Grating),
    Samples(Samples),
}

/// Stripes.
#[derive(Clone, Debug)]
pub(crate) struct Grating {
    pub(crate) wave: Wave,
    pub(crate) cycles_per_m_x: f64,
    pub(crate) cycles_per_m_y: f64,
    pub(crate) phase_turns: f64,
    pub(crate) trough_n: f64,
    pub(crate) span_n: f64,
}

/// A picture's samples.
#[derive(Clone, Debug)]
pub(crate) struct Samples {
    pub(crate) x_m: f64,
    pub(crate) y_m: f64,
    pub(crate) pitch_m: f64,
    pub(crate) width: usize,
    pub(crate) height: usize,
    samples_per_m: f64,
    black_n: f64,
    step_n: f64,
    bytes: Vec<u8>,
}

impl Wanted {
    /// Makes a program ready to be evaluated.
    pub fn new(program: &Program) -> Self {
        let pieces = program.records.iter().map(|record| Piece::new(record, program)).collect();
        let natural_friction_n =
            f64::from(program.header.friction_coefficient) * f64::from(program.header.normal_load_n);
        Self { natural_friction_n, pieces }
    }

    /// Friction at no voltage, `mu F_N`, in newtons.
    pub fn natural_friction_n(&self) -> f64 {
        self.natural_friction_n
    }

    /// Electric friction that is wanted at a place, in metres from the screen's top left corner, in newtons. It may
    /// be out of reach. It is not-a-number where a record names a bitmap that the program does not have.
    pub fn electric_friction_n(&self, x_m: f64, y_m: f64) -> f64 {
        let mut friction_n = 0.0;
        // From the top down: what a replacing layer covers need not be known.
        for piece in self.pieces.iter().rev() {
            if piece.covers(x_m, y_m) {
                friction_n += piece.field.at(x_m, y_m);
                if !piece.adds {
                    break;
                }
            }
        }
        friction_n
    }

    /// The layers, the first one at the bottom.
    pub(crate) fn pieces(&self) -> &[Piece] {
        &self.pieces
    }
}

impl Piece {
    fn new(record: &Record, program: &Program) -> Self {
        let (left_m, top_m, right_m, bottom_m) = match record.region {
            Region::Screen => (f64::NEG_INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY),
            Region::Rectangle { x_m, y_m, width_m, height_m } => {
                let (left_m, top_m) = (f64::from(x_m), f64::from(y_m));
                (left_m, top_m, left_m + f64::from(width_m), top_m + f64::from(height_m))
            }
        };
        let gain = f64::from(record.gain);
        let field = match record.layer {
            Layer::Constant { electric_friction_n } => Field::Constant(gain * f64::from(electric_friction_n)),
            Layer::Stream { low_n, .. } => Field::Constant(gain * f64::from(low_n)),
            Layer::Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n } => {
                Field::Grating(Grating {
                    wave,
                    cycles_per_m_x: f64::from(cycles_per_m_x),
                    cycles_per_m_y: f64::from(cycles_per_m_y),
                    phase_turns: f64::from(phase_turns),
                    trough_n: gain * f64::from(trough_n),
                    span_n: gain * (f64::from(crest_n) - f64::from(trough_n)),
                })
            }
            Layer::Bitmap { crc32, x_m, y_m, pitch_m, black_n, white_n } => {
                let bitmap = program.bitmap(crc32).filter(|bitmap| bitmap.width > 0 && bitmap.height > 0);
                bitmap.map_or(Field::Constant(f64::NAN), |bitmap| {
                    Field::Samples(Samples {
                        x_m: f64::from(x_m),
                        y_m: f64::from(y_m),
                        pitch_m: f64::from(pitch_m),
                        samples_per_m: 1.0 / f64::from(pitch_m),
                        width: usize::from(bitmap.width),
                        height: usize::from(bitmap.height),
                        black_n: gain * f64::from(black_n),
                        step_n: gain * (f64::from(white_n) - f64::from(black_n)) / 255.0,
                        bytes: bitmap.samples.clone(),
                    })
                })
            }
        };
        Self { left_m, top_m, right_m, bottom_m, adds: record.blend == Blend::Add, field }
    }

    /// Left and top edge belong to a layer, right and bottom do not.
    pub(crate) fn covers(&self, x_m: f64, y_m: f64) -> bool {
        x_m >= self.left_m && x_m < self.right_m && y_m >= self.top_m && y_m < self.bottom_m
    }
}

impl Field {
    /// Electric friction at a place, in newtons.
    pub(crate) fn at(&self, x_m: f64, y_m: f64) -> f64 {
        match self {
            Self::Constant(friction_n) => *friction_n,
            Self::Grating(grating) => grating.at_turns(grating.turns(x_m, y_m)),
            Self::Samples(samples) => samples.at(x_m, y_m),
        }
    }
}

impl Grating {
    /// Phase at a place, in turns.
    pub(crate) fn turns(&self, x_m: f64, y_m: f64) -> f64 {
        self.cycles_per_m_x * x_m + self.cycles_per_m_y * y_m + self.phase_turns
    }

    /// Electric friction at a phase, in newtons.
    pub(crate) fn at_turns(&self, turns: f64) -> f64 {
        // Towards zero first: a cast is faster than a floor, and no screen has 2^53 stripes.
        let part = turns - (turns as i64) as f64;
        let turn = if part < 0.0 { part + 1.0 } else { part };
        let wave = match self.wave {
            Wave::Sine => 0.5 + 0.5 * libm::sin(TAU * turn),
            Wave::Square => f64::from(u8::from(turn < 0.5)),
        };
        self.trough_n + self.span_n * wave
    }
}

impl Samples {
    /// Bilinear between the samples' centres, held at the border.
    fn at(&self, x_m: f64, y_m: f64) -> f64 {
        let (column, right) = between((x_m - self.x_m) * self.samples_per_m - 0.5, self.width);
        let (row, below) = between((y_m - self.y_m) * self.samples_per_m - 0.5, self.height);
        let next_column = (column + 1).min(self.width - 1);
        let next_row = (row + 1).min(self.height - 1);
        let upper = mix(self.sample(column, row), self.sample(next_column, row), right);
        let lower = mix(self.sample(column, next_row), self.sample(next_column, next_row), right);
        self.black_n + self.step_n * mix(upper, lower, below)
    }

    fn sample(&self, column: usize, row: usize) -> f64 {
        self.bytes.get(row * self.width + column).map_or(f64::NAN, |sample| f64::from(*sample))
    }
}

/// The sample before a position in samples, and how far the position lies behind it.
fn between(position: f64, samples: usize) -> (usize, f64) {
    let held = position.clamp(0.0, (samples - 1) as f64);
    let before = held as usize;
    (before, held - before as f64)
}

fn mix(one: f64, other: f64, part: f64) -> f64 {
    one + (other - one) * part
}
