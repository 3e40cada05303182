//! The friction of each kind of layer, from its meaning in `docs/scene.md` and `PROTOCOL.md`.

use std::f64::consts::TAU;

use frixel_layers::{Beat, Bitmap, Burst, Click, Constant, Layer, Record, Region, Speed, Stream, Wave};

use super::Context;
use super::samples::{Placement, Samples};
use crate::Program;

/// What a layer contributes over plane and time, before its gain: electric friction in newtons, or a factor.
#[derive(Clone, Debug)]
pub(crate) enum Field {
    Constant(f64),
    Grating(Grating),
    Samples(Samples),
    Noise(Noise),
    Edge(Edge),
    Button(Button),
    Vibration(Vibration),
    /// Speeds in m/s, and the factor or friction at each.
    Curve(Vec<(f64, f64)>),
    Stream {
        low_n: f64,
        high_n: f64,
    },
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

/// The mean of some cosines.
#[derive(Clone, Debug)]
pub(crate) struct Noise {
    /// Cycles per metre along x and y, and a phase in turns.
    waves: Vec<[f64; 3]>,
    pub(crate) wavelength_min_m: f64,
    pub(crate) low_n: f64,
    pub(crate) high_n: f64,
}

/// A line with a ridge.
#[derive(Clone, Debug)]
pub(crate) struct Edge {
    place_m: (f64, f64),
    angle_turns: f64,
    pub(crate) width_m: f64,
    level_n: f64,
    ridge_n: f64,
    pub(crate) click: Click,
}

/// A face with a rim.
#[derive(Clone, Debug)]
pub(crate) struct Button {
    middle_m: (f64, f64),
    half_m: (f64, f64),
    round: bool,
    pub(crate) rim_width_m: f64,
    pub(crate) rim_n: f64,
    pub(crate) face_n: f64,
    pub(crate) click: Click,
}

/// Friction that changes with time.
#[derive(Clone, Debug)]
pub(crate) struct Vibration {
    beat: Beat,
    frequency_hz: f64,
    pub(crate) low_n: f64,
    pub(crate) high_n: f64,
    burst: Burst,
}

impl Field {
    pub(super) fn new(record: &Record, program: &Program) -> Self {
        match record.layer {
            Layer::Constant(Constant { electric_friction_n }) => Self::Constant(f64::from(electric_friction_n)),
            Layer::Grating(frixel_layers::Grating {
                wave,
                cycles_per_m_x,
                cycles_per_m_y,
                phase_turns,
                trough_n,
                crest_n,
            }) => Self::Grating(Grating {
                wave,
                cycles_per_m_x: f64::from(cycles_per_m_x),
                cycles_per_m_y: f64::from(cycles_per_m_y),
                phase_turns: f64::from(phase_turns),
                trough_n: f64::from(trough_n),
                span_n: f64::from(crest_n) - f64::from(trough_n),
            }),
            Layer::Bitmap(Bitmap { crc32, x_m, y_m, pitch_m, black_n, white_n, pitch_y_m, angle_turns, tiled }) => {
                let bitmap = program.bitmap(crc32).filter(|bitmap| bitmap.width > 0 && bitmap.height > 0);
                let place = Placement { corner_m: (x_m, y_m), pitches_m: (pitch_m, pitch_y_m), angle_turns, tiled };
                bitmap.map_or(Self::Constant(f64::NAN), |bitmap| {
                    Self::Samples(Samples::new(bitmap, &place, f64::from(black_n), f64::from(white_n)))
                })
            }
            Layer::Noise(frixel_layers::Noise { seed, wavelength_min_m, wavelength_max_m, low_n, high_n }) => {
                let wavelengths_m = (f64::from(wavelength_min_m), f64::from(wavelength_max_m));
                Self::Noise(Noise::new(seed, wavelengths_m, f64::from(low_n), f64::from(high_n)))
            }
            Layer::Edge(frixel_layers::Edge { x_m, y_m, angle_turns, width_m, level_n, ridge_n, click }) => {
                Self::Edge(Edge {
                    place_m: (f64::from(x_m), f64::from(y_m)),
                    angle_turns: f64::from(angle_turns),
                    width_m: f64::from(width_m),
                    level_n: f64::from(level_n),
                    ridge_n: f64::from(ridge_n),
                    click,
                })
            }
            Layer::Button(frixel_layers::Button { rim_width_m, rim_n, face_n, click }) => {
                Self::Button(Button::new(record.region, [rim_width_m, rim_n, face_n], click))
            }
            Layer::Vibration(frixel_layers::Vibration { beat, frequency_hz, low_n, high_n, burst }) => {
                Self::Vibration(Vibration {
                    beat,
                    frequency_hz: f64::from(frequency_hz),
                    low_n: f64::from(low_n),
                    high_n: f64::from(high_n),
                    burst,
                })
            }
            Layer::Speed(Speed { first, count }) => {
                let own = program.points.iter().skip(usize::from(first)).take(usize::from(count));
                Self::Curve(own.map(|point| (f64::from(point.x), f64::from(point.y))).collect())
            }
            Layer::Stream(Stream { low_n, high_n }) => {
                Self::Stream { low_n: f64::from(low_n), high_n: f64::from(high_n) }
            }
        }
    }

