//! Random layers of every kind and form, in regions of every shape.

use core::ops::Range;

use frixel_layers::{
    Beat, Bitmap, Blend, Burst, Button, Click, Constant, Edge, Grating, Header, Layer, Noise, Point, Record, Region,
    Rings, Speed, Stream, Vibration, Wave,
};
use frixel_wire::scene::{CURVE_POINTS_MAX, POLYGON_POINTS_MAX};

use crate::random::Random;

/// Largest electric friction for the finger of these scenes, N.
const REACH_N: f32 = 0.027;

/// Points that a record needs, and the first free point number.
pub(crate) struct NewPoints {
    pub(crate) first: u8,
    pub(crate) points: heapless::Vec<Point, { POLYGON_POINTS_MAX + CURVE_POINTS_MAX }>,
}

impl NewPoints {
    fn add(&mut self, points: impl Iterator<Item = Point>) -> Range<u8> {
        let start = self.first + self.points.len() as u8;
        self.points.extend(points);
        start..self.first + self.points.len() as u8
    }
}

/// Constant friction on the whole screen, for layers above to act on.
pub(crate) fn ground(random: &mut Random) -> Record {
    let layer = Layer::Constant(Constant { electric_friction_n: REACH_N * random.between(0.02, 0.6) });
    Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer }
}

/// A random layer above others; its points are added to `points`.
pub(crate) fn record(random: &mut Random, header: &Header, picture: u32, points: &mut NewPoints) -> Record {
    let blend = random.pick([Blend::Replace, Blend::Add, Blend::Add, Blend::Multiply, Blend::Max]);
    let amounts = if blend == Blend::Multiply { Amounts::Factors } else { Amounts::Frictions };
    let layer = layer(random, header, amounts, picture, points);
    let region =
        if matches!(layer, Layer::Button(_)) { box_region(random, header) } else { region(random, header, points) };
    let gain = random.pick([1.0, 1.0, 1.0, 0.5, 0.7, 0.9, 1.7, -0.3, 0.0]);
    Record { region, blend, gain, layer }
}

#[derive(Clone, Copy)]
enum Amounts {
    Frictions,
    Factors,
}

impl Amounts {
    /// Mostly within reach, and occasionally far beyond, below zero, or tiny.
    fn draw(self, random: &mut Random) -> f32 {
        let part = match random.below(30) {
            0 => 0.0,
            1 => random.between(-1.0, 0.0),
            2 => random.between(1.0, 40.0),
            3 => random.between(0.0, 1e-4),
            _ => random.between(0.0, 1.0),
        };
        match self {
            Self::Frictions => REACH_N * part,
            Self::Factors => part,
        }
    }
}

