//! `felt.svg`: friction and voltage over time.

use std::fs;
use std::ops::Range;
use std::path::Path;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::OutputError;
use super::scale::label;
use super::trace::{Extremes, Span, Trace};
use frixel_scene::Reach;

/// Size of the picture as it is shown.
const WIDTH: u32 = 1_000;
const HEIGHT: u32 = 640;
/// The library places everything on whole units, so it draws on a canvas this many times as large.
const FINE: u32 = 8;

/// What drawings call the font; the viewer takes its own.
const FAMILY: &str = "sans-serif";

const WANTED: RGBColor = RGBColor(0xf2, 0xb1, 0x34);
const FELT: RGBColor = RGBColor(0x00, 0x72, 0xb2);
const VOLTAGE: RGBColor = RGBColor(0xd5, 0x5e, 0x00);
const REACH: RGBColor = RGBColor(0xee, 0xf3, 0xf7);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Box<dyn std::error::Error>>;

/// Writes wanted and felt friction, and below them the voltage, over time. Where nothing was felt, as on a real
/// board, the friction that was asked for stands in its place. `title` stands above; the reach is shaded.
pub fn write_felt_svg(path: &Path, title: &str, trace: &Trace, reach: &Reach) -> Result<(), OutputError> {
    let text = draw(title, trace, reach).map_err(|error| {
        let reason = error.to_string();
        OutputError::Drawing { path: path.to_owned(), reason }
    })?;
    fs::write(path, text).map_err(|source| OutputError::File { path: path.to_owned(), source })
}

fn draw(title: &str, trace: &Trace, reach: &Reach) -> Result<String, Box<dyn std::error::Error>> {
    let (width, height) = (WIDTH * FINE, HEIGHT * FINE);
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        root.fill(&WHITE)?;
        let root =
            root.margin(px(14), px(6), px(14), px(6)).titled(title, (FAMILY, px(19)).into_font().color(&BLACK))?;
        let (upper, lower) = root.margin(px(12), 0, 0, 0).split_vertically(px(350));
        let times = times(trace.spans());
        draw_friction(&upper, trace.spans(), reach, times.clone())?;
        draw_voltage(&lower, trace.spans(), times)?;
        root.present()?;
    }
    let (large, shown) =
        (format!("width=\"{width}\" height=\"{height}\""), format!("width=\"{WIDTH}\" height=\"{HEIGHT}\""));
    Ok(text.replacen(&large, &shown, 1))
}

fn px(shown: u32) -> u32 {
    shown * FINE
}

fn draw_friction(area: &Area, spans: &[Span], reach: &Reach, times: Range<f64>) -> Drawn {
    let felt = spans.iter().any(|span| span.felt_n.is_some());
    let (name, second): (_, fn(&Span) -> Option<Extremes>) =
        if felt { ("felt", |span| span.felt_n) } else { ("asked for", |span| span.asked_n) };
    let (natural_mn, most_mn) = (1e3 * reach.friction_min_n(), 1e3 * reach.friction_max_n());
    let drawn = [extremes(spans, |span| span.wanted_n), extremes(spans, second)].into_iter().flatten();
    let range = with_margin(drawn.fold((natural_mn, most_mn), |(least, largest), range| {
        (least.min(1e3 * range.least), largest.max(1e3 * range.largest))
    }));
    let mut chart = ChartBuilder::on(area)
        .margin_right(px(24))
        .x_label_area_size(px(8))
        .y_label_area_size(px(72))
        .build_cartesian_2d(times.clone(), range)?;
    chart.draw_series([Rectangle::new([(times.start, natural_mn), (times.end, most_mn)], REACH.filled())])?;
    chart
        .configure_mesh()
        .disable_x_axis()
        .y_desc("friction, mN")
        .y_labels(8)
        .y_label_formatter(&|value| label(*value))
        .label_style((FAMILY, px(15)))
        .axis_desc_style((FAMILY, px(16)))
        .set_all_tick_mark_size(px(5))
        .axis_style(BLACK.stroke_width(FINE))
        .bold_line_style(BLACK.mix(0.15).stroke_width(FINE))
        .light_line_style(TRANSPARENT)
        .draw()?;
    for (name, colour, width, part) in
        [("wanted", WANTED, px(5), wanted as fn(&Span) -> Option<Extremes>), (name, FELT, px(2), second)]
    {
        for line in lines(spans, part, 1e3) {
            chart.draw_series(LineSeries::new(line, colour.stroke_width(width)))?;
        }
        let empty = std::iter::empty::<PathElement<(f64, f64)>>();
        chart
            .draw_series(empty)?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + px(24) as i32, y)], colour.stroke_width(width)));
    }
    let empty = std::iter::empty::<PathElement<(f64, f64)>>();
    chart.draw_series(empty)?.label("reachable").legend(|(x, y)| {
        let half = px(6) as i32;
        Rectangle::new([(x, y - half), (x + px(24) as i32, y + half)], RGBColor(0xc9, 0xd8, 0xe4).filled())
    });
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .margin(px(10))
        .legend_area_size(px(32))
        .label_font((FAMILY, px(15)))
        .background_style(WHITE.mix(0.9))
        .border_style(BLACK.mix(0.3).stroke_width(FINE))
        .draw()?;
    Ok(())
}