    /// The layer's contribution in a context, without clicks.
    pub(crate) fn at(&self, context: &Context) -> f64 {
        match self {
            Self::Constant(friction_n) => *friction_n,
            Self::Grating(grating) => grating.at_turns(grating.turns(context.x_m, context.y_m)),
            Self::Samples(samples) => samples.at(context.x_m, context.y_m),
            Self::Noise(noise) => noise.at(context.x_m, context.y_m),
            Self::Edge(edge) => edge.at_distance(edge.distance_m(context.x_m, context.y_m)),
            Self::Button(button) => button.at(context.x_m, context.y_m),
            Self::Vibration(vibration) => vibration.at(context.t_s),
            Self::Curve(points) => curve(points, context.speed_m_per_s),
            Self::Stream { low_n, high_n } => low_n + (high_n - low_n) * context.stream,
        }
    }

    /// The click of an edge or a button.
    pub(crate) fn click(&self) -> Option<Click> {
        match self {
            Self::Edge(Edge { click, .. }) | Self::Button(Button { click, .. }) => {
                Some(*click).filter(|click| click.height_n.abs() > 0.0)
            }
            _ => None,
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
            Wave::Square { duty } => f64::from(u8::from(turn < f64::from(duty))),
            Wave::Triangle => (2.0 * turn).min(2.0 - 2.0 * turn),
            Wave::Saw => turn,
        };
        self.trough_n + self.span_n * wave
    }
}

impl Noise {
    fn new(seed: u32, (wavelength_min_m, wavelength_max_m): (f64, f64), low_n: f64, high_n: f64) -> Self {
        let waves = (0..8).map(|wave| {
            let draw = |number: u32| drawn(seed.wrapping_add(0x9e37_79b9_u32.wrapping_mul(3 * wave + number)));
            let direction = TAU * (f64::from(wave) + draw(1)) / 16.0;
            let part = (f64::from(5 * wave % 8) + draw(2)) / 8.0;
            let cycles_per_m = (1.0 - part) / wavelength_max_m + part / wavelength_min_m;
            [cycles_per_m * libm::cos(direction), cycles_per_m * libm::sin(direction), draw(3)]
        });
        Self { waves: waves.collect(), wavelength_min_m, low_n, high_n }
    }

    fn at(&self, x_m: f64, y_m: f64) -> f64 {
        let wave = |[x, y, phase]: &[f64; 3]| libm::cos(TAU * (x * x_m + y * y_m + phase));
        let mean = self.waves.iter().map(wave).sum::<f64>() / self.waves.len() as f64;
        f64::midpoint(self.low_n, self.high_n) + 0.5 * (self.high_n - self.low_n) * mean
    }
}

/// The fraction that the hash of `PROTOCOL.md` has for a number.
fn drawn(number: u32) -> f64 {
    let mut v = u64::from(number);
    for (shift, factor) in [(16, 0x7feb_352d), (15, 0x846c_a68b), (16, 1)] {
        v = ((v ^ (v >> shift)) * factor) & 0xffff_ffff;
    }
    (v / 256) as f64 / 16_777_216.0
}

impl Edge {
    /// How far beyond the line a place is, m.
    pub(crate) fn distance_m(&self, x_m: f64, y_m: f64) -> f64 {
        let (across_x, across_y) = (libm::cos(TAU * self.angle_turns), libm::sin(TAU * self.angle_turns));
        (x_m - self.place_m.0) * across_x + (y_m - self.place_m.1) * across_y
    }

