//! Downsampling of rows for pictures, in memory that does not grow with the length of a play.

use frixel_felt::judge::SLIDE_MIN_M_PER_S;
use frixel_felt::recorder::FeltRow;
use frixel_scene::LayerTitle;

use super::span::{Span, TracedLayer};

/// Largest number of time spans that are kept.
const SPANS_MAX: usize = 1_600;
/// Largest number of stroke points that are kept.
const PLACES_MAX: usize = 8_000;
/// Least distance between two stroke points, mm.
const PLACE_STEP_MM: f64 = 0.2;

/// Largest number of speeds that are stored for the median.
const SPEEDS_MAX: usize = 8_192;

/// Friction, voltage and stroke of a run. Long runs are reduced to the least and largest value of each span of time.
#[derive(Clone, Debug)]
pub(crate) struct Trace {
    spans: Vec<Span>,
    rows_per_span: usize,
    rows_in_last: usize,
    stroke: Vec<Option<(f64, f64)>>,
    place_step_mm: f64,
    speeds: Speeds,
    /// Length of the finger's path so far, mm, and its last place.
    path_mm: f64,
    last_place_mm: Option<(f64, f64)>,
    layers: Vec<LayerTitle>,
}

/// Every n-th speed of the sliding finger.
#[derive(Clone, Debug)]
struct Speeds {
    mm_s: Vec<f64>,
    rows_per_speed: usize,
    rows: usize,
}

impl Speeds {
    fn push(&mut self, speed_mm_s: f64) {
        if self.rows.is_multiple_of(self.rows_per_speed) {
            self.mm_s.push(speed_mm_s);
        }
        self.rows += 1;
        if self.mm_s.len() > SPEEDS_MAX {
            let mut index = 0_usize;
            self.mm_s.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.rows_per_speed *= 2;
        }
    }

    fn median_mm_s(&self) -> Option<f64> {
        let mut sorted = self.mm_s.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied()
    }
}

impl Default for Trace {
    fn default() -> Self {
        Self::new()
    }
}

impl Trace {
    /// Creates an empty trace.
    pub(crate) fn new() -> Self {
        Self {
            spans: Vec::new(),
            rows_per_span: 1,
            rows_in_last: 1,
            stroke: Vec::new(),
            place_step_mm: PLACE_STEP_MM,
            speeds: Speeds { mm_s: Vec::new(), rows_per_speed: 1, rows: 0 },
            path_mm: 0.0,
            last_place_mm: None,
            layers: Vec::new(),
        }
    }

    /// Registers a layer for [`Self::push`]. Layers of successive scenes with the same number and name are one layer.
    pub(crate) fn layer(&mut self, layer: &LayerTitle, is_off: bool) -> TracedLayer {
        let known = self.layers.iter().position(|known| known == layer);
        let index = known.unwrap_or_else(|| {
            self.layers.push(layer.clone());
            self.layers.len() - 1
        });
        TracedLayer { index, is_off }
    }

    /// Adds the next row, with the topmost layer under the finger.
    pub(crate) fn push(&mut self, row: &FeltRow, layer: Option<TracedLayer>) {
        let place_mm = row.x_mm.zip(row.y_mm);
        if let (Some(from), Some(to)) = (self.last_place_mm, place_mm) {
            let step_mm = (to.0 - from.0).hypot(to.1 - from.1);
            self.path_mm += if step_mm.is_finite() { step_mm } else { 0.0 };
        }
        self.last_place_mm = place_mm;
        self.push_span(Span::of(row, self.path_mm, layer));
        if let Some(speed_mm_s) = row.speed_mm_s.filter(|speed_mm_s| *speed_mm_s >= 1e3 * SLIDE_MIN_M_PER_S) {
            self.speeds.push(speed_mm_s);
        }
        self.push_place(row.x_mm.zip(row.y_mm).filter(|(x_mm, y_mm)| x_mm.is_finite() && y_mm.is_finite()));
    }

    /// The name of a layer; its title if it has no name.
    pub(super) fn name(&self, layer: TracedLayer) -> &str {
        self.layers.get(layer.index).map_or("", LayerTitle::name_or_title)
    }

    /// Spans in order of time.
    pub(super) fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// The stroke in mm, as one line per contact of the finger.
    pub(super) fn strokes(&self) -> impl Iterator<Item = Vec<(f64, f64)>> {
        self.stroke
            .split(Option::is_none)
            .filter(|piece| !piece.is_empty())
            .map(|piece| piece.iter().flatten().copied().collect())
    }

    /// Median speed of the finger while it slides, mm/s; `None` if it never did.
    pub(super) fn median_speed_mm_s(&self) -> Option<f64> {
        self.speeds.median_mm_s()
    }

    fn push_span(&mut self, span: Span) {
        match self.spans.last_mut() {
            Some(last) if self.rows_in_last < self.rows_per_span => {
                *last = last.join(&span);
                self.rows_in_last += 1;
            }
            _ => {
                self.spans.push(span);
                self.rows_in_last = 1;
            }
        }
        if self.spans.len() >= SPANS_MAX && self.rows_in_last == self.rows_per_span {
            let halved =
                self.spans.chunks(2).filter_map(|pair| pair.iter().copied().reduce(|one, other| one.join(&other)));
            self.spans = halved.collect();
            self.rows_per_span *= 2;
            self.rows_in_last = self.rows_per_span;
        }
    }

    fn push_place(&mut self, place: Option<(f64, f64)>) {
        match (self.stroke.last(), place) {
            (None | Some(None), None) => return,
            (Some(Some((x_mm, y_mm))), Some(place)) if (place.0 - x_mm).hypot(place.1 - y_mm) < self.place_step_mm => {
                return;
            }
            _ => self.stroke.push(place),
        }
        if self.stroke.len() >= PLACES_MAX {
            self.place_step_mm *= 2.0;
            let mut nth = 0_u32;
            self.stroke.retain(|place| {
                nth += u32::from(place.is_some());
                place.is_none() || nth % 2 == 1
            });
            self.stroke.dedup_by(|later, earlier| later.is_none() && earlier.is_none());
        }
    }
}
