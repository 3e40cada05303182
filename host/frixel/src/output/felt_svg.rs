//! `felt.svg`: friction and voltage over time.

use super::off_strip;
use super::span::{Extremes, Span, TracedLayer};
use super::trace::Trace;
use super::{DrawingError, Subject, svg};
use frixel_chart::{Axis, Chart, Line, Look, Margins, PALETTE, Panel, RGBColor, Strip, StripCell};
use frixel_scene::Reach;

const REFERENCE: RGBColor = RGBColor(0xf2, 0xb1, 0x34);
const FELT: RGBColor = PALETTE[0];
const VOLTAGE: RGBColor = PALETTE[1];
const REACH: RGBColor = RGBColor(0x55, 0x88, 0xb0);
const REACH_OPACITY: f64 = 0.12;

/// Heights of the friction and the voltage panel, in pixels.
const HEIGHTS: (u32, u32) = (350, 240);
const PLOT_WIDTH: f64 = 900.0;
/// Width of a slice of the time axis, in pixels. Each slice is drawn either as a line or as an envelope.
const PIECE: f64 = 6.0;
/// A signal that changes direction this often within five slices has periods shorter than five pixels, and is drawn as
/// its envelope. A change of direction counts only when it is larger than this part of the axis.
const TURNS_MAX: usize = 12;
const TURN_MIN: f64 = 0.03;
/// Opacity of an envelope.
const OPACITY: f64 = 0.4;

/// The sentence of the caption that explains an envelope.
const ENVELOPE: &str = "Blocks are envelopes: the signal changes too fast to draw as a line there, and a block reaches \
                        from its smallest to its largest value.";

/// Selects one quantity of a span.
type Part = fn(&Span) -> Option<Extremes>;

/// Draws reference and felt friction over time, and the voltage below them; the reachable range is shaded. Where the
/// felt friction is unknown, as on a real board, the commanded friction is drawn instead. Signals that change too fast
/// for a line are drawn as their envelope. Strips below the time show the length of the finger's path, the layer under
/// it, and why the output is off.
pub(crate) fn draw_felt_svg(subject: &Subject, trace: &Trace, reach: &Reach) -> Result<String, DrawingError> {
    svg(&chart(subject, trace, reach))
}

fn chart(subject: &Subject, trace: &Trace, reach: &Reach) -> Chart {
    let spans = trace.spans();
    let (above, fast_friction) = friction(spans, reach);
    let (mut below, fast_voltage) = voltage(spans);
    for strip in [path_strip(spans, &below.x), layers(trace)].into_iter().flatten() {
        below.add_strip(strip);
    }
    off_strip::add_to(&mut below, spans);
    let mut chart = Chart::new(vec![above, below], 1);
    chart.title = subject.title();
    if fast_friction || fast_voltage {
        chart.caption.push(ENVELOPE.to_owned());
    }
    chart
}

/// The panel of reference and felt friction, and whether either is drawn as an envelope.
fn friction(spans: &[Span], reach: &Reach) -> (Panel, bool) {
    let felt = spans.iter().any(|span| span.felt_n.is_some());
    let (name, second): (_, Part) =
        if felt { ("felt", |span| span.felt_n) } else { ("commanded", |span| span.commanded_n) };
    let first: Part = |span| span.reference_n;
    let (natural_mn, most_mn) = (1e3 * reach.friction_min_n(), 1e3 * reach.friction_max_n());
    let drawn = [while_sliding(spans, first), while_sliding(spans, second)].into_iter().flatten();
    let (low, high) = drawn
        .fold((natural_mn, most_mn), |(low, high), range| (low.min(1e3 * range.least), high.max(1e3 * range.largest)));
    let (start, end) = times(spans);
    let mut panel = panel("friction, mN", (start, end), (low, high), HEIGHTS.0);
    panel.margins.bottom = 26;
    panel.x.label.clear();
    let corners = [(start, natural_mn), (end, natural_mn), (end, most_mn), (start, most_mn)];
    panel.add("reachable", Look::line(REACH, Line::Filled(REACH_OPACITY)), corners.to_vec());
    let signals = [("reference", REFERENCE, Line::Thick, first), (name, FELT, Line::Solid, second)];
    let mut is_fast = false;
    for (name, colour, line, part) in signals {
        let signal = Signal { part, scale: 1e3, range: high - low };
        is_fast |= signal.add_to(&mut panel, spans, name, Look::line(colour, line));
    }
    (panel, is_fast)
}

