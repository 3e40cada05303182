//! The target friction of a scene over its screen, as an image in memory.
//!
//! The input is a program. The output is a value for every pixel, with a caption. The caller adds colours and rulers
//! and writes files.

use frixel_layers::{Button, Edge, Layer};

use frixel_scene::reference::{Context, Reference};
use frixel_scene::{Origin, Program, ROUNDING, Reach};

use crate::GoesOn;

/// Settings of a preview.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preview {
    /// The finger's sliding speed, m/s. Only layers with a speed curve depend on it.
    pub speed_m_per_s: f64,
    /// Largest width and height of the map, in pixels.
    pub map_max: (u32, u32),
}

impl Default for Preview {
    /// 100 mm/s, within 1,000 by 800 pixels.
    fn default() -> Self {
        Self { speed_m_per_s: 0.1, map_max: (1_000, 800) }
    }
}

/// The pixels of a map of a screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapGrid {
    /// Pixels in a row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Width and height of the screen, mm.
    pub screen_mm: (f64, f64),
    pixels_per_mm: f64,
}

impl MapGrid {
    /// The largest map of a program's screen within a width and height in pixels.
    pub fn new(program: &Program, (width_max, height_max): (u32, u32)) -> Self {
        let mm = |metres: f32| (1e6 * f64::from(metres)).round() / 1e3;
        let screen_mm = (mm(program.header.screen_width_m), mm(program.header.screen_height_m));
        let pixels_per_mm = (f64::from(width_max) / screen_mm.0).min(f64::from(height_max) / screen_mm.1);
        let pixels = |mm: f64| (mm * pixels_per_mm).round().max(1.0) as usize;
        Self { width: pixels(screen_mm.0), height: pixels(screen_mm.1), screen_mm, pixels_per_mm }
    }

    /// The centre of each pixel, x and y in metres, row after row from the top left.
    pub fn places_m(&self) -> impl Iterator<Item = (f64, f64)> {
        let metres = |pixel: usize| (pixel as f64 + 0.5) / self.pixels_per_mm * 1e-3;
        (0..self.height).flat_map(move |row| (0..self.width).map(move |column| (metres(column), metres(row))))
    }
}

/// Position of a friction relative to the reachable range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReachSide {
    /// Below the friction at no voltage.
    Below,
    /// Within reach.
    Within,
    /// Above the friction at the largest voltage.
    Above,
}

impl ReachSide {
    /// Classifies an electric friction given as a fraction of the largest one: 0 to 1 is within reach, with a tolerance
    /// for rounding.
    pub fn of(part_of_reach: f64) -> Self {
        if part_of_reach > 1.0 + ROUNDING {
            Self::Above
        } else if part_of_reach < -ROUNDING {
            Self::Below
        } else {
            Self::Within
        }
    }
}

/// The target friction of a program at every pixel of its screen.
///
/// Vibrations and streams are shown at their largest target; the caption states this.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionMap {
    /// The pixels.
    pub grid: MapGrid,
    /// Electric friction at each pixel as a fraction of the largest reachable one, row by row from the top left; out of
    /// reach below 0 or above 1.
    pub parts_of_reach: Vec<f64>,
    /// Notes for reading the map, one sentence each.
    pub caption: Vec<String>,
}

impl FrictionMap {
    /// Computes the map of a program. If `goes_on` breaks, returns early: `parts_of_reach` then has fewer values than
    /// pixels.
    ///
    /// ```
    /// use std::collections::BTreeMap;
    /// use frixel_felt::{FrictionMap, Preview, TO_THE_END};
    /// use frixel_scene::{Scene, compile};
    /// # fn map(text: &str, limits: &frixel_wire::hello::BoardLimits) -> Result<(), frixel_scene::CompileError> {
    /// let program = compile(&Scene::parse(text, "grating.toml", &BTreeMap::new())?, limits, 40_000)?;
    /// let map = FrictionMap::new(&program, &Preview::default(), TO_THE_END);
    /// assert_eq!(map.parts_of_reach.len(), map.grid.width * map.grid.height);
    /// # Ok(())
    /// # }
    /// ```
    pub fn new(program: &Program, preview: &Preview, goes_on: GoesOn<'_>) -> Self {
        let grid = MapGrid::new(program, preview.map_max);
        let reference = Reference::at_start(program).with_vibrations_held();
        let part = |(x_m, y_m): (f64, f64)| {
            let speed_m_per_s = preview.speed_m_per_s;
            let context = Context { x_m, y_m, speed_m_per_s, stream: 1.0, stream_weight: 1.0, ..Context::default() };
            reference.electric_friction_at_n(&context) / program.reach.electric_friction_max_n
        };
        let places_m = grid.places_m().take_while(|_| goes_on().is_continue());
        let parts_of_reach: Vec<f64> = places_m.map(part).collect();
        let caption = caption(program, preview, &parts_of_reach);
        Self { grid, parts_of_reach, caption }
    }
}

