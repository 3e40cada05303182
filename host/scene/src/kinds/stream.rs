//! Friction that the host streams while the scene plays.

use frixel_layers::Stream as Record;

use super::*;

const LOW: AmountFields = amount!("low", Mistake, "friction of sample 0");
const HIGH: AmountFields = amount!("high", Mistake, "friction of the largest sample");

/// `kind = "stream"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stream {
    amounts: LowHigh,
}

impl LayerFields for Stream {
    const WORD: &'static str = "stream";

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        Some(Self { amounts: LowHigh::read(fields, [&LOW, &HIGH], unit, log)? })
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let record = Record {
            low_n: lowering.amount(layer, self.amounts.low),
            high_n: lowering.amount(layer, self.amounts.high),
        };
        Some(RecordLayer::Stream(record).into())
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        Arc::new(*self)
    }
}

impl Field for Record {
    fn at(&self, context: &Context) -> f64 {
        let (low_n, high_n) = (f64::from(self.low_n), f64::from(self.high_n));
        low_n + (high_n - low_n) * context.stream
    }

    fn is_still(&self) -> bool {
        false
    }
}
