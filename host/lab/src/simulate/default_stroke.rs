//! The stroke of a play without a stroke of its own.

use std::f64::consts::TAU;

use frixel_hil_sim::{Point, Stroke, StrokeError};
use frixel_layers::{Direction, Grating, Layer};
use frixel_scene::{LayerMiddle, Program, TouchedLayers};

/// Time for which the finger is lifted before it repeats a stroke, s.
pub const REPEAT_PAUSE_S: f64 = 0.2;
/// Duration of the sweep over the screen unless another is given, s.
const SWEEP_S: f64 = 3.0;
/// Time between two places of a sampled motion, s.
const SAMPLE_PERIOD_S: f64 = 1e-3;
/// Time for which the finger is lifted before it visits a layer, s.
const PAUSE_S: f64 = 0.1;
/// How far outside of a layer the stroke over it begins and ends, m.
const VISIT_MARGIN_M: f64 = 5e-3;
/// Least length of the stroke over a layer, m.
const VISIT_MIN_M: f64 = 0.03;
/// Mean speed of the stroke over a layer, m/s.
const VISIT_M_PER_S: f64 = 0.1;
/// A finger has crossed the middle of a layer if it was this near to it along both sides, in parts of the sides.
const MIDDLE_PART: f64 = 0.2;
/// A finger slides along an axis if this part of its way, at least, does.
const ALONG_PART: f64 = 0.5;

/// Width and height of the screen of most bundled scenes, m.
pub const BUNDLED_SCREEN_M: [f64; 2] = [0.12, 0.11];

/// A sweep over a screen of this width and height, in m, repeated without end: the stroke of a board whose scene is not
/// known beforehand.
pub fn endless_sweep([width_m, height_m]: [f64; 2]) -> Result<Stroke, StrokeError> {
    Stroke::sweep(width_m, height_m, SWEEP_S)?.looped(REPEAT_PAUSE_S)
}

/// An even stroke over the screen of a program, for `seconds`, or for as long as it takes to cross the middle of every
/// layer: first a sweep over the screen, and then a stroke over each layer whose middle the sweep misses, across its
/// stripes, along its axis and back, or, with neither, across its shorter side.
pub fn default_stroke(program: &Program, seconds: Option<f64>) -> Result<Stroke, StrokeError> {
    let screen_m = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
    let sweep = Stroke::sweep(screen_m.0, screen_m.1, seconds.unwrap_or(SWEEP_S))?;
    if seconds.is_some() {
        return Ok(sweep);
    }
    let mut middles = Middles::new(program);
    let mut places = Vec::new();
    middles.add(&mut places, &sweep, 0.0);
    if middles.missed().is_none() {
        return Ok(sweep);
    }
    let mut t_s = sweep.duration_s();
    while let Some(missed) = middles.missed() {
        places.push((t_s + 0.5 * PAUSE_S, None));
        t_s += PAUSE_S;
        let visit = visit(&missed, screen_m)?;
        middles.add(&mut places, &visit, t_s);
        // The layer may be narrower than the distance between two samples.
        middles.cross(missed.middle.x_m, missed.middle.y_m, missed.way());
        t_s += visit.duration_s();
    }
    Stroke::through(&places)
}

/// A stroke through the middle of a layer.
fn visit(layer: &Missed, (width_m, height_m): (f64, f64)) -> Result<Stroke, StrokeError> {
    let middle = &layer.middle;
    let (way_x, way_y) = layer.way();
    // From one side of the layer to the other, along the way.
    let chord_m = (middle.width_m / way_x.abs()).min(middle.height_m / way_y.abs());
    let half_m = 0.5 * (chord_m + 2.0 * VISIT_MARGIN_M).max(VISIT_MIN_M);
    let (half_x_m, half_y_m) = (half_m * way_x, half_m * way_y);
    let place = |sign: f64| Point {
        x_m: (middle.x_m + sign * half_x_m).clamp(0.0, width_m),
        y_m: (middle.y_m + sign * half_y_m).clamp(0.0, height_m),
    };
    let (from, to) = (place(-1.0), place(1.0));
    let length_m = (to.x_m - from.x_m).hypot(to.y_m - from.y_m);
    Stroke::minimum_jerk(from, to, length_m / VISIT_M_PER_S)
}

/// A layer that is to be crossed.
#[derive(Clone, Copy)]
struct Missed {
    /// Its index from the bottom.
    layer: usize,
    middle: LayerMiddle,
    axis: Axis,
}

/// Which way a layer is to be crossed, a unit vector.
#[derive(Clone, Copy)]
enum Axis {
    Any,
    EitherWay((f64, f64)),
    OneWay((f64, f64)),
}

impl Missed {
    /// The direction of the stroke over the layer, a unit vector.
    fn way(&self) -> (f64, f64) {
        match self.axis {
            Axis::EitherWay(axis) | Axis::OneWay(axis) => axis,
            Axis::Any if self.middle.width_m <= self.middle.height_m => (1.0, 0.0),
            Axis::Any => (0.0, 1.0),
        }
    }

