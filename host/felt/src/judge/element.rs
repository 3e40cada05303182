//! Elements: the layers of a program, as judged.

use frixel_hil_sim::Stroke;
use frixel_layers::{Blend, Burst, Direction, Layer, Record, Region, Vibration};
use frixel_scene::reference::Reference;
use frixel_scene::{LayerTitle, Program, without_place};

use super::way::Way;

/// Speeds of the three strokes, m/s: slow, usual and fast exploration. Assumed.
pub(super) const SPEEDS_M_PER_S: [f64; 3] = [0.02, 0.05, 0.1];

/// Longest pause between two bursts of a judged program, s: a finger that crosses 4 mm at the slowest speed then meets
/// a burst. A longer pause is a reason of its own.
pub(super) const PAUSE_MAX_S: f32 = 0.2;

/// A layer of a program, and the way across it.
#[derive(Clone, Debug)]
pub struct Element {
    /// Index of the layer from the bottom.
    pub(super) layer: usize,
    pub(super) title: LayerTitle,
    pub(super) program: Program,
    pub(super) burst: Option<Burst>,
    /// Whether the layer is switched on by a program or a person, or was on during the play.
    pub(super) is_triggered: bool,
    /// The way across it; absent for a layer of a recorded play.
    pub(super) way: Option<Way>,
}

/// Returns three strokes across an element, at 20, 50 and 100 mm/s. They cover the part that no other layer replaces,
/// and 10 mm beyond, within the screen. If a layer of the scene depends on the direction, they go there and back.
pub fn strokes(element: &Element) -> Vec<Stroke> {
    let there_and_back = element.program.records.iter().any(|record| matches!(record.layer, Layer::Direction(_)));
    let way = element.way.as_ref();
    SPEEDS_M_PER_S.iter().filter_map(|speed| way?.stroke(*speed, there_and_back)).collect()
}

impl Element {
    /// A layer of a program, given its index from the bottom; `None` if it is visible nowhere.
    pub fn of(program: &Program, layer: usize) -> Option<Self> {
        let record = program.records.get(layer)?;
        let mut element = Self::as_played(program, layer)?;
        let program = &mut element.program;
        let start = program.start.get_mut(layer)?;
        element.is_triggered = !start.on;
        start.on = true;
        let axis_turns = match record.layer {
            Layer::Direction(Direction { angle_turns, .. }) => Some(f64::from(angle_turns)),
            _ => None,
        };
        for record in &mut program.records {
            if let Layer::Vibration(Vibration { burst, .. }) = &mut record.layer {
                burst.period_s = burst.period_s.min(burst.on_s + PAUSE_MAX_S);
            }
        }
        let screen_m = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
        let reference = Reference::at_start(program);
        let joins = matches!(record.blend, Blend::Add | Blend::Max);
        let starts_on = |other: usize| program.start.get(other).is_none_or(|setting| setting.on);
        let below = reference.clone().with_only(|other| joins && other < layer && starts_on(other));
        element.way = Some(Way::across(layer, axis_turns, [&reference, &below], screen_m)?);
        Some(element)
    }

    /// A layer of a recorded program.
    pub(super) fn as_played(program: &Program, layer: usize) -> Option<Self> {
        let burst = match program.records.get(layer)?.layer {
            Layer::Vibration(vibration) if vibration.burst.period_s > 0.0 => Some(vibration.burst),
            _ => None,
        };
        let title = program.titles.get(layer)?.clone();
        Some(Self { layer, title, program: program.clone(), burst, is_triggered: true, way: None })
    }

    /// The program for judging the element: the element is on, and pauses between bursts are short.
    pub fn program(&self) -> &Program {
        &self.program
    }

    pub(super) fn record(&self) -> Option<&Record> {
        self.program.records.get(self.layer)
    }

    /// Whether another element differs only in place and rotation, and thus feels the same.
    pub(super) fn is_copy_of(&self, other: &Self) -> bool {
        let of_one_table = self.title.number().table == other.title.number().table;
        let size = |element: &Self| match element.record()?.region {
            Region::Rectangle { width_m, height_m, .. } => Some((0, width_m, height_m)),
            Region::Ellipse { width_m, height_m, .. } => Some((1, width_m, height_m)),
            Region::Screen | Region::Polygon { .. } => None,
        };
        let is_same_size = size(self).is_some() && size(self) == size(other);
        let setting = |element: &Self| element.program.start.get(element.layer).copied();
        let blend = |element: &Self| element.record().map(|record| record.blend);
        (of_one_table || is_same_size)
            && self.has_parameters_of(other)
            && (setting(self), blend(self), self.burst) == (setting(other), blend(other), other.burst)
    }

    /// Whether another element differs only in place, size and rotation.
    pub(super) fn has_parameters_of(&self, other: &Self) -> bool {
        let placeless = |element: &Self| element.record().map(|record| without_place(record.layer));
        placeless(self) == placeless(other)
    }

    /// The smaller side of its region, or the width at half height of a ridge, m; infinite for the whole screen.
    pub(super) fn extent_m(&self) -> f64 {
        let Some(record) = self.record() else { return f64::INFINITY };
        let region_m = match record.region {
            Region::Rectangle { width_m, height_m, .. } | Region::Ellipse { width_m, height_m, .. } => {
                f64::from(width_m.min(height_m))
            }
            Region::Screen | Region::Polygon { .. } => f64::INFINITY,
        };
        match record.layer {
            Layer::Edge(edge) => region_m.min(0.5 * f64::from(edge.width_m)),
            _ => region_m,
        }
    }

    /// Whether it adds to the layers below, so that they are perceived together.
    pub(super) fn joins_those_below(&self) -> bool {
        self.record().is_some_and(|record| matches!(record.blend, Blend::Add | Blend::Max))
    }
}
