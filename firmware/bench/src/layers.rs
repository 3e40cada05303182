//! Cost of layers, by kind and by number.

use core::array;

use frixel_layers::cost;
use frixel_layers::{Blend, Constant, Header, Layer, Point, Record, Region, Speed, Stream, Wave, Waveform};
use frixel_wire::hello::{BoardLimits, Core};
use frixel_wire::message::Command;
use frixel_wire::scene::{POINTS_MAX, POLYGON_POINTS_MAX, RECORDS_MAX};

use crate::count::Counter;
use crate::host::STREAM_HZ;
use frixel_testkit::samples::{AROUND, CostCase, bitmap_to_count, grating_to_count, samples, with_bitmap_crc32};
use frixel_testkit::{HEADER, SceneBytes, scene_with_points};

use crate::tick::Bench;

pub(crate) const GRATING: Layer = grating_to_count(Wave::Sine, 0.0);

const STREAM: Layer = Layer::Stream(Stream { low_n: 0.001, high_n: 0.02 });
/// The part of the screen where the finger is. Layers that are away from the finger are outside it.
const UPPER_PART: Region = Region::Rectangle { x_m: 0.0, y_m: 0.0, width_m: 0.12, height_m: 0.06 };
const CONSTANT: Layer = Layer::Constant(Constant { electric_friction_n: 0.001 });
/// More friction than the drive can give; every tick counts as saturated.
const OUT_OF_REACH: Layer = Layer::Constant(Constant { electric_friction_n: 1.0 });

/// A region that the finger never touches. Most of these are alone in their grid cell.
fn away(number: usize) -> Region {
    let (column, row) = ((number % 16) as f32, (number / 16) as f32);
    Region::Rectangle { x_m: 0.001 + 0.0075 * column, y_m: 0.063 + 0.006_875 * row, width_m: 5e-3, height_m: 4e-3 }
}

/// A scene with the largest number of layers, each in its own region, and of points, in polygons.
pub(crate) fn largest_scene() -> SceneBytes {
    let points: [Point; POINTS_MAX] = array::from_fn(|number| {
        let turns = number as f32 / POLYGON_POINTS_MAX as f32;
        let (sine, cosine) = libm::sincosf(core::f32::consts::TAU * turns);
        let middle_m = 0.015 + 0.03 * (number / POLYGON_POINTS_MAX) as f32;
        Point { x: middle_m + 0.01 * cosine, y: 0.03 + 0.01 * sine }
    });
    let records: [Record; RECORDS_MAX] = array::from_fn(|number| {
        let first = number * POLYGON_POINTS_MAX;
        let region = if first < POINTS_MAX {
            Region::Polygon { first: first as u8, count: POLYGON_POINTS_MAX as u8 }
        } else {
            away(number)
        };
        under(region, GRATING)
    });
    scene_with_points(&HEADER, &records, &points)
}

/// A picture over the screen.
pub(crate) const fn bitmap(crc32: u32) -> Layer {
    with_bitmap_crc32(bitmap_to_count(false), crc32)
}

/// A layer in a region under the finger, with the most expensive blend.
const fn under(region: Region, layer: Layer) -> Record {
    Record { region, blend: Blend::Max, gain: 1.0, layer }
}

impl Bench {
    /// Counts layers of each kind: scenes of one constant, of two constants, and of one layer of each other kind
    /// alone. Each layer is in a region, so that it is found through the grid.
    pub(crate) fn costs(&mut self, counter: &mut Counter, crc32: u32) {
        let two = [under(AROUND, CONSTANT); 2];
        self.play(&HEADER, &two);
        self.slide(counter.case("tick_two_constants"));
        self.play(&Header { waveform: Waveform::Sine, ..HEADER }, &two);
        self.slide(counter.case("tick_two_constants_sine_carrier"));
        // A constant first, then one that is out of reach: what was played before a case changes its rare ticks.
        let mut cases = samples().flat_map(|sample| sample.costs);
        let mut count = |bench: &mut Self, case: &CostCase| {
            let record = under(case.region, with_bitmap_crc32(case.layer, crc32));
            bench.alone(counter, case.name, record, &[]);
        };
        cases.by_ref().take(1).for_each(|case| count(self, case));
        count(self, &CostCase { name: "tick_out_of_reach_alone", region: AROUND, layer: OUT_OF_REACH });
        cases.for_each(|case| count(self, case));
        let ellipse = Region::Ellipse { x_m: -0.05, y_m: -0.05, width_m: 0.2, height_m: 0.2 };
        count(self, &CostCase { name: "tick_ellipse_alone", region: ellipse, layer: CONSTANT });
        self.play(&HEADER, &[under(AROUND, CONSTANT), under(away(0), STREAM)]);
        self.start_stream();
        self.slide(counter.case("tick_stream_elsewhere"));
        self.disturbs_monitor = true;
        self.alone(counter, "tick_disturbed_alone", under(AROUND, CONSTANT), &[]);
        self.disturbs_monitor = false;
        self.polygons(counter);
        self.curves(counter);
        for kind in Layer::NUMBERS {
            assert!(
                self.kinds_counted & 1 << kind != 0,
                "the cost of layer kind {kind} is not counted: its sample has no case"
            );
        }
    }

