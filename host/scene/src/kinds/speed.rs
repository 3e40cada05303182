//! A curve over sliding speed: a factor on the friction of the layers below.

use frixel_layers::{Point, Speed as Record};
use frixel_wire::scene::CURVE_POINTS_MAX;

use super::*;
use crate::tables::FACTOR;

const SPEEDS: FieldSpec = FieldSpec::new(
    "speeds_mm_per_s",
    Holds::Numbers(Range::new(range::SPEED_M_PER_S.min, range::SPEED_M_PER_S.max / MM, " mm/s")),
    Mistake,
    "2 to 16 speeds in ascending order",
);
const FACTORS: FieldSpec = FieldSpec::new(
    "factors",
    Holds::Numbers(FACTOR),
    Mistake,
    "the factor at each speed: linear between speeds, constant outside",
);
/// Smallest spacing of two speeds: twice the board's resolution, so that rounding never makes them too close.
const STEP_MIN_MM_PER_S: f64 = 2.0 * range::SPEED_STEP_MIN_M_PER_S / MM;

/// `kind = "speed"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Speed {
    speeds_mm_per_s: Vec<f64>,
    factors: Vec<f64>,
}

impl LayerFields for Speed {
    const WORD: &'static str = "speed";
    const BLENDS: &'static [(&'static str, Blend)] = &[("multiply", Blend::Multiply)];
    const BLEND: Blend = Blend::Multiply;

    fn read(fields: &mut Fields, _unit: Unit, log: &mut Log) -> Option<Self> {
        let (offset, factors_offset) = (fields.place(SPEEDS.name), fields.place(FACTORS.name));
        let speeds_mm_per_s = fields.numbers(log, &SPEEDS);
        let factors = fields.numbers(log, &FACTORS);
        let (speeds_mm_per_s, factors) = (speeds_mm_per_s?, factors?);
        let (found, min, max) = (speeds_mm_per_s.len(), 2, CURVE_POINTS_MAX);
        if !(min..=max).contains(&found) {
            log.add(offset, FieldMistake::Count { field: SPEEDS.name, found, min, max });
        } else if factors.len() != found {
            let mistake = FieldMistake::Count { field: FACTORS.name, found: factors.len(), min: found, max: found };
            log.add(factors_offset, mistake);
        }
        let is_close = |[before, after]: &&[f64; 2]| after - before < STEP_MIN_MM_PER_S;
        if let Some([before, after]) = speeds_mm_per_s.array_windows().find(is_close) {
            log.add(offset, FieldMistake::SpeedsDoNotRise { before: *before, after: *after });
        }
        Some(Self { speeds_mm_per_s, factors })
    }

    fn extreme(&self, _most: bool, _places: &Places, _record: &RecordLayer) -> &'static str {
        FACTORS.name
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let pairs = self.speeds_mm_per_s.iter().zip(&self.factors);
        let points = pairs.map(|(speed, factor)| Point { x: (speed * MM) as f32, y: *factor as f32 });
        let (first, count) = lowering.points(layer, points.collect())?;
        Some(RecordLayer::Speed(Record { first, count }).into())
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, program: &Program) -> Arc<dyn Field> {
        let own = program.points.iter().skip(usize::from(self.first)).take(usize::from(self.count));
        Arc::new(SpeedField(own.map(|point| (f64::from(point.x), f64::from(point.y))).collect()))
    }
}

/// Speeds in m/s, and the factor at each.
#[derive(Debug)]
struct SpeedField(Vec<(f64, f64)>);

impl Field for SpeedField {
    fn at(&self, context: &Context) -> f64 {
        let after = self.0.partition_point(|(speed, _)| *speed <= context.speed_m_per_s);
        let (before, after) = (self.0.get(after.wrapping_sub(1)), self.0.get(after));
        match (before, after) {
            (Some((x1, y1)), Some((x2, y2))) => y1 + (y2 - y1) * (context.speed_m_per_s - x1) / (x2 - x1),
            (Some((_, y)), None) | (None, Some((_, y))) => *y,
            (None, None) => f64::NAN,
        }
    }

    fn is_still(&self) -> bool {
        false
    }
}
