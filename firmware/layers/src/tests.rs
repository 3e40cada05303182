use std::boxed::Box;

#[cfg(any(feature = "polygon", feature = "speed"))]
use crate::Point;
use crate::active::ActiveLayer;
use crate::bitmap_pool::{BitmapPool, StoredBitmap};
use crate::context::{Context, Inputs};
use crate::prepare::Preparation;
use crate::tables::Tables;
use crate::{Blend, Clicks, Layer, Record, Region};

const HERE: Region = Region::Rectangle { x_m: 0.01, y_m: 0.02, width_m: 0.03, height_m: 0.04 };

/// A layer with its evaluation context.
struct Bench {
    pool: Box<BitmapPool>,
    bitmap: Option<StoredBitmap>,
    tables: Tables,
    clicks: Clicks,
}

impl Bench {
    fn new() -> Self {
        Self { pool: Box::new(BitmapPool::new()), bitmap: None, tables: Tables::new(), clicks: Clicks::NONE }
    }

    fn load(&mut self, record: &Record) -> ActiveLayer {
        let Self { bitmap, tables, .. } = self;
        let find_bitmap = |crc32| bitmap.filter(|bitmap| bitmap.crc32 == crc32);
        let mut preparation = Preparation { tick_hz: 40_000, find_bitmap: &find_bitmap, tables };
        ActiveLayer::new(record, 0, &mut preparation).unwrap()
    }

    #[allow(dead_code, reason = "for kinds that may be disabled")]
    fn kind(&mut self, layer: Layer) -> ActiveLayer {
        self.load(&Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer })
    }

    /// Friction of a layer over `below_n`.
    fn over(&mut self, layer: &ActiveLayer, below_n: f32, inputs: Inputs) -> f32 {
        self.clicks.begin();
        let Self { pool, tables, clicks, .. } = self;
        layer.blend_over(below_n, &mut Context { inputs: &inputs, pool, tables, clicks })
    }
}

fn constant(blend: Blend, gain: f32, electric_friction_n: f32) -> Record {
    Record { region: HERE, blend, gain, layer: Layer::Constant(crate::Constant { electric_friction_n }) }
}

fn at(x_m: f32, y_m: f32) -> Inputs {
    let mut inputs = Inputs::default();
    inputs.set_place([x_m, y_m], 0);
    inputs
}

fn assert_close(found: f32, expected: f32) {
    assert!((found - expected).abs() <= 1e-6, "{found} is not {expected}");
}

#[test]
fn a_rectangle_includes_only_its_left_and_top_edges() {
    let mut bench = Bench::new();
    let layer = bench.load(&constant(Blend::Replace, 2.0, 0.25));
    for (x_m, y_m, expected) in
        [(0.01, 0.02, 0.5), (0.039, 0.059, 0.5), (0.04, 0.03, 9.0), (0.02, 0.06, 9.0), (0.0099, 0.03, 9.0)]
    {
        assert_close(bench.over(&layer, 9.0, at(x_m, y_m)), expected);
    }
}

/// Every place of a square that is cut along a crooked line, vertices and edges included, is in exactly one half.
#[cfg(feature = "polygon")]
#[test]
fn adjacent_polygons_neither_overlap_nor_leave_a_gap() {
    let (left, cut, right) = (
        [(0.07, 0.01), (0.01, 0.01), (0.01, 0.07), (0.05, 0.07)],
        [(0.03, 0.05), (0.055, 0.04), (0.025, 0.03), (0.06, 0.02)],
        [(0.05, 0.07), (0.07, 0.07)],
    );
    // One half lists the vertices of the cut bottom to top, the other top to bottom.
    let halves =
        [left.iter().chain(&cut).copied().collect(), vec![right[1], right[0], cut[0], cut[1], cut[2], cut[3], left[0]]];
    let mut bench = Bench::new();
    let all: Vec<Point> = halves.iter().flatten().map(|&(x, y)| Point { x, y }).collect();
    bench.tables.set_points(all.iter().copied());
    let layers = [(0, 8), (8, 7)].map(|(first, count)| {
        bench.load(&Record { region: Region::Polygon { first, count }, ..constant(Blend::Add, 1.0, 1.0) })
    });
    let mut places: Vec<(f32, f32)> = all.iter().map(|point| (point.x, point.y)).collect();
    places.extend((0..40_000).map(|i| (0.08 * (i % 200) as f32 / 200.0, 0.08 * (i / 200) as f32 / 200.0)));
    places.extend((0..1000).map(|i| {
        // Along an edge of the cut.
        let part = i as f32 / 1000.0;
        (0.03 + part * (0.055 - 0.03), 0.05 + part * (0.04 - 0.05))
    }));
    for (x_m, y_m) in places {
        let inside = layers.iter().fold(0.0, |below_n, layer| bench.over(layer, below_n, at(x_m, y_m)));
        let square = (0.01..0.07).contains(&x_m) && (0.01..0.07).contains(&y_m);
        assert_close(inside, if square { 1.0 } else { 0.0 });
    }
    assert_close(bench.over(&layers[0], 0.0, at(0.05, 0.04)), 1.0);
    assert_close(bench.over(&layers[0], 0.0, at(0.04, 0.05)), 0.0);
}