    /// Whether a finger that moves by `(x_m, y_m)` crosses the layer as it is to be crossed.
    fn is_crossed_by(&self, (x_m, y_m): (f64, f64)) -> bool {
        let along_m = match self.axis {
            Axis::Any => return true,
            Axis::EitherWay((x, y)) => (x * x_m + y * y_m).abs(),
            Axis::OneWay((x, y)) => x * x_m + y * y_m,
        };
        along_m > ALONG_PART * x_m.hypot(y_m)
    }
}

/// The ways in which a layer is to be crossed: stripes from either side, and one that depends on the direction from
/// both.
fn axes(layer: &Layer) -> Vec<Axis> {
    match layer {
        Layer::Grating(grating) => vec![across(grating).map_or(Axis::Any, Axis::EitherWay)],
        Layer::Direction(Direction { angle_turns, .. }) => {
            let (y, x) = libm::sincos(TAU * f64::from(*angle_turns));
            vec![Axis::OneWay((x, y)), Axis::OneWay((-x, -y))]
        }
        _ => vec![Axis::Any],
    }
}

/// The unit vector across stripes; `None` without stripes.
fn across(grating: &Grating) -> Option<(f64, f64)> {
    let (x, y) = (f64::from(grating.cycles_per_m_x), f64::from(grating.cycles_per_m_y));
    let cycles_per_m = x.hypot(y);
    (cycles_per_m > 0.0).then(|| (x / cycles_per_m, y / cycles_per_m))
}

/// The layers whose middle a finger has crossed.
struct Middles {
    layers: TouchedLayers,
    /// The layers that are still to be crossed, once for each way.
    missed: Vec<Missed>,
}

impl Middles {
    fn new(program: &Program) -> Self {
        let layers = TouchedLayers::new(program);
        let touchable = program.records.iter().enumerate();
        let touchable = touchable.filter_map(|(layer, record)| Some((layer, layers.middle(layer)?, record)));
        let missed = touchable.flat_map(|(layer, middle, record)| {
            axes(&record.layer).into_iter().map(move |axis| Missed { layer, middle, axis })
        });
        let missed = missed.collect();
        Self { layers, missed }
    }

    /// The first layer that was not crossed.
    fn missed(&self) -> Option<Missed> {
        self.missed.first().copied()
    }

    /// Adds a place of the finger, and how it moves there: any vector of that direction.
    fn cross(&mut self, x_m: f64, y_m: f64, way: (f64, f64)) {
        let Self { layers, missed } = self;
        missed.retain(|missed| {
            let middle = &missed.middle;
            let is_crossed = (x_m - middle.x_m).abs() <= MIDDLE_PART * middle.width_m
                && (y_m - middle.y_m).abs() <= MIDDLE_PART * middle.height_m
                && missed.is_crossed_by(way)
                && layers.is_touched_at(missed.layer, x_m, y_m);
            !is_crossed
        });
    }

