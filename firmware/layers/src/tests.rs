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

#[test]
fn blends_match_their_definitions() {
    for (blend, below_n, expected) in [
        (Blend::Add, 0.5, 0.75),
        (Blend::Replace, 0.5, 0.25),
        (Blend::Multiply, 0.5, 0.125),
        (Blend::Max, 0.5, 0.5),
        (Blend::Max, 0.125, 0.25),
    ] {
        let mut bench = Bench::new();
        let layer = bench.load(&constant(blend, 1.0, 0.25));
        assert_close(bench.over(&layer, below_n, at(0.02, 0.03)), expected);
    }
}

#[test]
fn a_gain_scales_only_its_own_layer() {
    let mut bench = Bench::new();
    let layer = bench.load(&constant(Blend::Add, -2.0, 0.25));
    assert_close(bench.over(&layer, 0.75, at(0.02, 0.03)), 0.25);
}

#[test]
fn an_ellipse_touches_its_rectangle() {
    let mut bench = Bench::new();
    let region = Region::Ellipse { x_m: 0.01, y_m: 0.02, width_m: 0.03, height_m: 0.04 };
    let layer = bench.load(&Record { region, ..constant(Blend::Replace, 1.0, 0.25) });
    for (x_m, y_m, inside) in [
        (0.0101, 0.04, true),
        (0.0099, 0.04, false),
        (0.025, 0.0599, true),
        (0.025, 0.0601, false),
        (0.0399, 0.04, true),
        (0.012, 0.022, false),
        (0.035, 0.054, true),
        (0.037, 0.056, false),
    ] {
        assert_close(bench.over(&layer, 9.0, at(x_m, y_m)), if inside { 0.25 } else { 9.0 });
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

#[cfg(feature = "bitmap")]
mod bitmaps {
    use super::*;

    const PICTURE: Layer = Layer::Bitmap(crate::Bitmap {
        crc32: 7,
        x_m: 0.0,
        y_m: 0.0,
        pitch_m: 1.0,
        black_n: 0.0,
        white_n: 255.0,
        pitch_y_m: 1.0,
        angle_turns: 0.0,
        tiled: false,
    });

    fn bench() -> Bench {
        let mut bench = Bench::new();
        bench.bitmap = Some(StoredBitmap { crc32: 7, offset: 5, width: 2, height: 2 });
        bench.pool.write(5, &[0, 100, 200, 50]);
        bench
    }

    fn check(kind: Layer, expected: &[(f32, f32, f32)]) {
        let mut bench = bench();
        let layer = bench.kind(kind);
        for &(x_m, y_m, expected) in expected {
            let found = bench.over(&layer, 0.0, at(x_m, y_m));
            assert!((found - expected).abs() < 1e-3, "({x_m}, {y_m}): {found} is not {expected}");
        }
    }

    #[test]
    fn a_bitmap_is_bilinear_between_centres_and_held_at_its_border() {
        let held = [(0.5, 0.5, 0.0), (1.5, 0.5, 100.0), (1.0, 0.5, 50.0), (0.5, 1.0, 100.0), (1.0, 1.0, 87.5)];
        check(PICTURE, &held);
        check(PICTURE, &[(-3.0, -3.0, 0.0), (9.0, 9.0, 50.0)]);
    }

    #[test]
    fn a_tiled_bitmap_repeats_in_both_directions() {
        let Layer::Bitmap(crate::Bitmap { crc32, x_m, y_m, pitch_m, black_n, white_n, angle_turns, .. }) = PICTURE
        else {
            unreachable!()
        };
        // Rows twice as far apart as samples.
        let tiled = Layer::Bitmap(crate::Bitmap {
            crc32,
            x_m,
            y_m,
            pitch_m,
            black_n,
            white_n,
            angle_turns,
            pitch_y_m: 2.0,
            tiled: true,
        });
        for (across, down) in [(0.0, 0.0), (2.0, 0.0), (-4.0, 8.0), (200.0, -400.0)] {
            let expected = [(0.5, 1.0, 0.0), (1.5, 1.0, 100.0), (1.5, 3.0, 50.0), (2.0, 1.0, 50.0), (0.5, 4.0, 100.0)];
            check(tiled, &expected.map(|(x_m, y_m, expected)| (x_m + across, y_m + down, expected)));
        }
    }

    #[test]
    fn a_quarter_turn_takes_rows_to_columns() {
        let Layer::Bitmap(crate::Bitmap { crc32, pitch_m, black_n, white_n, pitch_y_m, tiled, .. }) = PICTURE else {
            unreachable!()
        };
        let turned = Layer::Bitmap(crate::Bitmap {
            crc32,
            x_m: 5.0,
            y_m: 3.0,
            pitch_m,
            black_n,
            white_n,
            pitch_y_m,
            angle_turns: 0.25,
            tiled,
        });
        check(turned, &[(4.5, 3.5, 0.0), (4.5, 4.5, 100.0), (3.5, 3.5, 200.0), (3.5, 4.5, 50.0), (4.0, 4.0, 87.5)]);
    }
}

#[cfg(feature = "grating")]
#[test]
fn a_grating_swings_between_trough_and_crest() {
    use crate::Wave;
    // At this many eighths of a turn, as in PROTOCOL.md.
    for (wave, expected) in [
        (Wave::Sine, [(0, 0.5), (2, 1.0), (4, 0.5), (6, 0.0), (10, 1.0)]),
        (Wave::Square { duty: 0.5 }, [(1, 1.0), (3, 1.0), (5, 0.0), (7, 0.0), (-1, 0.0)]),
        (Wave::Square { duty: 0.25 }, [(1, 1.0), (3, 0.0), (5, 0.0), (7, 0.0), (9, 1.0)]),
        (Wave::Triangle, [(0, 0.0), (2, 0.5), (4, 1.0), (6, 0.5), (-1, 0.25)]),
        (Wave::Saw, [(1, 0.125), (4, 0.5), (7, 0.875), (9, 0.125), (-1, 0.875)]),
    ] {
        let mut bench = Bench::new();
        let layer = bench.kind(Layer::Grating(crate::Grating {
            wave,
            cycles_per_m_x: 0.0,
            cycles_per_m_y: 500.0,
            phase_turns: 0.25,
            trough_n: 0.25,
            crest_n: 1.25,
            drift_hz: 0.0,
        }));
        for (eighths, height) in expected {
            let y_m = (eighths as f32 / 8.0 - 0.25) / 500.0;
            assert_close(bench.over(&layer, 0.0, at(0.3, y_m)), 0.25 + height);
        }
    }
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

#[cfg(feature = "noise")]
#[test]
fn noise_stays_within_its_range_and_depends_on_its_seed() {
    let mut bench = Bench::new();
    let mut noise = |seed| {
        let kind = Layer::Noise(crate::Noise {
            seed,
            wavelength_min_m: 1e-3,
            wavelength_max_m: 4e-3,
            low_n: 0.25,
            high_n: 1.25,
        });
        let layer = bench.kind(kind);
        let values: Vec<f32> = (0..20_000)
            .map(|i| bench.over(&layer, 0.0, at(0.1 * (i % 173) as f32 / 173.0, 0.1 * i as f32 / 20_000.0)))
            .collect();
        assert!(values.iter().all(|value| (0.25..=1.25).contains(value)));
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        let variance = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f32>() / values.len() as f32;
        // Eight cosines of an eighth each: a variance of 1/16 of the half span's square.
        assert!((mean - 0.75).abs() < 0.01 && (variance / 0.015_625 - 1.0).abs() < 0.1, "{mean} {variance}");
        values
    };
    assert_eq!(noise(1), noise(1));
    assert_ne!(noise(1), noise(2));
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
    fn a_ridge_is_a_raised_cosine_across_its_line() {
        let mut bench = Bench::new();
        let layer = edge(&mut bench, 0.0, Click::default());
        for (x_m, expected) in [(0.02, 0.75), (0.021, 0.5), (0.019, 0.5), (0.022, 0.25), (0.0175, 0.25), (0.03, 0.25)] {
            assert_close(bench.over(&layer, 0.0, at(x_m, 0.05)), expected);
        }
        let layer = edge(&mut bench, 0.125, Click::default());
        let step = 0.001 / 2.0_f32.sqrt();
        for (x_m, y_m, expected) in [(0.025, 0.035, 0.75), (0.02 + step, 0.04 + step, 0.5), (0.025, 0.045, 0.25)] {
            assert_close(bench.over(&layer, 0.0, at(x_m, y_m)), expected);
        }
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

    #[test]
    fn a_button_clicks_when_the_finger_slides_in() {
        let mut bench = Bench::new();
        let button = Layer::Button(crate::Button { rim_width_m: 0.002, rim_n: 0.5, face_n: 0.125, click: CLICK });
        let layer = bench.load(&Record { region: HERE, blend: Blend::Add, gain: 1.0, layer: button });
        assert_close(slide(&mut bench, &layer, 100, [0.025])[0], 0.125);
        let found = slide(&mut bench, &layer, 200, [0.005, 0.011, 0.0105, 0.025]);
        assert_close(found[0], 0.0);
        assert_close(found[1], 0.5 + 1.0);
        assert_close(found[3], 0.125 + (38.0 / 40.0_f32).powi(2));
        let middle = slide(&mut bench, &layer, 204, [0.025; 60]);
        assert_close(middle[59], 0.125);
    }

    #[test]
    fn an_ellipse_has_its_rim_inside_its_border() {
        let mut bench = Bench::new();
        let region = Region::Ellipse { x_m: 0.01, y_m: 0.02, width_m: 0.06, height_m: 0.04 };
        let button =
            Layer::Button(crate::Button { rim_width_m: 0.002, rim_n: 0.5, face_n: 0.125, click: Click::default() });
        let layer = bench.load(&Record { region, blend: Blend::Add, gain: 1.0, layer: button });
        // The middle of the rim: a twentieth of the shorter half axis inside.
        for (x_m, y_m, expected) in
            [(0.04, 0.021, 0.5), (0.0115, 0.04, 0.5), (0.04, 0.04, 0.125), (0.04, 0.022, 0.125), (0.04, 0.019, 0.0)]
        {
            assert_close(bench.over(&layer, 0.0, at(x_m, y_m)), expected);
        }
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
    let burst = Burst { period_s: 0.1, on_s: 0.05, ramp_s: 0.01 };
    let layer = bench.kind(vibration(Beat::Square, burst));
    for (tick, envelope) in [(0, 0.0), (100, 0.25), (850, 1.0), (1650, 0.875), (2050, 0.0), (3950, 0.0), (4100, 0.25)] {
        assert_close(bench.over(&layer, 0.0, on(tick)), 0.25 + envelope);
    }
    let layer = bench.kind(vibration(Beat::Square, Burst { ramp_s: 0.0, ..burst }));
    for (tick, high) in [(1, 1.0), (250, 0.0), (1999, 0.0), (1650, 1.0), (2050, 0.0), (4001, 1.0)] {
        assert_close(bench.over(&layer, 0.0, on(tick)), 0.25 + high);
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

#[cfg(feature = "speed")]
#[test]
fn a_curve_is_straight_between_its_points_and_held_outside() {
    let mut bench = Bench::new();
    bench
        .tables
        .set_points([(9.0, 9.0), (0.02, 0.5), (0.1, 1.0), (0.2, 0.25)].map(|(x, y)| Point { x, y }).into_iter());
    let curve = Layer::Speed(crate::Speed { first: 1, count: 3 });
    let layer = bench.load(&Record { region: Region::Screen, blend: Blend::Multiply, gain: 1.0, layer: curve });
    for (speed, expected) in
        [(0.0, 0.5), (0.02, 0.5), (0.06, 0.75), (0.1, 1.0), (0.15, 0.625), (0.2, 0.25), (3.0, 0.25)]
    {
        let inputs = Inputs { velocity_m_per_s: [0.6 * speed, -0.8 * speed], ..Inputs::default() };
        assert_close(bench.over(&layer, 2.0, inputs), 2.0 * expected);
    }
}

#[cfg(feature = "stream")]
#[test]
fn a_stream_is_between_its_two_frictions() {
    let mut bench = Bench::new();
    let layer = bench.kind(Layer::Stream(crate::Stream { low_n: 0.25, high_n: -0.75 }));
    for (value, weight, expected) in [(0.0, 1.0, 0.25), (0.5, 1.0, -0.25), (1.0, 1.0, -0.75), (1.0, 0.25, 0.5625)] {
        let stream = crate::StreamSample { value, weight };
        assert_close(bench.over(&layer, 1.0, Inputs { stream, ..Inputs::default() }), expected);
    }
}