/// The phase is the tick number times the step, without a jump, also around 2^31 and 2^32 ticks.
#[cfg(all(feature = "grating", feature = "rings"))]
#[test]
fn drifting_waves_stay_exact_after_any_number_of_ticks() {
    use crate::{Grating, Rings, Wave};
    let (wave, trough_n, crest_n) = (Wave::Sine, 0.0, 1.0);
    for drift_hz in [2.5_f32, -0.01, 333.3] {
        let steps = (f64::from(drift_hz) / 40_000.0 * 2_f64.powi(32)).round();
        let (cycles_per_m_x, cycles_per_m_y, phase_turns) = (100.0, 0.0, 0.125);
        let grating = Grating { wave, cycles_per_m_x, cycles_per_m_y, phase_turns, trough_n, crest_n, drift_hz };
        let rings = Rings { wave, x_m: 0.0, y_m: 0.0, cycles_per_m: 100.0, trough_n, crest_n, drift_hz };
        let kinds = [(Layer::Grating(grating), 0.125), (Layer::Rings(rings), 0.0)];
        for (kind, phase_turns) in kinds {
            let mut bench = Bench::new();
            let layer = bench.kind(kind);
            for ticks in [0_u64, 1, 40_000, (1 << 31) - 1, 1 << 31, (1 << 32) - 1, 1 << 32, (1 << 32) + 1, 3 << 33] {
                let mut inputs = at(0.0125, 0.0);
                inputs.set_place([0.0125, 0.0], ticks as u32);
                let drifted_turns = (ticks as f64 * steps / 2_f64.powi(32)).rem_euclid(1.0);
                let expected = 0.5 + 0.5 * (core::f64::consts::TAU * (1.25 + phase_turns - drifted_turns)).sin();
                assert_close(bench.over(&layer, 0.0, inputs), expected as f32);
            }
        }
    }
}

/// At places where all waves are nearly at their crest.
#[cfg(feature = "noise")]
#[test]
fn noise_does_not_leave_its_range_where_all_waves_meet() {
    let mut bench = Bench::new();
    // All waves have one wavelength of 0.5 m, so only their phases and directions differ.
    for seed in 0..8 {
        let kind =
            Layer::Noise(crate::Noise { seed, wavelength_min_m: 0.5, wavelength_max_m: 0.5, low_n: 0.0, high_n: 1.0 });
        let layer = bench.kind(kind);
        for i in 0..40_000 {
            let (x_m, y_m) = (-2.0 + 0.02 * (i % 200) as f32, -2.0 + 0.02 * (i / 200) as f32);
            assert!((0.0..=1.0).contains(&bench.over(&layer, 0.0, at(x_m, y_m))));
        }
    }
}

#[cfg(feature = "edge")]
mod clicks {
    use crate::Click;

    use super::*;

    const CLICK: Click = Click { height_n: 1.0, decay_s: 1e-3 };

    /// Friction at successive ticks from `tick` on, at these places along x.
    fn slide(bench: &mut Bench, layer: &ActiveLayer, tick: u32, places: impl IntoIterator<Item = f32>) -> Vec<f32> {
        (tick..).zip(places).map(|(tick, x_m)| bench.over(layer, 0.0, Inputs { tick, ..at(x_m, 0.04) })).collect()
    }

    fn edge(bench: &mut Bench, angle_turns: f32, click: Click) -> ActiveLayer {
        let edge = Layer::Edge(crate::Edge {
            x_m: 0.02,
            y_m: 0.04,
            angle_turns,
            width_m: 0.004,
            level_n: 0.25,
            ridge_n: 0.75,
            click,
        });
        bench.load(&Record { region: HERE, blend: Blend::Add, gain: 1.0, layer: edge })
    }