/// The panel of the voltage, and whether it is drawn as an envelope.
fn voltage(spans: &[Span]) -> (Panel, bool) {
    let part: Part = |span| span.voltage_v_rms;
    let largest = extremes(spans, part).map_or(0.0, |range| range.largest).max(1.0);
    let mut panel = panel("voltage, V rms", times(spans), (0.0, largest), HEIGHTS.1);
    let signal = Signal { part, scale: 1.0, range: largest };
    let is_fast = signal.add_to(&mut panel, spans, "", Look::line(VOLTAGE, Line::Solid));
    (panel, is_fast)
}

/// The length of the finger's path at the labelled times; `None` without a finger.
fn path_strip(spans: &[Span], time: &Axis) -> Option<Strip> {
    let total_mm = spans.last().map(|span| span.path_mm).filter(|path_mm| *path_mm > 0.0)?;
    let decimals = usize::from(total_mm < 20.0);
    let at = |t_s: f64| spans.iter().find(|span| span.end_s >= t_s).map_or(total_mm, |span| span.path_mm);
    let cell = |t_s: f64| StripCell { x: t_s..t_s, text: format!("{:.decimals$}", at(t_s)), colour: None };
    Some(Strip { label: "path, mm".to_owned(), cells: time.ticks().into_iter().map(cell).collect() })
}

/// The topmost layer under the finger over time, without a colour while it is off; `None` if no layer is known.
fn layers(trace: &Trace) -> Option<Strip> {
    let mut cells: Vec<StripCell> = Vec::new();
    let mut last: Option<TracedLayer> = None;
    for span in trace.spans() {
        match (span.layer, cells.last_mut()) {
            (Some(layer), Some(cell)) if last == Some(layer) => cell.x.end = span.end_s,
            (Some(layer), before) => {
                // Cells that follow each other touch.
                let start_s = before.filter(|_| last.is_some()).map_or(span.start_s, |before| before.x.end);
                let colour = PALETTE.get(layer.index % PALETTE.len()).copied().filter(|_| !layer.is_off);
                let text = format!("{}{}", trace.name(layer), if layer.is_off { " off" } else { "" });
                cells.push(StripCell { x: start_s..span.end_s, text, colour });
            }
            (None, _) => {}
        }
        last = span.layer;
    }
    (!cells.is_empty()).then(|| Strip { label: "layer".to_owned(), cells })
}

/// An empty panel over time, whose vertical axis extends a twentieth of the range beyond both ends.
fn panel(label: &str, times: (f64, f64), (low, high): (f64, f64), height: u32) -> Panel {
    let margin = 0.05 * (high - low).max(1e-6);
    let x = Axis::linear("time, s", times.0..times.1).with_labels(12.0);
    let y = Axis::linear(label, low - margin..high + margin);
    Panel { height, margins: Margins { left: 80, right: 20, top: 8, bottom: 44 }, ..Panel::new("", x, y) }
}

/// The first and the last time, in seconds; one second apart if there are no spans.
fn times(spans: &[Span]) -> (f64, f64) {
    match (spans.first(), spans.last()) {
        (Some(first), Some(last)) if last.end_s > first.start_s => (first.start_s, last.end_s),
        (Some(first), _) => (first.start_s, first.start_s + 1.0),
        _ => (0.0, 1.0),
    }
}

/// Least and largest value of `part` over all spans; `None` if no span has it.
fn extremes(spans: &[Span], part: Part) -> Option<Extremes> {
    spans.iter().filter_map(part).reduce(Extremes::joined)
}

