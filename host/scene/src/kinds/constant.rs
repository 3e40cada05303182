//! The same friction everywhere.

use frixel_layers::Constant as Record;

use super::*;

const FRICTION: AmountFields = amount!("friction", Mistake, "the same friction everywhere");

/// `kind = "constant"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Constant {
    friction: Amount,
}

impl LayerFields for Constant {
    const WORD: &'static str = "constant";
    const TOTALS: bool = true;

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        Some(Self { friction: Amount::read(fields, &FRICTION, unit, log)? })
    }

    fn extreme(&self, _most: bool, places: &Places, _record: &RecordLayer) -> &'static str {
        places.first_of(FRICTION.names())
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let electric_friction_n = lowering.amount(layer, self.friction);
        Some(RecordLayer::Constant(Record { electric_friction_n }).into())
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        Arc::new(ConstantField(f64::from(self.electric_friction_n)))
    }
}

/// The same friction everywhere, N.
#[derive(Debug)]
pub(crate) struct ConstantField(pub(crate) f64);

impl Field for ConstantField {
    fn at(&self, _context: &Context) -> f64 {
        self.0
    }
}