    #[test]
    fn an_edge_clicks_when_it_is_crossed_and_then_no_more() {
        let mut bench = Bench::new();
        let layer = edge(&mut bench, 0.0, CLICK);
        let before = slide(&mut bench, &layer, 100, [0.03; 3]);
        assert!(before.iter().all(|friction_n| (friction_n - 0.25).abs() < 1e-6), "landing is no crossing: {before:?}");
        let after = slide(&mut bench, &layer, 103, [0.012; 60]);
        for (tick, found) in after.into_iter().enumerate() {
            let left = (1.0 - tick as f32 / 40.0).max(0.0);
            assert_close(found, 0.25 + left * left);
        }
        // A crossing counts even if ticks without an evaluation lie in between.
        let back = slide(&mut bench, &layer, 170, [0.03]);
        assert_close(back[0], 1.25);
    }

    #[test]
    fn a_finger_that_was_away_has_not_crossed() {
        let mut bench = Bench::new();
        let layer = edge(&mut bench, 0.0, CLICK);
        slide(&mut bench, &layer, 100, [0.03]);
        // Around the region.
        assert_close(slide(&mut bench, &layer, 101, [0.06])[0], 0.0);
        assert_close(slide(&mut bench, &layer, 102, [0.012])[0], 0.25);
        // Up, and down again elsewhere.
        bench.clicks.lift();
        assert_close(slide(&mut bench, &layer, 500, [0.03])[0], 0.25);
    }
}

#[cfg(feature = "vibration")]
#[test]
fn a_vibration_keeps_time() {
    use crate::{Beat, Burst};
    let mut bench = Bench::new();
    let vibration = |beat, burst| {
        Layer::Vibration(crate::Vibration { beat, frequency_hz: 100.0, low_n: 0.25, high_n: 1.25, burst })
    };
    let on = |tick| Inputs { tick, ..Inputs::default() };
    let sine = bench.kind(vibration(Beat::Sine, Burst::default()));
    let square = bench.kind(vibration(Beat::Square, Burst::default()));
    // 400 ticks a period, at the beginning and after an hour.
    for start in [0, 400 * 360_000] {
        for (tick, expected) in [(0, 0.75), (100, 1.25), (200, 0.75), (300, 0.25)] {
            let found = bench.over(&sine, 0.0, on(start + tick));
            // The frequency is exact within 2^-33 turns a tick.
            let drift = 3.2 * start as f32 / (1u64 << 33) as f32;
            assert!((found - expected).abs() < 1e-5 + drift, "{tick}: {found} is not {expected}");
            assert_close(bench.over(&square, 0.0, on(tick + 50)), if tick < 200 { 1.25 } else { 0.25 });
        }
    }
}

/// Also if the tick count wraps within a burst.
#[cfg(feature = "vibration")]
#[test]
fn bursts_begin_when_their_layer_is_switched_on() {
    use crate::{ActiveLayers, Beat, Burst};
    let burst = Burst { period_s: 0.1, on_s: 0.05, ramp_s: 0.0 };
    let vibration = crate::Vibration { beat: Beat::Square, frequency_hz: 100.0, low_n: 0.25, high_n: 1.25, burst };
    let record =
        Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer: Layer::Vibration(vibration) };
    let pool = Box::new(BitmapPool::new());
    let mut layers = Box::new(ActiveLayers::EMPTY);
    layers.push(&record, 40_000, &|_| None).unwrap();
    let friction_n = |layers: &ActiveLayers, tick| {
        let mut clicks = Clicks::NONE;
        layers.electric_friction_n(&Inputs { tick, ..Inputs::default() }, &pool, &mut clicks)
    };
    // At all these ticks the wave is high.
    assert_close(friction_n(&layers, 1_650), 1.25);
    assert_close(friction_n(&layers, 2_050), 0.25);
    // A layer that is already on is not restarted.
    layers.set(0, true, 1.0, 500);
    assert_close(friction_n(&layers, 2_050), 0.25);
    for begin in [2_850, 0_u32.wrapping_sub(1_100)] {
        layers.set(0, false, 1.0, 7);
        layers.set(0, true, 1.0, begin);
        for (passed, expected) in [(0, 1.25), (1_999, 1.25), (2_000, 0.25), (3_999, 0.25), (4_000, 1.25)] {
            assert_close(friction_n(&layers, begin.wrapping_add(passed)), expected);
        }
    }
}
