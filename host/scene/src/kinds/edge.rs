//! A line with a ridge or a well along it, and a click when the finger crosses it.

use frixel_layers::{Click as RecordClick, Edge as Record};

use super::click::Click;
use super::*;

const X: LengthFields = length!("x", X, PLACE_MM, Mistake, "x of a place on the line");
const Y: LengthFields = length!("y", Y, PLACE_MM, Mistake, "y of the same place");
const ANGLE: FieldSpec = number("angle_deg", ANGLE_DEG, Number(0.0), "direction across the line: 0 is a line along y");
const WIDTH: FieldSpec = number("width_mm", SIZE_MM, Mistake, "from one foot of the ridge to the other");
const RIDGE: AmountFields = amount!(
    "ridge",
    Mistake,
    "friction on the line, falling off as a raised cosine; beside the ridge, 0 is added, or layers below are \
     multiplied by 1"
);
const CLICK: AmountFields = amount!("click", Means("no click"), "pulse added when the finger crosses");

/// `kind = "edge"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Edge {
    x_mm: f64,
    y_mm: f64,
    angle_deg: f64,
    width_mm: f64,
    ridge: Amount,
    click: Option<Click>,
}

impl LayerFields for Edge {
    const WORD: &'static str = "edge";
    /// By default an edge adds to the layers below, since most edges are ridges.
    const BLEND: Blend = Blend::Add;

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let x_mm = fields.length_mm(log, &X);
        let y_mm = fields.length_mm(log, &Y);
        let angle_deg = fields.angle_deg(log, &ANGLE);
        let width_mm = fields.number(log, &WIDTH);
        let ridge = Amount::read(fields, &RIDGE, unit, log);
        let click = Click::read(fields, &CLICK, unit, log);
        Some(Self { x_mm: x_mm?, y_mm: y_mm?, angle_deg, width_mm: width_mm?, ridge: ridge?, click })
    }

    fn move_by(&mut self, x_mm: f64, y_mm: f64) {
        self.x_mm += x_mm;
        self.y_mm += y_mm;
    }

    fn extreme(&self, _most: bool, places: &Places, _record: &RecordLayer) -> &'static str {
        places.first_of(RIDGE.names())
    }

    fn clicked(&self, places: &Places, record: &RecordLayer) -> Option<Clicked> {
        let RecordLayer::Edge(Record { ridge_n, .. }) = record else { return None };
        let bases = vec![(places.first_of(RIDGE.names()), f64::from(*ridge_n))];
        Some(Clicked { bases, click: places.first_of(CLICK.names()) })
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let distances_mm = layer.region.as_ref().map(|region| self.distances_mm(region.bounds()));
        let of_ridge = |distances_mm| Warning::of_ridge(layer.title.as_str(), self.width_mm, distances_mm);
        lowering.warn(layer, distances_mm.and_then(of_ridge));
        let record = Record {
            x_m: (self.x_mm * MM) as f32,
            y_m: (self.y_mm * MM) as f32,
            angle_turns: place::turns(self.angle_deg),
            width_m: (self.width_mm * MM) as f32,
            level_n: if layer.blend == Blend::Multiply { 1.0 } else { 0.0 },
            ridge_n: lowering.amount(layer, self.ridge),
            click: Click::lower(self.click, layer, lowering)?,
        };
        Some(RecordLayer::Edge(record).into())
    }
}

impl Edge {
    /// Distances of the corners of a rectangle from the line, along the edge's direction.
    fn distances_mm(&self, Rectangle { x_mm, y_mm, width_mm, height_mm }: Rectangle) -> Interval<f64> {
        let angle_rad = self.angle_deg.to_radians();
        let corners =
            [(x_mm, y_mm), (x_mm + width_mm, y_mm), (x_mm, y_mm + height_mm), (x_mm + width_mm, y_mm + height_mm)];
        Interval::of(
            corners.map(|(x_mm, y_mm)| {
                (x_mm - self.x_mm) * libm::cos(angle_rad) + (y_mm - self.y_mm) * libm::sin(angle_rad)
            }),
        )
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        Arc::new(*self)
    }

    fn without_place(self) -> Self {
        Self { x_m: 0.0, y_m: 0.0, angle_turns: 0.0, ..self }
    }
}

/// Signed distance of a place from the line of an edge, m; positive beyond it.
fn distance_m(edge: &Record, x_m: f64, y_m: f64) -> f64 {
    let angle = TAU * f64::from(edge.angle_turns);
    (x_m - f64::from(edge.x_m)) * libm::cos(angle) + (y_m - f64::from(edge.y_m)) * libm::sin(angle)
}

fn at_distance(edge: &Record, distance_m: f64) -> f64 {
    let (level_n, ridge_n) = (f64::from(edge.level_n), f64::from(edge.ridge_n));
    let part = (distance_m / f64::from(edge.width_m)).clamp(-0.5, 0.5);
    let height = libm::cos(0.5 * TAU * part);
    level_n + (ridge_n - level_n) * height * height
}

impl Field for Record {
    fn at(&self, context: &Context) -> f64 {
        at_distance(self, distance_m(self, context.x_m, context.y_m))
    }

    /// The ridge falls off on both sides of the line.
    fn extremes_in(&self, cell: Cell, _bounds: Interval<f64>) -> Extremes {
        let distances = Interval::of(cell.corners().into_iter().map(|(x_m, y_m)| distance_m(self, x_m, y_m)));
        let nearest_m = 0.0_f64.clamp(distances.low, distances.high);
        let ends = [distances.low, distances.high, nearest_m];
        let still = Interval::of(ends.into_iter().map(|distance_m| at_distance(self, distance_m)));
        let is_crossed = distances.low < 0.0 && distances.high > 0.0;
        Extremes::Reached(still.plus(click_interval(self.click().filter(|_| is_crossed))))
    }

    fn detail_m(&self) -> Option<f64> {
        Some(0.1 * f64::from(self.width_m))
    }

    fn click(&self) -> Option<RecordClick> {
        Some(self.click).filter(RecordClick::is_felt)
    }

    fn is_beyond(&self, x_m: f64, y_m: f64) -> bool {
        distance_m(self, x_m, y_m) >= 0.0
    }
}
