//! The stroke of a play without a stroke of its own.

use frixel_hil_sim::{Point, Stroke, StrokeError};
use frixel_scene::{LayerMiddle, Program, TouchedLayers};

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

/// An even stroke over the screen of a program, for `seconds`, or for as long as it takes to cross the middle of every
/// layer: first a sweep over the screen, and then a stroke over each layer whose middle the sweep misses, across the
/// shorter side of the layer.
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
    while let Some(middle) = middles.missed() {
        places.push((t_s + 0.5 * PAUSE_S, None));
        t_s += PAUSE_S;
        let visit = visit(&middle, screen_m)?;
        middles.add(&mut places, &visit, t_s);
        // The layer may be narrower than the distance between two samples.
        middles.cross(middle.x_m, middle.y_m);
        t_s += visit.duration_s();
    }
    Stroke::through(&places)
}

/// A stroke through the middle of a layer, across its shorter side.
fn visit(middle: &LayerMiddle, (width_m, height_m): (f64, f64)) -> Result<Stroke, StrokeError> {
    let half_m = |side_m: f64| 0.5 * (side_m + 2.0 * VISIT_MARGIN_M).max(VISIT_MIN_M);
    let (half_x_m, half_y_m) =
        if middle.width_m <= middle.height_m { (half_m(middle.width_m), 0.0) } else { (0.0, half_m(middle.height_m)) };
    let place = |sign: f64| Point {
        x_m: (middle.x_m + sign * half_x_m).clamp(0.0, width_m),
        y_m: (middle.y_m + sign * half_y_m).clamp(0.0, height_m),
    };
    let (from, to) = (place(-1.0), place(1.0));
    let length_m = (to.x_m - from.x_m).hypot(to.y_m - from.y_m);
    Stroke::minimum_jerk(from, to, length_m / VISIT_M_PER_S)
}

/// The layers whose middle a finger has crossed.
struct Middles {
    layers: TouchedLayers,
    /// The middle of each layer that is to be crossed; `None` for one that was, or that cannot be touched.
    missed: Vec<Option<LayerMiddle>>,
}

impl Middles {
    fn new(program: &Program) -> Self {
        let layers = TouchedLayers::new(program);
        let missed = (0..layers.layer_count()).map(|layer| layers.middle(layer)).collect();
        Self { layers, missed }
    }

    /// The first middle that was not crossed.
    fn missed(&self) -> Option<LayerMiddle> {
        self.missed.iter().find_map(|middle| *middle)
    }

    /// Adds a place of the finger.
    fn cross(&mut self, x_m: f64, y_m: f64) {
        for (layer, missed) in self.missed.iter_mut().enumerate() {
            let is_near = |middle: &mut LayerMiddle| {
                (x_m - middle.x_m).abs() <= MIDDLE_PART * middle.width_m
                    && (y_m - middle.y_m).abs() <= MIDDLE_PART * middle.height_m
            };
            if missed.as_mut().is_some_and(is_near) && self.layers.is_touched_at(layer, x_m, y_m) {
                *missed = None;
            }
        }
    }

    /// Appends the places of a stroke that begins at `start_s`, and adds them.
    fn add(&mut self, places: &mut Vec<(f64, Option<Point>)>, stroke: &Stroke, start_s: f64) {
        let seconds = stroke.duration_s();
        let steps = (seconds / SAMPLE_PERIOD_S).ceil().max(1.0);
        for step in 0..=steps as u32 {
            let t_s = seconds * f64::from(step) / steps;
            let place = stroke.at(t_s).map(|finger| Point { x_m: finger.x_m, y_m: finger.y_m });
            if let Some(Point { x_m, y_m }) = place {
                self.cross(x_m, y_m);
            }
            places.push((start_s + t_s, place));
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::path::Path;

    use frixel_hil_sim::RigConfig;
    use frixel_scene::{Scene, compile};

    use super::*;
    use crate::scene_file;

    #[test]
    fn the_default_stroke_crosses_the_middle_of_every_layer_of_every_bundled_scene() {
        for file in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let (missed, seconds) = missed(&scene_file::load(&path).unwrap());
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
                format!("version = 2\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\nregion = {region}\n");
            let scene = Scene::parse(&text, "corner.toml", &BTreeMap::<String, Vec<u8>>::new()).unwrap();
            let (missed, seconds) = missed(&scene);
            assert!(missed.is_empty(), "{region}: {missed:?}");
            assert_eq!(seconds > SWEEP_S, is_visited, "{region}");
        }
    }

    /// The layers whose middle the default stroke misses by a fifth of a side, and its length in seconds.
    fn missed(scene: &Scene) -> (Vec<String>, f64) {
        let board = RigConfig::default().board;
        let program = compile(scene, &board.limits, board.tick_hz).unwrap();
        let stroke = default_stroke(&program, None).unwrap();
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