fn caption(program: &Program, preview: &Preview, parts_of_reach: &[f64]) -> Vec<String> {
    let mut sentences = vec![finger(program)];
    match program.finger.origin {
        Origin::Assumed | Origin::Perceptual => {
            sentences.push("These newtons are assumed: the finger was not measured.".to_owned());
        }
        Origin::Empirical => sentences
            .push("These newtons are empirical: the finger was measured, and follows a law of its own.".to_owned()),
        Origin::Measured => {}
    }
    let any = |wanted: fn(&Layer) -> bool| program.records.iter().any(|record| wanted(&record.layer));
    if any(|layer| matches!(layer, Layer::Speed(_))) {
        sentences.push(format!("Sliding at {} mm/s.", rounded(1e3 * preview.speed_m_per_s)));
    }
    if any(|layer| matches!(layer, Layer::Direction(_))) {
        sentences.push("Layers that depend on the direction of the slide: the mean of both ways.".to_owned());
    }
    let at_most: Vec<&str> = [
        (any(|layer| matches!(layer, Layer::Vibration(_))), "vibration"),
        (any(|layer| matches!(layer, Layer::Stream(_))), "stream"),
    ]
    .into_iter()
    .filter_map(|(found, name)| found.then_some(name))
    .collect();
    if !at_most.is_empty() {
        sentences.push(format!("At the most that the {} asks for.", at_most.join(" and the ")));
    }
    if any(has_click) {
        sentences.push("Clicks are not drawn.".to_owned());
    }
    for (side, hatch, what) in [
        (ReachSide::Above, "Hatched black", "more than can be reached, and is clamped"),
        (ReachSide::Below, "Hatched white", "less than without voltage, and is clamped"),
    ] {
        if parts_of_reach.iter().any(|part| ReachSide::of(*part) == side) {
            sentences.push(format!("{hatch}: {what}."));
        }
    }
    sentences
}

/// Describes the finger's friction at no voltage and at the largest one.
fn finger(program: &Program) -> String {
    let Reach { voltage_max_v_rms, .. } = program.reach;
    format!(
        "Load {} N: {} mN without voltage, {} mN at {} V rms.",
        rounded(f64::from(program.header.normal_load_n)),
        rounded(1e3 * program.reach.friction_min_n()),
        rounded(1e3 * program.reach.friction_max_n()),
        rounded(voltage_max_v_rms)
    )
}

fn has_click(layer: &Layer) -> bool {
    match layer {
        Layer::Edge(Edge { click, .. }) | Layer::Button(Button { click, .. }) => click.height_n.abs() > 0.0,
        _ => false,
    }
}

/// At most four significant digits.
fn rounded(value: f64) -> f64 {
    // The formatted number always parses.
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::ReachSide::{Above, Below, Within};
    use super::*;

    #[test]
    fn four_significant_digits_are_left() {
        let texts = [123_456.0, 277.849, 0.012_345_6, 150.0, 0.0].map(|value| rounded(value).to_string());
        assert_eq!(texts, ["123500", "277.8", "0.01235", "150", "0"]);
    }

    #[test]
    fn a_rounding_error_is_within_reach() {
        let sides = [-0.1, -0.5e-6, 0.0, 0.5, 1.0 + 0.5e-6, 1.1].map(ReachSide::of);
        assert_eq!(sides, [Below, Within, Within, Within, Within, Above]);
    }
}