/// The extremes over the spans in which friction is at least half of its median. Where a finger lands or turns, its
/// friction goes through zero within micrometres, which would leave little of the axis for the scene.
fn while_sliding(spans: &[Span], part: Part) -> Option<Extremes> {
    let mut lows: Vec<f64> = spans.iter().filter_map(part).map(|range| range.least).collect();
    lows.sort_by(f64::total_cmp);
    let median = lows.get(lows.len() / 2).copied()?;
    spans.iter().filter_map(part).filter(|range| range.least >= 0.5 * median).reduce(Extremes::joined)
}

/// How to draw one quantity of the spans.
struct Signal {
    part: Part,
    /// Factor from the quantity's unit to the axis' unit.
    scale: f64,
    /// Length of the axis, in its unit.
    range: f64,
}

/// A short interval of time, with the signal in it.
#[derive(Default)]
struct Slice {
    /// Points of the line.
    line: Vec<(f64, f64)>,
    turns: usize,
}

impl Signal {
    /// Adds the signal to a panel: as a line, or as its envelope where it changes too fast for a line. Returns whether
    /// there is an envelope.
    fn add_to(&self, panel: &mut Panel, spans: &[Span], name: &str, look: Look) -> bool {
        let envelope = Look { line: Line::Filled(OPACITY), ..look };
        let comma = if name.is_empty() { "" } else { ", " };
        let too_fast = format!("{name}{comma}envelope, minimum to maximum");
        let mut names = [Some(name), Some(too_fast.as_str())];
        let (start_s, end_s) = times(spans);
        let piece_s = (end_s - start_s) * PIECE / PLOT_WIDTH;
        for stretch in self.stretches(spans) {
            for (fast, places) in runs(&self.slices(&stretch, start_s, piece_s)) {
                let (look, points) = if fast { (envelope, envelope_of(&places, piece_s)) } else { (look, places) };
                panel.add(names[usize::from(fast)].take().unwrap_or_default(), look, points);
            }
        }
        if let Some(name) = names[0] {
            panel.add(name, look, Vec::new());
        }
        names[1].is_none()
    }

    /// Lines through least and largest value of each span; a span without a value ends a line.
    fn stretches(&self, spans: &[Span]) -> Vec<Vec<(f64, f64)>> {
        let mut stretches = vec![Vec::new()];
        for span in spans {
            match ((self.part)(span), stretches.last_mut()) {
                (Some(Extremes { least, largest }), Some(stretch)) => {
                    let (least, largest) = (self.scale * least, self.scale * largest);
                    // The extreme nearer to the end of the line comes first.
                    let last = stretch.last().map(|&(_, last): &(f64, f64)| last);
                    let falls = last.is_some_and(|last| (last - largest).abs() < (last - least).abs());
                    let (first, second) = if falls { (largest, least) } else { (least, largest) };
                    stretch.push((span.start_s, first));
                    if largest > least {
                        stretch.push((span.end_s, second));
                    }
                }
                _ => stretches.push(Vec::new()),
            }
        }
        stretches.retain(|stretch| !stretch.is_empty());
        stretches
    }

    /// Cuts a line into slices of equal duration, and counts the changes of direction in each.
    fn slices(&self, stretch: &[(f64, f64)], start_s: f64, piece_s: f64) -> Vec<Slice> {
        let number = |time_s: f64| ((time_s - start_s) / piece_s) as usize;
        let first = stretch.first().map_or(0, |place| number(place.0));
        let mut slices: Vec<Slice> = Vec::new();
        // The value at the last change of direction, and the direction since then.
        let (mut turn, mut rises) = (stretch.first().map_or(0.0, |place| place.1), None);
        for &(time_s, value) in stretch {
            let place = number(time_s) - first;
            slices.resize_with(slices.len().max(place + 1), Slice::default);
            let Some(slice) = slices.get_mut(place) else { continue };
            slice.line.push((time_s, value));
            let further = rises.is_some_and(|rises| (value > turn) == rises);
            if further {
                turn = value;
            } else if (value - turn).abs() > TURN_MIN * self.range {
                slice.turns += usize::from(rises.is_some());
                (turn, rises) = (value, Some(value > turn));
            }
        }
        slices
    }
}

