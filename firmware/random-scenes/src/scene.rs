//! A scene that a board accepts.

use frixel_layers::cost::{Worst, worst_of_scene};
use frixel_layers::{
    Button, Carrier, Click, Edge, HEADER_LEN, Header, Layer, Leader, POINT_LEN, Point, RECORD_LEN, Record,
    SCENE_MAX_LEN, electric_friction_max_n,
};
use frixel_wire::hello::BoardLimits;
use frixel_wire::scene::{POINTS_MAX, RECORDS_MAX};
use heapless::Vec;

use crate::dice::Dice;
use crate::layers::{NewPoints, ground, record};

/// Draws after which no further layer is looked for: what is left of a tick may be too short for most.
const MISSES_MAX: u32 = 6;
/// What a board has room for.
const NOISES_MAX: usize = 8;
const CLICKS_MAX: usize = 16;

/// A scene of random layers whose longest tick is within the limit.
pub struct RandomScene {
    /// What holds for the whole scene.
    pub header: Header,
    /// Its layers, the first one at the bottom.
    pub records: Vec<Record, RECORDS_MAX>,
    /// The points that records name.
    pub points: Vec<Point, POINTS_MAX>,
}

impl RandomScene {
    /// The scene of a seed; its pictures, if it has any, are all of this name.
    pub fn new(seed: u64, picture: u32) -> Self {
        let dice = &mut Dice::new(seed);
        let mut scene = Self { header: header(dice), records: Vec::new(), points: Vec::new() };
        let wanted = dice.pick([1, 2, 3, 6, 12, RECORDS_MAX]);
        if !dice.once_in(3) {
            // An empty list has room.
            let _ = scene.records.push(ground(dice));
        }
        let mut misses = 0;
        while scene.records.len() < wanted && misses < MISSES_MAX {
            if !scene.add(dice, picture) {
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
        worst_of_scene(&self.header, &self.records, &self.points)
    }

    /// The scene's bytes.
    pub fn write<'b>(&self, bytes: &'b mut [u8; SCENE_MAX_LEN]) -> &'b [u8] {
        let (head, rest) = bytes.split_at_mut(HEADER_LEN);
        head.copy_from_slice(&self.header.write(self.records.len() as u8, self.points.len() as u8));
        let (body, tail) = rest.split_at_mut(RECORD_LEN * self.records.len());
        for (place, record) in body.chunks_exact_mut(RECORD_LEN).zip(&self.records) {
            place.copy_from_slice(&record.write());
        }
        for (place, point) in tail.chunks_exact_mut(POINT_LEN).zip(&self.points) {
            place.copy_from_slice(&point.write());
        }
        let len = HEADER_LEN + RECORD_LEN * self.records.len() + POINT_LEN * self.points.len();
        bytes.get(..len).unwrap_or_default()
    }

    /// Draws a layer, and keeps it when a board takes the scene with it.
    fn add(&mut self, dice: &mut Dice, picture: u32) -> bool {
        let mut new = NewPoints { first: self.points.len() as u8, points: Vec::new() };
        let record = record(dice, &self.header, picture, &mut new);
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
            && number(clicks) <= CLICKS_MAX
            && self.worst_tick().cycles() <= BoardLimits::SMALLEST_TICK_CYCLES_MAX
    }
}

fn clicks(layer: &Layer) -> bool {
    let (Layer::Edge(Edge { click: Click { height_n, .. }, .. })
    | Layer::Button(Button { click: Click { height_n, .. }, .. })) = layer
    else {
        return false;
    };
    height_n.abs() > 0.0
}

fn header(dice: &mut Dice) -> Header {
    Header {
        screen_width_m: dice.between(0.02, 0.3),
        screen_height_m: dice.between(0.02, 0.2),
        finger_radius_m: 8e-3,
        stiffness_pa_per_m: 1.8e7,
        friction_coefficient: 0.5,
        normal_load_n: dice.pick([0.0, 0.5]),
        effective_gap_m: 1e-5,
        voltage_max_v_rms: dice.pick([50.0, 150.0, 150.0]),
        voltage_max_v_peak: 220.0,
        slew_v_per_s: dice.pick([1e4, 1e6, 5e6]),
        carrier_hz: dice.pick([250.0, 1000.0, 1700.0]),
        host_timeout_s: 0.25,
        carrier: dice.pick([Carrier::Square, Carrier::Sine]),
        autonomous: dice.once_in(4),
        prediction: !dice.once_in(4),
        leader: dice.pick([Leader::First, Leader::Latest]),
        layers_fixed: dice.once_in(2),
        electric_friction_max_n: None,
    }
}
