//! Downsampling of rows for pictures, in memory that does not grow with the length of a play.

use frixel_felt::recorder::FeltRow;
use frixel_scene::LayerTitle;

use super::off_strip;

/// Largest number of time spans that are kept.
const SPANS_MAX: usize = 1_600;
/// Largest number of stroke points that are kept.
const PLACES_MAX: usize = 8_000;
/// Least distance between two stroke points, mm.
const PLACE_STEP_MM: f64 = 0.2;

/// Largest number of speeds that are stored for the median.
const SPEEDS_MAX: usize = 8_192;
/// A finger slower than this is left out of the median, mm/s.
const SLIDES_FROM_MM_S: f64 = 2.0;
/// A span counts as off if the output is off in this part of its rows. In a long play, the moments at which the finger
/// turns are less. A pause of a tenth of a second is not, in a play of up to ten minutes.
const OFF_PART_MIN: f64 = 0.1;

/// Friction, voltage and stroke of a run. Long runs are reduced to least and largest value of each span of time.
#[derive(Clone, Debug)]
pub(crate) struct Trace {
    spans: Vec<Span>,
    rows_per_span: usize,
    rows_in_last: usize,
    stroke: Vec<Option<(f64, f64)>>,
    place_step_mm: f64,
    speeds: Speeds,
    /// Length of the finger's way so far, mm, and its last place.
    way_mm: f64,
    last_place_mm: Option<(f64, f64)>,
    layers: Vec<LayerTitle>,
}

/// A layer that [`Trace::layer`] knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TracedLayer {
    /// Index of its title.
    pub(super) index: usize,
    pub(super) is_off: bool,
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

/// The extremes over consecutive rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) start_s: f64,
    pub(super) end_s: f64,
    pub(super) wanted_n: Option<Extremes>,
    pub(super) asked_n: Option<Extremes>,
    pub(super) felt_n: Option<Extremes>,
    pub(super) voltage_v_rms: Option<Extremes>,
    /// Length of the finger's way at the end of the span, mm.
    pub(super) way_mm: f64,
    /// The topmost layer under the finger at the end of the span.
    pub(super) layer: Option<TracedLayer>,
    pub(super) rows: u32,
    pub(super) off_rows: u32,
    /// The strongest reason for which the output is off at one of these rows, see [`off_strip::reason`].
    pub(super) off_reason: Option<usize>,
}

/// Least and largest value of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extremes {
    pub(super) least: f64,
    pub(super) largest: f64,
}

impl Extremes {
    fn of(value: Option<f64>) -> Option<Self> {
        value.filter(|value| value.is_finite()).map(|value| Self { least: value, largest: value })
    }

    /// The extremes of both ranges together.
    pub(super) fn joined(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), largest: self.largest.max(other.largest) }
    }

    fn join(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        match (one, other) {
            (Some(one), Some(other)) => Some(one.joined(other)),
            _ => one.or(other),
        }
    }
}

impl Span {
    fn of(row: &FeltRow, way_mm: f64, layer: Option<TracedLayer>) -> Self {
        let off_reason = off_strip::reason(row);
        Self {
            way_mm,
            layer,
            rows: 1,
            off_rows: u32::from(off_reason.is_some()),
            off_reason,
            start_s: row.t_s,
            end_s: row.t_s,
            wanted_n: Extremes::of(row.wanted_n),
            asked_n: Extremes::of(row.asked_n),
            felt_n: Extremes::of(row.felt_n),
            voltage_v_rms: Extremes::of(row.voltage_v_rms),
        }
    }

    fn join(&self, later: &Self) -> Self {
        Self {
            start_s: self.start_s,
            end_s: later.end_s,
            wanted_n: Extremes::join(self.wanted_n, later.wanted_n),
            asked_n: Extremes::join(self.asked_n, later.asked_n),
            felt_n: Extremes::join(self.felt_n, later.felt_n),
            way_mm: later.way_mm,
            layer: later.layer,
            rows: self.rows + later.rows,
            off_rows: self.off_rows + later.off_rows,
            off_reason: self.off_reason.into_iter().chain(later.off_reason).min(),
            voltage_v_rms: Extremes::join(self.voltage_v_rms, later.voltage_v_rms),
        }
    }

    /// Why the output is off; `None` if it is on for nearly all of the span.
    pub(super) fn off(&self) -> Option<usize> {
        self.off_reason.filter(|_| f64::from(self.off_rows) >= OFF_PART_MIN * f64::from(self.rows))
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
            way_mm: 0.0,
            last_place_mm: None,
            layers: Vec::new(),
        }
    }

    /// A layer for [`Self::push`]. Where a scene replaces another, layers with the same number and name are one.
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
            self.way_mm += if step_mm.is_finite() { step_mm } else { 0.0 };
        }
        self.last_place_mm = place_mm;
        self.push_span(Span::of(row, self.way_mm, layer));
        if let Some(speed_mm_s) = row.speed_mm_s.filter(|speed_mm_s| *speed_mm_s >= SLIDES_FROM_MM_S) {
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