/// Joins consecutive slices that are drawn in the same way. Each run has whether it is drawn as an envelope, and its
/// points, starting at the end of the previous run.
fn runs(slices: &[Slice]) -> Vec<(bool, Vec<(f64, f64)>)> {
    let turns = |place: usize| -> usize {
        let near = slices.iter().skip(place.saturating_sub(2)).take(place + 3 - place.saturating_sub(2));
        near.map(|slice| slice.turns).sum()
    };
    let mut runs: Vec<(bool, Vec<(f64, f64)>)> = Vec::new();
    for (place, slice) in slices.iter().enumerate() {
        let fast = turns(place) >= TURNS_MAX;
        match runs.last_mut() {
            Some((last, places)) if *last == fast => places.extend(&slice.line),
            Some((_, places)) => {
                let joint = places.last().copied();
                runs.push((fast, joint.into_iter().chain(slice.line.iter().copied()).collect()));
            }
            None => runs.push((fast, slice.line.clone())),
        }
    }
    runs
}

/// The polygon around the points: largest values from the first time to the last, then least values back.
fn envelope_of(places: &[(f64, f64)], piece_s: f64) -> Vec<(f64, f64)> {
    let mut upper: Vec<(f64, f64)> = Vec::new();
    let mut lower: Vec<(f64, f64)> = Vec::new();
    let mut rest = places;
    while let Some(&(start_s, _)) = rest.first() {
        let count = rest.iter().take_while(|(time_s, _)| *time_s < start_s + piece_s).count().max(1);
        let (slice, later) = rest.split_at(count);
        // Each slice has a point at its start and at its end, so that the envelope is continuous.
        let end_s = later.first().or(slice.last()).map_or(start_s, |place| place.0);
        let (least, largest) = slice.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, largest), (_, value)| {
            (least.min(*value), largest.max(*value))
        });
        upper.extend([(start_s, largest), (end_s, largest)]);
        lower.extend([(start_s, least), (end_s, least)]);
        rest = later;
    }
    lower.reverse();
    upper.extend(lower);
    upper
}

#[cfg(test)]
mod tests {
    use frixel_felt::recorder::FeltRow;
    use frixel_scene::{LayerNumber, LayerTitle};

    use super::*;

    #[test]
    fn a_layer_that_is_off_has_its_name_and_no_colour() {
        let mut trace = Trace::new();
        let title = |table, name| LayerTitle::new(LayerNumber { table, copy: None }, name, "noise");
        let (ok, noise) = (title(1, Some("ok")), title(2, None));
        for (number, title) in [&ok, &ok, &ok, &noise].into_iter().enumerate() {
            let layer = trace.layer(title, number == 1);
            trace.push(&FeltRow { t_s: number as f64, ..FeltRow::default() }, Some(layer));
        }
        let cells = layers(&trace).unwrap().cells;
        let shown: Vec<_> = cells.iter().map(|cell| (cell.text.as_str(), cell.colour)).collect();
        let [first, second] = [PALETTE[0], PALETTE[1]].map(Some);
        assert_eq!(shown, [("ok", first), ("ok off", None), ("ok", first), ("layer 2 (noise)", second)]);
    }

    #[test]
    fn the_axis_leaves_out_where_a_finger_turns() {
        let span = |least: f64| Span {
            start_s: 0.0,
            end_s: 0.0,
            reference_n: None,
            commanded_n: None,
            felt_n: Some(Extremes { least, largest: least + 0.01 }),
            voltage_v_rms: None,
            path_mm: 0.0,
            layer: None,
            rows: 1,
            off_rows: 0,
            off_reason: None,
        };
        let spans = [0.0, 0.25, 0.24, -0.26, 0.26].map(span);
        let felt: Part = |span| span.felt_n;
        assert_eq!(extremes(&spans, felt).unwrap().least.to_bits(), (-0.26_f64).to_bits());
        assert_eq!(while_sliding(&spans, felt), Some(Extremes { least: 0.24, largest: 0.27 }));
        assert_eq!(while_sliding(&[], felt), None);
    }
}
