//! `region`: the part of the screen where a layer acts.

use frixel_layers::Interval;

use super::super::fields::Fields;
use super::super::log::Log;
use super::super::mistake::FieldMistake;
use super::super::tables;
use crate::kinds::KindName;

/// Least and largest number of vertices of a polygon.
const VERTICES: (usize, usize) = (3, frixel_wire::scene::POLYGON_POINTS_MAX);

/// The part of the screen where a layer acts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Region {
    Rectangle(Rectangle),
    /// The ellipse that fits into a rectangle.
    Ellipse(Rectangle),
    /// Vertices, mm.
    Polygon(Vec<(f64, f64)>),
}

/// A rectangle on the screen, from its top left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rectangle {
    pub(crate) x_mm: f64,
    pub(crate) y_mm: f64,
    pub(crate) width_mm: f64,
    pub(crate) height_mm: f64,
}

#[derive(Clone, Copy)]
enum Shape {
    Rectangle,
    Ellipse,
    Polygon,
}

impl Region {
    /// The same region moved by an offset.
    pub(crate) fn moved_by(self, x_mm: f64, y_mm: f64) -> Self {
        let moved =
            |rectangle: Rectangle| Rectangle { x_mm: rectangle.x_mm + x_mm, y_mm: rectangle.y_mm + y_mm, ..rectangle };
        match self {
            Self::Rectangle(rectangle) => Self::Rectangle(moved(rectangle)),
            Self::Ellipse(rectangle) => Self::Ellipse(moved(rectangle)),
            Self::Polygon(vertices) => Self::Polygon(vertices.into_iter().map(|(x, y)| (x + x_mm, y + y_mm)).collect()),
        }
    }

    /// The smallest rectangle around it.
    pub(crate) fn bounds(&self) -> Rectangle {
        match self {
            Self::Rectangle(rectangle) | Self::Ellipse(rectangle) => *rectangle,
            Self::Polygon(vertices) => Rectangle::around(vertices),
        }
    }
}

impl Rectangle {
    /// The smallest rectangle around some places, mm.
    pub(crate) fn around(places: &[(f64, f64)]) -> Self {
        let x = Interval::of(places.iter().map(|(x_mm, _)| *x_mm));
        let y = Interval::of(places.iter().map(|(_, y_mm)| *y_mm));
        Self { x_mm: x.low, y_mm: y.low, width_mm: x.high - x.low, height_mm: y.high - y.low }
    }
}

/// An invalid region, whose mistake has been logged.
pub(crate) struct Misread;

/// The region of a layer, `None` for the whole screen. A button needs a region with a rim.
pub(crate) fn read(layer: &mut Fields, kind: KindName, log: &mut Log) -> Result<Option<Region>, Misread> {
    let button = kind.needs_rim();
    if button {
        layer.require(&tables::layer::REGION);
    }
    let (there, offset) = (layer.has("region"), layer.place("region"));
    let Some(fields) = layer.table(log, &tables::layer::REGION) else {
        return if there || button { Err(Misread) } else { Ok(None) };
    };
    let region = region(fields, log).ok_or(Misread)?;
    if button && matches!(region, Region::Polygon(_)) {
        log.add(offset, FieldMistake::ButtonPolygon);
        return Err(Misread);
    }
    Ok(Some(region))
}

fn region(mut fields: Fields, log: &mut Log) -> Option<Region> {
    fields.rename("this region".to_owned());
    let shapes = [("rectangle", Shape::Rectangle), ("ellipse", Shape::Ellipse), ("polygon", Shape::Polygon)];
    let named = fields.has("shape");
    let shape = match fields.choice(log, &tables::region::SHAPE, &shapes) {
        None if named => return None,
        shape => shape.unwrap_or(Shape::Rectangle),
    };
    let region = match shape {
        Shape::Rectangle => rectangle(&mut fields, log).map(Region::Rectangle),
        Shape::Ellipse => rectangle(&mut fields, log).map(Region::Ellipse),
        Shape::Polygon => polygon(&mut fields, log).map(Region::Polygon),
    };
    fields.close(log);
    region
}

fn rectangle(fields: &mut Fields, log: &mut Log) -> Option<Rectangle> {
    let x_mm = fields.length_mm(log, &tables::region::X);
    let y_mm = fields.length_mm(log, &tables::region::Y);
    let width_mm = fields.length_mm(log, &tables::region::WIDTH);
    let height_mm = fields.length_mm(log, &tables::region::HEIGHT);
    Some(Rectangle { x_mm: x_mm?, y_mm: y_mm?, width_mm: width_mm?, height_mm: height_mm? })
}

fn polygon(fields: &mut Fields, log: &mut Log) -> Option<Vec<(f64, f64)>> {
    let (points_mm, points_px) = (&tables::region::POINTS_MM, &tables::region::POINTS_PX);
    let field = if fields.has(points_px.name) { points_px.name } else { points_mm.name };
    let offset = fields.place(field);
    let vertices = fields.places_mm(log, points_mm, points_px)?;
    let (min, max) = VERTICES;
    if !(min..=max).contains(&vertices.len()) {
        log.add(offset, FieldMistake::Count { field, found: vertices.len(), min, max });
        return None;
    }
    Some(vertices)
}