fn wanted(span: &Span) -> Option<Extremes> {
    span.wanted_n
}

fn draw_voltage(area: &Area, spans: &[Span], times: Range<f64>) -> Drawn {
    let largest = extremes(spans, |span| span.voltage_v_rms).map_or(0.0, |range| range.largest);
    let mut chart = ChartBuilder::on(area)
        .margin_top(px(12))
        .margin_right(px(24))
        .x_label_area_size(px(46))
        .y_label_area_size(px(72))
        .build_cartesian_2d(times, with_margin((0.0, largest.max(1.0))))?;
    chart
        .configure_mesh()
        .x_desc("time, s")
        .y_desc("voltage, V rms")
        .x_labels(12)
        .y_labels(6)
        .x_label_formatter(&|value| label(*value))
        .y_label_formatter(&|value| label(*value))
        .label_style((FAMILY, px(15)))
        .axis_desc_style((FAMILY, px(16)))
        .set_all_tick_mark_size(px(5))
        .axis_style(BLACK.stroke_width(FINE))
        .bold_line_style(BLACK.mix(0.15).stroke_width(FINE))
        .light_line_style(TRANSPARENT)
        .draw()?;
    for line in lines(spans, |span| span.voltage_v_rms, 1.0) {
        chart.draw_series(LineSeries::new(line, VOLTAGE.stroke_width(2 * FINE)))?;
    }
    Ok(())
}

/// From the first time to the last; a second where there is no such stretch.
fn times(spans: &[Span]) -> Range<f64> {
    match (spans.first(), spans.last()) {
        (Some(first), Some(last)) if last.end_s > first.start_s => first.start_s..last.end_s,
        (Some(first), _) => first.start_s..first.start_s + 1.0,
        _ => 0.0..1.0,
    }
}

/// Least and largest value of all spans.
fn extremes(spans: &[Span], part: fn(&Span) -> Option<Extremes>) -> Option<Extremes> {
    spans
        .iter()
        .filter_map(part)
        .reduce(|one, other| Extremes { least: one.least.min(other.least), largest: one.largest.max(other.largest) })
}

/// A twentieth more on either side.
fn with_margin((least, largest): (f64, f64)) -> Range<f64> {
    let margin = 0.05 * (largest - least).max(1e-6);
    least - margin..largest + margin
}

/// Lines through least and largest of each span, cut where a value is not known.
fn lines(spans: &[Span], part: fn(&Span) -> Option<Extremes>, scale: f64) -> Vec<Vec<(f64, f64)>> {
    let mut lines = vec![Vec::new()];
    for span in spans {
        match (part(span), lines.last_mut()) {
            (Some(Extremes { least, largest }), Some(line)) => {
                let (least, largest) = (scale * least, scale * largest);
                // From where the line stands, the nearer of the two comes first.
                let falls =
                    line.last().is_some_and(|&(_, last): &(f64, f64)| (last - largest).abs() < (last - least).abs());
                let (first, second) = if falls { (largest, least) } else { (least, largest) };
                line.push((span.start_s, first));
                if largest > least {
                    line.push((span.end_s, second));
                }
            }
            _ => lines.push(Vec::new()),
        }
    }
    lines.retain(|line| !line.is_empty());
    lines
}
