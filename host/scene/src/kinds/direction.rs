//! Friction that depends on the direction of the slide.

use frixel_layers::Direction as Record;

use super::*;

const ANGLE: FieldSpec =
    number("angle_deg", ANGLE_DEG, Number(0.0), "direction of the axis: 0 points to the right, 90 down");
const ALONG: AmountFields = amount!("along", Mistake, "friction of a finger that slides along the axis");
const AGAINST: AmountFields = amount!("against", Mistake, "friction of a finger that slides the other way");

/// Speed below which friction fades to the mean of both directions, m/s.
const FADE_M_PER_S: f64 = 0.02;

/// `kind = "direction"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Direction {
    angle_deg: f64,
    along: Amount,
    against: Amount,
}

impl LayerFields for Direction {
    const WORD: &'static str = "direction";

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let angle_deg = fields.angle_deg(log, &ANGLE);
        let along = Amount::read(fields, &ALONG, unit, log);
        let against = Amount::read(fields, &AGAINST, unit, log);
        Some(Self { angle_deg, along: along?, against: against? })
    }

    fn extreme(&self, most: bool, places: &Places, record: &RecordLayer) -> &'static str {
        let is_along_most = matches!(record, RecordLayer::Direction(layer) if layer.along_n > layer.against_n);
        let amount = if most == is_along_most { ALONG } else { AGAINST };
        places.first_of(amount.names())
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let record = Record {
            angle_turns: place::turns(self.angle_deg),
            along_n: lowering.amount(layer, self.along),
            against_n: lowering.amount(layer, self.against),
        };
        Some(RecordLayer::Direction(record).into())
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        Arc::new(*self)
    }
}

impl Field for Record {
    fn at(&self, context: &Context) -> f64 {
        let (angle, [x, y]) = (TAU * f64::from(self.angle_turns), context.direction);
        let cosine = libm::cos(angle) * x + libm::sin(angle) * y;
        let fade = (context.speed_m_per_s / FADE_M_PER_S).min(1.0);
        let weight_along = 0.5 * (1.0 + fade * cosine);
        weight_along * f64::from(self.along_n) + (1.0 - weight_along) * f64::from(self.against_n)
    }

    fn is_still(&self) -> bool {
        false
    }
}
