//! Friction that changes with time.

use frixel_layers::{Beat, Burst as RecordBurst, Vibration as Record};

use super::*;

const WAVE: FieldSpec = word("wave", Means("`\"sine\"`"), "`\"sine\"` or `\"square\"`");
const FREQUENCY: FieldSpec = number(
    "frequency_hz",
    Range::new(range::FREQUENCY_HZ.min, range::FREQUENCY_HZ.max, " Hz"),
    Mistake,
    "repetitions per second",
);
const HIGH: AmountFields =
    amount!("high", Mistake, "largest friction; a sine starts in the middle and rises, a square starts high");
const BURST: FieldSpec = FieldSpec::new(
    "burst",
    Holds::Table,
    Means("continuous"),
    "repeated bursts: `{ period_ms, on_ms, ramp_ms }`, see [bursts](#bursts)",
);
const BURST_MS: Range = Range::new(1.0, range::BURST_S.max / MM, " ms");
const PERIOD: FieldSpec = number("period_ms", BURST_MS, Mistake, "from the start of a burst to the next one");
const ON: FieldSpec = number("on_ms", BURST_MS, Mistake, "duration of a burst; at most the period");
const RAMP: FieldSpec = number(
    "ramp_ms",
    Range::new(0.0, 0.5 * BURST_MS.max, " ms"),
    Number(0.0),
    "rise time and fall time of a burst; each at most half of `on_ms`",
);

/// `kind = "vibration"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Vibration {
    beat: Beat,
    frequency_hz: f64,
    amounts: LowHigh,
    burst: Option<Burst>,
}

/// `burst` of a vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Burst {
    period_ms: f64,
    on_ms: f64,
    ramp_ms: f64,
}

impl LayerFields for Vibration {
    const WORD: &'static str = "vibration";

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let beats = [("sine", Beat::Sine), ("square", Beat::Square)];
        let beat = fields.choice(log, &WAVE, &beats).unwrap_or_default();
        let frequency_hz = fields.number(log, &FREQUENCY);
        let amounts = LowHigh::read(fields, [&LOW, &HIGH], unit, log);
        let has_burst = fields.has(BURST.name);
        let burst = fields.table(log, &BURST).and_then(|fields| Burst::read(fields, log));
        if has_burst && burst.is_none() {
            return None;
        }
        Some(Self { beat, frequency_hz: frequency_hz?, amounts: amounts?, burst })
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let record = Record {
            beat: self.beat,
            frequency_hz: self.frequency_hz as f32,
            low_n: lowering.amount(layer, self.amounts.low),
            high_n: lowering.amount(layer, self.amounts.high),
            burst: self.burst.map_or(RecordBurst::default(), |burst| burst.lower(lowering)),
        };
        Some(RecordLayer::Vibration(record).into())
    }
}

impl Burst {
    fn read(mut fields: Fields, log: &mut Log) -> Option<Self> {
        fields.rename("this burst".to_owned());
        let period_ms = fields.number(log, &PERIOD);
        let on_ms = fields.number(log, &ON);
        let ramp_ms = fields.number_or_default(log, &RAMP);
        let places = fields.close(log);
        let (period_ms, on_ms) = (period_ms?, on_ms?);
        for (field, found, whole, max_ms) in
            [(ON.name, on_ms, "`period_ms`", period_ms), (RAMP.name, ramp_ms, "half of `on_ms`", 0.5 * on_ms)]
        {
            if found > max_ms {
                log.add(places.field(field), FieldMistake::TooLong { field, found, whole, max_ms });
            }
        }
        Some(Self { period_ms, on_ms, ramp_ms })
    }

    /// Converts times to whole ticks, as the board does, so that both periods agree.
    fn lower(self, lowering: &Lowering) -> RecordBurst {
        let tick_hz = f64::from(lowering.tick_hz);
        let whole = |time_ms: f64| ((time_ms * MM * tick_hz).round() / tick_hz) as f32;
        RecordBurst { period_s: whole(self.period_ms), on_s: whole(self.on_ms), ramp_s: whole(self.ramp_ms) }
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        Arc::new(*self)
    }
}

impl Field for Record {
    fn at(&self, context: &Context) -> f64 {
        let turn = (f64::from(self.frequency_hz) * context.t_s).rem_euclid(1.0);
        let wave = match self.beat {
            Beat::Sine => 0.5 + 0.5 * libm::sin(TAU * turn),
            Beat::Square => f64::from(u8::from(turn < 0.5)),
        };
        let (low_n, high_n) = (f64::from(self.low_n), f64::from(self.high_n));
        low_n + (high_n - low_n) * envelope(self.burst, context.t_s - context.begun_s) * wave
    }

    fn is_still(&self) -> bool {
        false
    }

    fn largest_over_time_n(&self) -> Option<f64> {
        Some(self.high_n.into())
    }
}

/// Envelope of a vibration at a time since it was switched on, from 0 to 1.
fn envelope(burst: RecordBurst, t_s: f64) -> f64 {
    let [period_s, on_s, ramp_s] = [burst.period_s, burst.on_s, burst.ramp_s].map(f64::from);
    if period_s <= 0.0 {
        return 1.0;
    }
    let begun_s = t_s.rem_euclid(period_s);
    if begun_s >= on_s {
        0.0
    } else if ramp_s > 0.0 {
        (begun_s.min(on_s - begun_s) / ramp_s).min(1.0)
    } else {
        1.0
    }
}