    fn alone(&mut self, counter: &mut Counter, name: &'static str, record: Record, points: &[Point]) {
        self.kinds_counted |= 1 << record.layer.number();
        self.play_with_points(&HEADER, &[record], points);
        if matches!(record.layer, Layer::Stream(_)) {
            self.start_stream();
        }
        self.slide(counter.case(name));
    }

    pub(crate) fn start_stream(&mut self) {
        self.host.command(Command::StartStream { sample_hz: STREAM_HZ, start_level: 1 });
    }

    /// Polygons around the finger: two with two edges level with it at every tick, and one with all of its edges.
    fn polygons(&mut self, counter: &mut Counter) {
        for (name, count) in [("tick_polygon_4_alone", 4), ("tick_polygon_12_alone", 12)] {
            let points: [Point; 12] = array::from_fn(|corner| {
                let turns = (corner as f32 + 0.5) / f32::from(count);
                let (sine, cosine) = libm::sincosf(core::f32::consts::TAU * turns);
                Point { x: 0.06 + 0.15 * cosine, y: 0.03 + 0.15 * sine }
            });
            let region = Region::Polygon { first: 0, count };
            self.alone(counter, name, under(region, CONSTANT), &points[..usize::from(count)]);
        }
        // Up and down: one edge to the left of the finger and an odd number to its right, so that it is inside.
        let points: [Point; 6] = array::from_fn(|corner| Point {
            x: if corner < 2 { -0.4 } else { 2.0 },
            y: if corner % 2 == 0 { -1.0 } else { 1.0 },
        });
        let region = Region::Polygon { first: 0, count: 6 };
        self.alone(counter, "tick_polygon_6_level_alone", under(region, CONSTANT), &points);
    }

    /// Curves in which the last piece applies.
    fn curves(&mut self, counter: &mut Counter) {
        for (name, count) in [("tick_speed_2_alone", 2), ("tick_speed_8_alone", 8)] {
            let points: [Point; 8] =
                array::from_fn(|number| Point { x: 0.01 * number as f32, y: 0.001 * number as f32 });
            let layer = Layer::Speed(Speed { first: 0, count });
            self.alone(counter, name, under(AROUND, layer), &points[..usize::from(count)]);
        }
    }

    /// Counts a tick by the number of layers in the scene, with one and with eight of them under the finger.
    pub(crate) fn numbers_of_layers(&mut self, counter: &mut Counter) {
        for (name, there, count) in [
            ("tick_1_of_1", 1, 1),
            ("tick_1_of_2", 1, 2),
            ("tick_1_of_4", 1, 4),
            ("tick_1_of_8", 1, 8),
            ("tick_1_of_16", 1, 16),
            ("tick_1_of_32", 1, 32),
            ("tick_1_of_64", 1, 64),
            ("tick_8_of_8", 8, 8),
            ("tick_8_of_16", 8, 16),
            ("tick_8_of_32", 8, 32),
            ("tick_8_of_64", 8, 64),
        ] {
            let records: [Record; RECORDS_MAX] =
                array::from_fn(|number| under(if number < there { UPPER_PART } else { away(number) }, CONSTANT));
            self.play(&HEADER, &records[..count]);
            self.slide(counter.case(name));
        }
    }

    /// As many layers under the finger as a board accepts: pictures, then stripes, then constants, on a sine carrier.
    pub(crate) fn worst_scene(&mut self, counter: &mut Counter, crc32: u32) {
        let header = Header { waveform: Waveform::Sine, ..HEADER };
        let mut records = [under(AROUND, CONSTANT); RECORDS_MAX];
        let mut count = 0;
        let core_cycles_max = BoardLimits::SMALLEST_TICK_CYCLES_MAX * 100 / cost::FLASH_WAIT_PERCENT;
        let mut left = core_cycles_max.saturating_sub(cost::of_empty_scene(&header).on(Core::CortexM4f));
        for layer in [bitmap(crc32), GRATING, CONSTANT] {
            let record = under(AROUND, layer);
            let cost = cost::of_record(&record, &[]).on(Core::CortexM4f).max(1);
            while left >= cost && count < RECORDS_MAX {
                left -= cost;
                records[count] = record;
                count += 1;
            }
        }
        self.play(&header, &records[..count]);
        self.slide(counter.case("tick_worst_scene"));
    }
}