    pub(crate) fn at_distance(&self, distance_m: f64) -> f64 {
        let part = (distance_m / self.width_m).clamp(-0.5, 0.5);
        let height = libm::cos(0.5 * TAU * part);
        self.level_n + (self.ridge_n - self.level_n) * height * height
    }
}

impl Button {
    fn new(region: Region, [rim_width_m, rim_n, face_n]: [f32; 3], click: Click) -> Self {
        let (x_m, y_m, width_m, height_m, round) = match region {
            Region::Rectangle { x_m, y_m, width_m, height_m } => (x_m, y_m, width_m, height_m, false),
            Region::Ellipse { x_m, y_m, width_m, height_m } => (x_m, y_m, width_m, height_m, true),
            Region::Screen | Region::Polygon { .. } => (f32::NAN, f32::NAN, f32::NAN, f32::NAN, false),
        };
        let half_m = (0.5 * f64::from(width_m), 0.5 * f64::from(height_m));
        Self {
            middle_m: (f64::from(x_m) + half_m.0, f64::from(y_m) + half_m.1),
            half_m,
            round,
            rim_width_m: f64::from(rim_width_m),
            rim_n: f64::from(rim_n),
            face_n: f64::from(face_n),
            click,
        }
    }

    fn at(&self, x_m: f64, y_m: f64) -> f64 {
        let (x_m, y_m) = ((x_m - self.middle_m.0).abs(), (y_m - self.middle_m.1).abs());
        let depth_m = if self.round {
            (1.0 - libm::hypot(x_m / self.half_m.0, y_m / self.half_m.1)) * self.half_m.0.min(self.half_m.1)
        } else {
            (self.half_m.0 - x_m).min(self.half_m.1 - y_m)
        };
        let height = libm::sin(0.5 * TAU * (depth_m / self.rim_width_m).clamp(0.0, 1.0));
        self.face_n + (self.rim_n - self.face_n) * height * height
    }
}

impl Vibration {
    fn at(&self, t_s: f64) -> f64 {
        let turn = (self.frequency_hz * t_s).rem_euclid(1.0);
        let wave = match self.beat {
            Beat::Sine => 0.5 + 0.5 * libm::sin(TAU * turn),
            Beat::Square => f64::from(u8::from(turn < 0.5)),
        };
        self.low_n + (self.high_n - self.low_n) * self.envelope(t_s) * wave
    }

    fn envelope(&self, t_s: f64) -> f64 {
        let [period_s, on_s, ramp_s] = [self.burst.period_s, self.burst.on_s, self.burst.ramp_s].map(f64::from);
        if period_s <= 0.0 {
            return 1.0;
        }
        let begun_s = t_s.rem_euclid(period_s);
        if begun_s >= on_s {
            0.0
        } else if ramp_s > 0.0 {
            (begun_s.min(on_s - begun_s) / ramp_s).min(1.0)
        } else {
            1.0
        }
    }
}

fn curve(points: &[(f64, f64)], speed_m_per_s: f64) -> f64 {
    let after = points.partition_point(|(speed, _)| *speed <= speed_m_per_s);
    let (before, after) = (points.get(after.wrapping_sub(1)), points.get(after));
    match (before, after) {
        (Some((x1, y1)), Some((x2, y2))) => y1 + (y2 - y1) * (speed_m_per_s - x1) / (x2 - x1),
        (Some((_, y)), None) | (None, Some((_, y))) => *y,
        (None, None) => f64::NAN,
    }
}