    /// Appends the places of a stroke that begins at `start_s`, and adds them.
    fn add(&mut self, places: &mut Vec<(f64, Option<Point>)>, stroke: &Stroke, start_s: f64) {
        let seconds = stroke.duration_s();
        let steps = (seconds / SAMPLE_PERIOD_S).ceil().max(1.0);
        let mut last: Option<Point> = None;
        for step in 0..=steps as u32 {
            let t_s = seconds * f64::from(step) / steps;
            let place = stroke.at(t_s).map(|finger| Point { x_m: finger.x_m, y_m: finger.y_m });
            if let Some((Point { x_m, y_m }, last)) = place.zip(last) {
                self.cross(x_m, y_m, (x_m - last.x_m, y_m - last.y_m));
            }
            last = place;
            places.push((start_s + t_s, place));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::fs;
    use std::path::Path;

    use frixel_hil_sim::{FingerState, RigConfig};
    use frixel_scene::reference::{Context, Reference, direction_of};
    use frixel_scene::{Scene, compile};

    use super::*;
    use crate::input::SceneFolder;

    #[test]
    fn the_default_stroke_crosses_the_middle_of_every_layer_of_every_bundled_scene() {
        let scenes = SceneFolder(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes"));
        for file in fs::read_dir(&scenes.0).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let text = fs::read(&path).unwrap();
            let (missed, seconds) = missed(&Scene::parse(&text, "scene.toml", &scenes).unwrap());
            assert!(missed.is_empty(), "{}: {missed:?}", path.display());
            assert!(seconds < 10.0, "{}: {seconds} s", path.display());
        }
    }

    #[test]
    fn the_default_stroke_goes_on_to_a_layer_whose_middle_the_sweep_misses() {
        for (region, is_visited) in [
            ("{ x_mm = 58, y_mm = 2, width_mm = 3, height_mm = 3 }", true),
            // The sweep clips its corner.
            ("{ x_mm = 10, y_mm = 2, width_mm = 30, height_mm = 8 }", true),
            // A groove along x, which is crossed along y.
            ("{ x_mm = 0, y_mm = 76, width_mm = 120, height_mm = 1 }", true),
            ("{ x_mm = 30, y_mm = 20, width_mm = 60, height_mm = 40 }", false),
        ] {
            let text =
                format!("version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\nregion = {region}\n");
            let (missed, seconds) = missed(&parsed(&text));
            assert!(missed.is_empty(), "{region}: {missed:?}");
            assert_eq!(seconds > SWEEP_S, is_visited, "{region}");
        }
    }

    /// The sweep goes along x, and would feel a flat plate.
    #[test]
    fn the_default_stroke_crosses_stripes() {
        for region in ["", "region = { x_mm = 30, y_mm = 30, width_mm = 30, height_mm = 40 }\n"] {
            for (angle_deg, is_visited) in [(0, false), (30, false), (90, true), (-100, true)] {
                let text = format!(
                    "version = 1\n[[layer]]\nkind = \"grating\"\nwavelength_mm = 4\nangle_deg = {angle_deg}\n\
                     low_fraction = 0\nhigh_fraction = 0.9\n{region}"
                );
                let (_, stroke) = of(&parsed(&text));
                assert_eq!(stroke.duration_s() > SWEEP_S, is_visited, "{angle_deg} {region}");
                if is_visited {
                    let end = stroke.duration_s();
                    let [from, to] = [end - 0.25, end - 0.05].map(|t_s| stroke.at(t_s).unwrap());
                    let way = ((to.x_m - from.x_m), (to.y_m - from.y_m));
                    let across = f64::from(angle_deg).to_radians();
                    let part = (way.0 * across.cos() + way.1 * across.sin()).abs() / way.0.hypot(way.1);
                    assert!(part > 0.99, "{angle_deg}: {part} of its way goes across the stripes");
                }
            }
        }
    }

    /// The sweep slides over a small place one way only.
    #[test]
    fn the_default_stroke_goes_both_ways_over_what_depends_on_the_direction() {
        for region in ["", "region = { x_mm = 30, y_mm = 2, width_mm = 20, height_mm = 10 }\n"] {
            for angle_deg in [0, 45, 90, -120] {
                let text = format!(
                    "version = 1\n[[layer]]\nkind = \"direction\"\nangle_deg = {angle_deg}\nalong_fraction = 0.1\n\
                     against_fraction = 0.9\n{region}"
                );
                let (program, stroke) = of(&parsed(&text));
                let reference = Reference::new(&program);
                let places = (0..).map(|step| 1e-3 * f64::from(step)).take_while(|t_s| *t_s <= stroke.duration_s());
                let fingers: Vec<_> = places.filter_map(|t_s| stroke.at(t_s)).collect();
                let parts = fingers.array_windows().map(|[before, finger]| {
                    let FingerState { x_m, y_m, speed_m_per_s } = *finger;
                    let direction = direction_of([x_m - before.x_m, y_m - before.y_m]);
                    let context = Context { x_m, y_m, speed_m_per_s, direction, ..Context::default() };
                    reference.electric_friction_at_n(&context) / program.reach.electric_friction_max_n
                });
                // The bare screen has 0.
                let on_layer = parts.filter(|part| *part > 0.05);
                let (least, most) =
                    on_layer.fold((1.0_f64, 0.0_f64), |(least, most), part| (least.min(part), most.max(part)));
                assert!(least < 0.31 && most > 0.69, "{angle_deg} {region}: {least} to {most}");
            }
        }
    }

    fn parsed(text: &str) -> Scene {
        Scene::parse(text, "scene.toml", &BTreeMap::<String, Vec<u8>>::new()).unwrap()
    }

    /// A scene on the simulator's board, and its default stroke.
    fn of(scene: &Scene) -> (Program, Stroke) {
        let board = RigConfig::default().board;
        let program = compile(scene, &board.limits, board.tick_hz).unwrap();
        let stroke = default_stroke(&program, None).unwrap();
        (program, stroke)
    }

    /// The layers whose middle the default stroke misses by a fifth of a side, and its length in seconds.
    fn missed(scene: &Scene) -> (Vec<String>, f64) {
        let (program, stroke) = of(scene);
        let steps = (0..).map(|step| 1e-4 * f64::from(step)).take_while(|t_s| *t_s <= stroke.duration_s());
        let way: Vec<_> = steps.filter_map(|t_s| stroke.at(t_s)).collect();
        let layers = TouchedLayers::new(&program);
        let is_missed = |layer: &usize| {
            let LayerMiddle { x_m, y_m, width_m, height_m } = layers.middle(*layer).unwrap();
            !way.iter().any(|finger| {
                let (x, y) = ((finger.x_m - x_m) / width_m, (finger.y_m - y_m) / height_m);
                x.abs().max(y.abs()) <= 0.2 && layers.is_touched_at(*layer, finger.x_m, finger.y_m)
            })
        };
        let titles = (0..layers.layer_count())
            .filter(is_missed)
            .filter_map(|layer| layers.title(layer))
            .map(ToString::to_string)
            .collect();
        (titles, stroke.duration_s())
    }
}
