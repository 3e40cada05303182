//! The friction map of a program before it is played: what a designer looks at.

use std::fs;
use std::path::Path;

use frixel_layers::{Button, Edge, Layer};

use super::OutputError;
use super::map::Frame;
use crate::chart::{RGBColor, colour};
use frixel_scene::reference::{Context, Reference};
use frixel_scene::{Program, ROUNDING, Reach};

/// Distance of the lines of a hatching, and their width, in pixels.
const HATCH_PITCH: usize = 8;
const HATCH_WIDTH: usize = 2;
const BLACK: RGBColor = RGBColor(0, 0, 0);
const WHITE: RGBColor = RGBColor(255, 255, 255);

/// How a preview is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preview {
    /// How fast the finger slides, m/s. Only curves of speed ask for it.
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

/// Where a place lies to the reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Below,
    Within,
    Above,
}

/// Writes the friction that a program wants all over the screen. The colours span the reach; what is beyond has the
/// colour of its end, and is hatched. Vibrations and streams are drawn at the most that they ask for; the caption says
/// so.
pub fn write_preview_png(path: &Path, title: &str, program: &Program, preview: &Preview) -> Result<(), OutputError> {
    let frame = Frame::of(program, (f64::from(preview.map_max.0), f64::from(preview.map_max.1)));
    let map = Map::of(program, preview, &frame);
    let pixels = frame.pixels().zip(&map.parts).map(|(((column, row), _), part)| colour_of(*part, column + row));
    let mut chart = frame.chart(pixels.collect(), &program.reach);
    title.clone_into(&mut chart.title);
    chart.caption = caption(program, preview, &map);
    let bytes = chart.png().map_err(OutputError::drawing(path))?;
    fs::write(path, bytes).map_err(|source| OutputError::File { path: path.to_owned(), source })
}

/// Friction of the reference at every pixel, as a part of the reach.
struct Map {
    parts: Vec<f64>,
}

impl Map {
    fn of(program: &Program, preview: &Preview, frame: &Frame) -> Self {
        let reference = Reference::new(program).with_vibrations_held();
        let part = |(x_m, y_m): (f64, f64)| {
            let speed_m_per_s = preview.speed_m_per_s;
            let context = Context { x_m, y_m, speed_m_per_s, stream: 1.0, stream_weight: 1.0, ..Context::default() };
            reference.electric_friction_at_n(&context) / program.reach.electric_friction_max_n
        };
        Self { parts: frame.pixels().map(|(_, place)| part(place)).collect() }
    }

    /// How much of the map lies on a side, in percent.
    fn percent(&self, wanted: Side) -> f64 {
        let found = self.parts.iter().filter(|part| side(**part) == wanted).count();
        100.0 * found as f64 / self.parts.len().max(1) as f64
    }
}

/// The colour of a part of the reach; beyond it, hatched along diagonals of the picture.
fn colour_of(part: f64, diagonal: usize) -> RGBColor {
    let hatched = diagonal % HATCH_PITCH < HATCH_WIDTH;
    match side(part) {
        Side::Below if hatched => WHITE,
        Side::Above if hatched => BLACK,
        _ => colour(part),
    }
}

fn side(part: f64) -> Side {
    if part > 1.0 + ROUNDING {
        Side::Above
    } else if part < -ROUNDING {
        Side::Below
    } else {
        Side::Within
    }
}

/// What a person has to know to read the map, a sentence each.
fn caption(program: &Program, preview: &Preview, map: &Map) -> Vec<String> {
    let header = &program.header;
    let Reach { voltage_max_v_rms, .. } = program.reach;
    let mut sentences = vec![format!(
        "Load {} N: {} mN without voltage, {} mN at {} V rms.",
        rounded(f64::from(header.normal_load_n)),
        rounded(1e3 * program.reach.friction_min_n()),
        rounded(1e3 * program.reach.friction_max_n()),
        rounded(voltage_max_v_rms)
    )];
    let any = |wanted: fn(&Layer) -> bool| program.records.iter().any(|record| wanted(&record.layer));
    let clicks = |layer: &Layer| matches!(layer, Layer::Edge(Edge { click, .. }) | Layer::Button(Button { click, .. }) if click.height_n.abs() > 0.0);
    let at_most: Vec<&str> = [
        (any(|layer| matches!(layer, Layer::Vibration(_))), "vibration"),
        (any(|layer| matches!(layer, Layer::Stream(_))), "stream"),
    ]
    .into_iter()
    .filter_map(|(found, name)| found.then_some(name))
    .collect();
    if any(|layer| matches!(layer, Layer::Speed(_))) {
        sentences.push(format!("Sliding at {} mm/s.", rounded(1e3 * preview.speed_m_per_s)));
    }
    if !at_most.is_empty() {
        sentences.push(format!("At the most that the {} asks for.", at_most.join(" and the ")));
    }
    if program.records.iter().any(|record| clicks(&record.layer)) {
        sentences.push("Clicks are not drawn.".to_owned());
    }
    for (side, hatch, what) in [
        (Side::Above, "Hatched black", "more than can be reached, and is clamped"),
        (Side::Below, "Hatched white", "less than without voltage, and is clamped"),
    ] {
        let percent = map.percent(side);
        if percent > 0.0 {
            sentences.push(format!("{hatch}: {:.1} % of the screen asks for {what}.", percent.max(0.1)));
        }
    }
    sentences
}

/// Four significant digits at most.
fn rounded(value: f64) -> f64 {
    let scale = 10f64.powi(3 - value.abs().max(1e-9).log10().floor() as i32);
    (value * scale).round() / scale
}