fn layer(random: &mut Random, header: &Header, amounts: Amounts, picture: u32, points: &mut NewPoints) -> Layer {
    let (width_m, height_m) = (header.screen_width_m, header.screen_height_m);
    let [one, other] = [amounts.draw(random), amounts.draw(random)];
    let click = Click { height_n: random.pick([0.0, one, other]), decay_s: random.pick([0.0, 1e-4, 0.02, 1.0]) };
    let turned = random.between(-1.0, 1.0);
    match random.below(Layer::NUMBERS.len() as u32) {
        0 => Layer::Constant(Constant { electric_friction_n: one }),
        1 => Layer::Grating(Grating {
            wave: random.pick([Wave::Sine, Wave::Square { duty: 0.3 }, Wave::Triangle, Wave::Saw]),
            cycles_per_m_x: random.between(-2e3, 2e3),
            cycles_per_m_y: random.between(-2e3, 2e3),
            phase_turns: random.between(-3.0, 3.0),
            trough_n: one,
            crest_n: other,
        }),
        2 => Layer::Bitmap(Bitmap {
            crc32: picture,
            x_m: random.between(-0.5, 1.0) * width_m,
            y_m: random.between(-0.5, 1.0) * height_m,
            pitch_m: random.pick([1e-4, 1e-3, 3e-3]),
            black_n: one,
            white_n: other,
            pitch_y_m: random.pick([1e-4, 1e-3, 3e-3]),
            angle_turns: random.pick([0.0, 0.25, turned]),
            tiled: random.once_in(2),
        }),
        3 => Layer::Noise(Noise {
            seed: random.bits(),
            wavelength_min_m: random.between(5e-5, 2e-3),
            wavelength_max_m: random.between(2e-3, 0.5),
            low_n: one,
            high_n: other,
        }),
        4 => Layer::Edge(Edge {
            x_m: random.between(0.0, 1.0) * width_m,
            y_m: random.between(0.0, 1.0) * height_m,
            angle_turns: random.between(-1.0, 1.0),
            width_m: random.pick([1e-3, 0.02, 0.5]),
            level_n: one,
            ridge_n: other,
            click,
        }),
        5 => Layer::Button(Button { rim_width_m: random.pick([1e-3, 0.01, 0.1]), rim_n: one, face_n: other, click }),
        6 => Layer::Vibration(Vibration {
            beat: random.pick([Beat::Sine, Beat::Square]),
            frequency_hz: random.pick([0.01, 80.0, 1000.0]),
            low_n: one,
            high_n: other,
            burst: random.pick([Burst::default(), Burst { period_s: 0.02, on_s: 0.012, ramp_s: 0.005 }]),
        }),
        7 => {
            let count = 2 + random.below(CURVE_POINTS_MAX as u32 - 1);
            let step_m_per_s = random.pick([1e-3, 0.02, 0.1]);
            let curve = (0..count).map(|number| Point { x: step_m_per_s * number as f32, y: amounts.draw(random) });
            let added = points.add(curve);
            Layer::Speed(Speed { first: added.start, count: added.len() as u8 })
        }
        8 => Layer::Rings(Rings {
            wave: random.pick([Wave::Sine, Wave::Square { duty: 0.3 }, Wave::Triangle, Wave::Saw]),
            x_m: random.between(-0.2, 1.2) * width_m,
            y_m: random.between(-0.2, 1.2) * height_m,
            cycles_per_m: random.between(0.0, 2e3),
            trough_n: one,
            crest_n: other,
        }),
        _ => Layer::Stream(Stream { low_n: one, high_n: other }),
    }
}

fn region(random: &mut Random, header: &Header, points: &mut NewPoints) -> Region {
    match random.below(5) {
        0 => Region::Screen,
        1 => {
            let count = random.pick([3, 4, 5, 7, 10, 16, POLYGON_POINTS_MAX as u32]);
            let [width_m, height_m] = [header.screen_width_m, header.screen_height_m];
            // At any height, so that edges cross; some points are level with one another.
            let level_m = random.between(0.0, 1.0) * height_m;
            let vertices = (0..count).map(|_| Point {
                x: random.between(-0.2, 1.2) * width_m,
                y: if random.once_in(4) { level_m } else { random.between(-0.2, 1.2) * height_m },
            });
            let added = points.add(vertices);
            Region::Polygon { first: added.start, count: added.len() as u8 }
        }
        _ => box_region(random, header),
    }
}

/// From a hundredth of the screen to more than all of it, also beyond its edges.
fn box_region(random: &mut Random, header: &Header) -> Region {
    let mut along = |screen_m: f32| {
        let size_m = screen_m * random.pick([0.01, 0.1, 0.5, 0.9, 1.5]);
        (random.between(-0.5 * size_m, screen_m - 0.5 * size_m), size_m)
    };
    let ((x_m, width_m), (y_m, height_m)) = (along(header.screen_width_m), along(header.screen_height_m));
    if random.once_in(3) {
        Region::Ellipse { x_m, y_m, width_m, height_m }
    } else {
        Region::Rectangle { x_m, y_m, width_m, height_m }
    }
}

#[cfg(test)]
mod tests {
    use frixel_layers::Layer;

    use crate::RandomScene;

    #[test]
    fn every_kind_is_drawn() {
        for kind in Layer::NUMBERS {
            let has_kind = |seed| RandomScene::new(seed, 7).records.iter().any(|record| record.layer.number() == *kind);
            assert!((0..500).any(has_kind), "no random scene has a layer of kind {kind}");
        }
    }
}
