//! Random scenes that a board accepts.

use frixel_layers::cost::{Worst, worst_of_scene};
use frixel_layers::{Header, Layer, Leader, Point, Record, Waveform, electric_friction_max_n};
use frixel_wire::hello::{BoardLimits, Core};
use frixel_wire::scene::{POINTS_MAX, RECORDS_MAX};
use heapless::Vec;

use crate::layers::{ground, record};
use crate::random::Random;
use crate::samples::NewPoints;
use crate::scenes::{HEADER, SceneBytes, scene_with_points};

/// Rejected draws after which no further layer is tried: the time that remains in a tick is too short for most layers.
const MISSES_MAX: u32 = 6;
/// Number of noise layers that a board has room for.
const NOISES_MAX: usize = 8;
const CLICKS_MAX: usize = 16;

/// A scene of random layers whose longest tick is within the limit.
pub struct RandomScene {
    /// The header of the scene.
    pub header: Header,
    /// Its layers, the first one at the bottom.
    pub records: Vec<Record, RECORDS_MAX>,
    /// The points that records refer to.
    pub points: Vec<Point, POINTS_MAX>,
}

impl RandomScene {
    /// The scene of `seed`. All of its pictures have the name `picture`.
    pub fn new(seed: u64, picture: u32) -> Self {
        let random = &mut Random::new(seed);
        let mut scene = Self { header: header(random), records: Vec::new(), points: Vec::new() };
        let wanted = random.pick([1, 2, 3, 6, 12, RECORDS_MAX]);
        if !random.once_in(3) {
            // Cannot fail: the list is empty.
            let _ = scene.records.push(ground(random));
        }
        let mut misses = 0;
        while scene.records.len() < wanted && misses < MISSES_MAX {
            if !scene.add(random, picture) {
                misses += 1;
            }
        }
        if scene.header.layers_fixed {
            scene.header.electric_friction_max_n =
                electric_friction_max_n(&scene.header, &scene.records, &scene.points);
        }
        scene
    }

    /// The longest tick, as compiler and loader estimate it.
    pub fn worst_tick(&self) -> Worst {
        worst_of_scene(&self.header, &self.records, &self.points, Core::CortexM4f)
    }

    /// The scene's bytes.
    pub fn bytes(&self) -> SceneBytes {
        scene_with_points(&self.header, &self.records, &self.points)
    }

    /// Draws a layer, and keeps it if a board accepts the scene with it.
    fn add(&mut self, random: &mut Random, picture: u32) -> bool {
        let mut new = NewPoints { first: self.points.len() as u8, points: Vec::new() };
        let record = record(random, &self.header, picture, &mut new);
        let points_before = self.points.len();
        let fits = self.points.extend_from_slice(&new.points).is_ok() && self.records.push(record).is_ok();
        if fits && self.is_accepted() {
            return true;
        }
        if fits {
            self.records.pop();
        }
        self.points.truncate(points_before);
        false
    }

    fn is_accepted(&self) -> bool {
        let number = |is: fn(&Layer) -> bool| self.records.iter().filter(|record| is(&record.layer)).count();
        number(|layer| matches!(layer, Layer::Noise(_))) <= NOISES_MAX
            && number(|layer| layer.click().is_some()) <= CLICKS_MAX
            && self.worst_tick().cycles(Core::CortexM4f) <= BoardLimits::SMALLEST_TICK_CYCLES_MAX
    }
}

fn header(random: &mut Random) -> Header {
    Header {
        screen_width_m: random.between(0.02, 0.3),
        screen_height_m: random.between(0.02, 0.2),
        normal_load_n: random.pick([0.0, 0.5]),
        voltage_max_v_rms: random.pick([50.0, 150.0, 150.0]),
        voltage_max_v_peak: 220.0,
        slew_v_per_s: random.pick([1e4, 1e6, 5e6]),
        carrier_hz: random.pick([250.0, 1000.0, 1700.0]),
        waveform: random.pick([Waveform::Square, Waveform::Sine]),
        prediction: !random.once_in(4),
        leader: random.pick([Leader::First, Leader::Latest]),
        layers_fixed: random.once_in(2),
        ..HEADER
    }
}
