//! Drawing one panel.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::clip::clipped;
use super::{Area, Drawn, FAMILY, Line, Look, Mark, PLOT_HEIGHT, Panel, Series, field, px};

const TITLE_HEIGHT: u32 = 30;
const X_LABELS_HEIGHT: u32 = 44;
const Y_LABELS_WIDTH: u32 = 66;
const LEFT_MARGIN: u32 = 14;
const RIGHT_MARGIN: u32 = 20;
/// What the colour bar of a field takes, from the right.
const BAR_WIDTH: u32 = 96;
/// Half the size of a mark.
const MARK: f64 = 4.2;

/// Draws a panel into the top of an area.
pub(super) fn draw(area: &Area, panel: &Panel) -> Drawn {
    let (plot, _) = area.split_vertically(px(PLOT_HEIGHT));
    let title = (FAMILY, px(17)).into_font().color(&BLACK).pos(Pos::new(HPos::Left, VPos::Center));
    area.draw(&Text::new(
        panel.title.clone(),
        (px(LEFT_MARGIN + Y_LABELS_WIDTH) as i32, px(TITLE_HEIGHT / 2 + 2) as i32),
        title,
    ))?;
    draw_plot(&plot, panel)
}

fn draw_plot(area: &Area, panel: &Panel) -> Drawn {
    let right = if panel.field.is_some() { BAR_WIDTH } else { RIGHT_MARGIN };
    let mut chart = ChartBuilder::on(area)
        .margin_top(px(TITLE_HEIGHT))
        .margin_left(px(LEFT_MARGIN))
        .margin_right(px(right))
        .x_label_area_size(px(X_LABELS_HEIGHT))
        .y_label_area_size(px(Y_LABELS_WIDTH))
        .build_cartesian_2d(panel.x.clone(), panel.y.clone())?;
    chart
        .configure_mesh()
        .x_desc(panel.x.label.as_str())
        .y_desc(panel.y.label.as_str())
        .label_style((FAMILY, px(15)))
        .axis_desc_style((FAMILY, px(16)))
        .set_all_tick_mark_size(px(5))
        .axis_style(BLACK.stroke_width(px(1)))
        .bold_line_style(BLACK.mix(0.13).stroke_width(px(1)))
        .light_line_style(TRANSPARENT)
        .draw()?;
    let plane = chart.plotting_area();
    let pixel = |place: &(f64, f64)| plane.map_coordinate(place);
    let canvas = plane.strip_coord_spec();
    let (left, top) = canvas.get_base_pixel();
    let at = |place: &(f64, f64)| {
        let (x, y) = pixel(place);
        (x - left, y - top)
    };
    if let Some(found) = &panel.field {
        field::draw(&canvas, found, &panel.x, &panel.y, at)?;
        let (bottom, right) = (canvas.dim_in_pixel().1, (left as u32 + canvas.dim_in_pixel().0) as i32);
        field::draw_bar(area, found, (right - area.get_base_pixel().0, top - area.get_base_pixel().1), bottom)?;
    }
    for series in &panel.series {
        draw_series(&canvas, series, panel, at)?;
    }
    for (x, y, note) in &panel.notes {
        if let (Some(x), Some(y)) = (panel.x.place(*x), panel.y.place(*y)) {
            let (x, y) = at(&(x, y));
            let style = (FAMILY, px(13)).into_font().color(&BLACK).pos(Pos::new(HPos::Left, VPos::Center));
            canvas.draw(&Text::new(note.clone(), (x + px(8) as i32, y), style))?;
        }
    }
    Ok(())
}

fn draw_series(
    canvas: &DrawingArea<SVGBackend, Shift>,
    series: &Series,
    panel: &Panel,
    at: impl Fn(&(f64, f64)) -> (i32, i32),
) -> Drawn {
    let (x, y) = (panel.x.places(), panel.y.places());
    let places: Vec<Option<(f64, f64)>> =
        series.points.iter().map(|(x, y)| panel.x.place(*x).zip(panel.y.place(*y))).collect();
    if series.look.line != Line::None {
        for stretch in clipped(&places, &x, &y) {
            let pixels: Vec<_> = stretch.iter().map(&at).collect();
            draw_line(canvas, &pixels, &series.look)?;
        }
    }
    if series.look.mark != Mark::None {
        let (width, height) = canvas.dim_in_pixel();
        for place in places.iter().flatten() {
            let (x, y) = at(place);
            if (0..=width as i32).contains(&x) && (0..=height as i32).contains(&y) {
                draw_mark(canvas, (x, y), &series.look)?;
            }
        }
    }
    Ok(())
}

pub(super) fn draw_line(area: &Area, pixels: &[(i32, i32)], look: &Look) -> Drawn {
    if look.line != Line::Dashed {
        area.draw(&PathElement::new(pixels.to_vec(), look.stroke()))?;
        return Ok(());
    }
    let (dash, gap) = (f64::from(px(7)), f64::from(px(5)));
    let mut along = 0.0;
    let mut piece = Vec::new();
    for pair in pixels.windows(2) {
        let &[from, to] = pair else { continue };
        let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
        let length = dx.hypot(dy);
        let point = |part: f64| (from.0 + (part * dx).round() as i32, from.1 + (part * dy).round() as i32);
        let mut done = 0.0;
        while done < length {
            let in_dash = along % (dash + gap) < dash;
            let left = if in_dash { dash - along % (dash + gap) } else { dash + gap - along % (dash + gap) };
            let step = left.min(length - done).max(1.0);
            if in_dash {
                if piece.is_empty() {
                    piece.push(point(done / length));
                }
                piece.push(point(((done + step) / length).min(1.0)));
            } else if !piece.is_empty() {
                area.draw(&PathElement::new(std::mem::take(&mut piece), look.stroke()))?;
            }
            done += step;
            along += step;
        }
    }
    if piece.len() > 1 {
        area.draw(&PathElement::new(piece, look.stroke()))?;
    }
    Ok(())
}

pub(super) fn draw_mark(area: &Area, (x, y): (i32, i32), look: &Look) -> Drawn {
    let size = MARK * f64::from(px(1));
    let stroke = look.colour.stroke_width(px(2));
    if let Some(corners) = look.corners() {
        let corners: Vec<_> =
            corners.iter().map(|(dx, dy)| (x + (size * dx).round() as i32, y + (size * dy).round() as i32)).collect();
        area.draw(&Polygon::new(corners, look.colour.filled()))?;
        return Ok(());
    }
    let reach = size as i32;
    match look.mark {
        Mark::Disc => area.draw(&Circle::new((x, y), reach, look.colour.filled()))?,
        Mark::Ring => area.draw(&Circle::new((x, y), reach, stroke))?,
        _ => {
            area.draw(&PathElement::new([(x - reach, y - reach), (x + reach, y + reach)], stroke))?;
            area.draw(&PathElement::new([(x - reach, y + reach), (x + reach, y - reach)], stroke))?;
        }
    }
    Ok(())
}
