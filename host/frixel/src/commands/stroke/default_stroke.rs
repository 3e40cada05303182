//! The stroke of a play without a stroke of its own.

use frixel_hil_sim::{Point, Stroke, StrokeError};
use frixel_scene::{Program, TouchedLayers};

/// Duration of the sweep over the screen without `--seconds`, s.
const SWEEP_S: f64 = 3.0;
/// Time between two places of a sampled motion, s.
const SAMPLE_PERIOD_S: f64 = 1e-3;
/// Time for which the finger is lifted before it visits a layer, s.
const PAUSE_S: f64 = 0.1;
/// Length of the stroke over a layer that the sweep misses, m, and its duration, s: 100 mm/s on average.
const VISIT_M: f64 = 0.03;
const VISIT_S: f64 = 0.3;

/// A natural stroke over the screen of a program, for `seconds`, or for as long as it takes to touch every layer: first
/// a sweep over the screen, and then a stroke over each layer that the sweep misses.
pub(in super::super) fn default_stroke(program: &Program, seconds: Option<f64>) -> Result<Stroke, StrokeError> {
    let screen_m = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
    let sweep = Stroke::natural(screen_m.0, screen_m.1, seconds.unwrap_or(SWEEP_S))?;
    if seconds.is_some() {
        return Ok(sweep);
    }
    let mut touched = TouchedLayers::new(program);
    let mut places = Vec::new();
    add(&mut places, &mut touched, &sweep, 0.0, sweep.duration_s());
    if touched.untouched().next().is_none() {
        return Ok(sweep);
    }
    let mut t_s = sweep.duration_s();
    loop {
        let missed = touched.untouched().find_map(|layer| touched.place_in(layer));
        let Some((x_m, y_m)) = missed else { return Stroke::through(&places) };
        places.push((t_s + 0.5 * PAUSE_S, None));
        t_s += PAUSE_S;
        let along = |x_m: f64| Point { x_m: x_m.clamp(0.0, screen_m.0), y_m };
        let visit = Stroke::minimum_jerk(along(x_m - 0.5 * VISIT_M), along(x_m + 0.5 * VISIT_M), VISIT_S)?;
        add(&mut places, &mut touched, &visit, t_s, VISIT_S);
        // The layer may be narrower than the distance between two samples.
        touched.add(x_m, y_m);
        t_s += VISIT_S;
    }
}

/// Appends the places of a stroke that begins at `start_s`.
fn add(
    places: &mut Vec<(f64, Option<Point>)>,
    touched: &mut TouchedLayers,
    stroke: &Stroke,
    start_s: f64,
    seconds: f64,
) {
    let steps = (seconds / SAMPLE_PERIOD_S).ceil().max(1.0);
    for step in 0..=steps as u32 {
        let t_s = seconds * f64::from(step) / steps;
        let place = stroke.at(t_s).map(|finger| Point { x_m: finger.x_m, y_m: finger.y_m });
        if let Some(Point { x_m, y_m }) = place {
            touched.add(x_m, y_m);
        }
        places.push((start_s + t_s, place));
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::path::Path;

    use frixel::scene_file;
    use frixel_hil_sim::RigConfig;
    use frixel_scene::{Scene, compile};

    use super::*;

    #[test]
    fn the_default_stroke_touches_every_layer_of_every_bundled_scene() {
        for file in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let (missed, _) = missed(&scene_file::load(&path).unwrap());
            assert!(missed.is_empty(), "{}: {missed:?}", path.display());
        }
    }

    #[test]
    fn the_default_stroke_goes_on_to_a_layer_that_the_sweep_misses() {
        let text = "version = 2\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n\
            region = { x_mm = 58, y_mm = 2, width_mm = 3, height_mm = 3 }\n";
        let scene = Scene::parse(text, "corner.toml", &BTreeMap::<String, Vec<u8>>::new()).unwrap();
        let (missed, seconds) = missed(&scene);
        assert!(missed.is_empty(), "{missed:?}");
        assert!(seconds > SWEEP_S, "the sweep alone misses it");
    }

    /// The layers that the default stroke misses, and its length in seconds.
    fn missed(scene: &Scene) -> (Vec<String>, f64) {
        let board = RigConfig::default().board;
        let program = compile(scene, &board.limits, board.tick_hz).unwrap();
        let stroke = default_stroke(&program, None).unwrap();
        let mut touched = TouchedLayers::new(&program);
        for finger in (0..).map(|ms| 1e-3 * f64::from(ms)).take_while(|t_s| *t_s <= stroke.duration_s()) {
            if let Some(finger) = stroke.at(finger) {
                touched.add(finger.x_m, finger.y_m);
            }
        }
        (touched.untouched().map(|layer| touched.title(layer).to_owned()).collect(), stroke.duration_s())
    }
}
