//! A button: a face that fills its region, with a rim around it, and a click when the finger slides in.

use frixel_layers::{Button as Record, Click as RecordClick};

use super::click::Click;
use super::*;

const RIM_WIDTH: FieldSpec = number(
    "rim_width_mm",
    SIZE_MM,
    Mistake,
    "width of the rim, inside the outline; an ellipse's along its shorter axis",
);
const RIM: AmountFields = amount!(
    "rim",
    Mistake,
    "friction in the middle of the rim; on both sides it falls off to the face's as a raised cosine"
);
const FACE: AmountFields = amount!("face", Mistake, "friction on the face");
const CLICK: AmountFields = amount!("click", Means("no click"), "pulse added when the finger slides in");

/// `kind = "button"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Button {
    rim_width_mm: f64,
    rim: Amount,
    face: Amount,
    click: Option<Click>,
}

impl LayerFields for Button {
    const WORD: &'static str = "button";
    const NEEDS_RIM: bool = true;

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let rim_width_mm = fields.number(log, &RIM_WIDTH);
        let rim = Amount::read(fields, &RIM, unit, log);
        let face = Amount::read(fields, &FACE, unit, log);
        let click = Click::read(fields, &CLICK, unit, log);
        Some(Self { rim_width_mm: rim_width_mm?, rim: rim?, face: face?, click })
    }

    fn extreme(&self, most: bool, places: &Places, record: &RecordLayer) -> &'static str {
        let is_face_most = matches!(record, RecordLayer::Button(button) if button.face_n > button.rim_n);
        let amount = if most == is_face_most { FACE } else { RIM };
        places.first_of(amount.names())
    }

    fn clicked(&self, places: &Places, record: &RecordLayer) -> Option<Clicked> {
        let RecordLayer::Button(Record { rim_n, face_n, .. }) = record else { return None };
        let bases = [(RIM, rim_n), (FACE, face_n)];
        let bases = bases.map(|(amount, friction_n)| (places.first_of(amount.names()), f64::from(*friction_n)));
        Some(Clicked { bases: bases.to_vec(), click: places.first_of(CLICK.names()) })
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        if let Some(Region::Rectangle(sides) | Region::Ellipse(sides)) = &layer.region {
            let side_mm = sides.width_mm.min(sides.height_mm);
            lowering.warn(layer, Warning::of_rim(layer.title.as_str(), self.rim_width_mm, side_mm));
        }
        let record = Record {
            rim_width_m: (self.rim_width_mm * MM) as f32,
            rim_n: lowering.amount(layer, self.rim),
            face_n: lowering.amount(layer, self.face),
            click: Click::lower(self.click, layer, lowering)?,
        };
        Some(RecordLayer::Button(record).into())
    }
}

impl IntoField for Record {
    fn field(&self, region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        let (x_m, y_m, width_m, height_m) = match region {
            RecordRegion::Rectangle { x_m, y_m, width_m, height_m }
            | RecordRegion::Ellipse { x_m, y_m, width_m, height_m } => (x_m, y_m, width_m, height_m),
            RecordRegion::Screen | RecordRegion::Polygon { .. } => (f32::NAN, f32::NAN, f32::NAN, f32::NAN),
        };
        let outline = Cell::of_region(x_m, y_m, width_m, height_m);
        let half_m = (0.5 * f64::from(width_m), 0.5 * f64::from(height_m));
        Arc::new(ButtonField {
            outline,
            middle_m: (outline.left_m + half_m.0, outline.top_m + half_m.1),
            half_m,
            is_ellipse: matches!(region, RecordRegion::Ellipse { .. }),
            rim_width_m: f64::from(self.rim_width_m),
            rim_n: f64::from(self.rim_n),
            face_n: f64::from(self.face_n),
            click: self.click,
        })
    }
}

#[derive(Debug)]
struct ButtonField {
    outline: Cell,
    middle_m: (f64, f64),
    half_m: (f64, f64),
    is_ellipse: bool,
    rim_width_m: f64,
    rim_n: f64,
    face_n: f64,
    click: RecordClick,
}

impl Field for ButtonField {
    fn at(&self, context: &Context) -> f64 {
        let (x_m, y_m) = ((context.x_m - self.middle_m.0).abs(), (context.y_m - self.middle_m.1).abs());
        let depth_m = if self.is_ellipse {
            (1.0 - libm::hypot(x_m / self.half_m.0, y_m / self.half_m.1)) * self.half_m.0.min(self.half_m.1)
        } else {
            (self.half_m.0 - x_m).min(self.half_m.1 - y_m)
        };
        let height = libm::sin(0.5 * TAU * (depth_m / self.rim_width_m).clamp(0.0, 1.0));
        self.face_n + (self.rim_n - self.face_n) * height * height
    }

    /// A cell that is the whole button contains all of its rim, and its face.
    fn extremes_in(&self, cell: Cell, bounds: Interval<f64>) -> Extremes {
        if cell == self.outline { Extremes::Reached(bounds) } else { Extremes::Bounded(bounds) }
    }

    fn detail_m(&self) -> Option<f64> {
        Some(0.1 * self.rim_width_m)
    }

    fn click(&self) -> Option<RecordClick> {
        Some(self.click).filter(RecordClick::is_felt)
    }

    fn clicks_on_entry(&self) -> bool {
        true
    }
}
