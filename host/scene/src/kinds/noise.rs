//! Band-limited noise: the mean of eight cosine waves drawn from a seed.

use frixel_layers::{NOISES_MAX, Noise as Record};

use super::*;

const SEED: FieldSpec =
    FieldSpec::new("seed", Holds::Whole(Range::new(0.0, 4_294_967_295.0, "")), Number(0.0), "seed of the random waves");
const MIN: FieldSpec = number("wavelength_min_mm", WAVELENGTH_MM, Mistake, "shortest wavelength");
const MAX: FieldSpec = number("wavelength_max_mm", WAVELENGTH_MM, Mistake, "longest wavelength");
const LOW: AmountFields = amount!("low", Mistake, "least friction");
const HIGH: AmountFields = amount!(
    "high",
    Mistake,
    "largest friction. Noise is mostly near the middle: its standard deviation is an eighth of the range"
);

/// `kind = "noise"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Noise {
    seed: u32,
    wavelength_min_mm: f64,
    wavelength_max_mm: f64,
    amounts: LowHigh,
}

impl LayerFields for Noise {
    const WORD: &'static str = "noise";

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let seed = fields.number_or_default(log, &SEED) as u32;
        let wavelength_min_mm = fields.number(log, &MIN);
        let wavelength_max_mm = fields.number(log, &MAX);
        let amounts = LowHigh::read(fields, [&LOW, &HIGH], unit, log);
        let (low, high) = (wavelength_min_mm?, wavelength_max_mm?);
        if low > high {
            let (low_name, high_name) = (MIN.name, MAX.name);
            log.add(fields.places().field(low_name), FieldMistake::LowAboveHigh { low_name, low, high_name, high });
        }
        Some(Self { seed, wavelength_min_mm: low, wavelength_max_mm: high, amounts: amounts? })
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let record = Record {
            seed: self.seed,
            wavelength_min_m: (self.wavelength_min_mm * MM) as f32,
            wavelength_max_m: (self.wavelength_max_mm * MM) as f32,
            low_n: lowering.amount(layer, self.amounts.low),
            high_n: lowering.amount(layer, self.amounts.high),
        };
        lowering.noises += 1;
        lowering.limit(layer, "layers of noise", lowering.noises, NOISES_MAX)?;
        Some(RecordLayer::Noise(record).into())
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        let (wavelength_min_m, wavelength_max_m) = (f64::from(self.wavelength_min_m), f64::from(self.wavelength_max_m));
        let waves = (0..8).map(|wave| {
            let draw = |number: u32| drawn(self.seed.wrapping_add(0x9e37_79b9_u32.wrapping_mul(3 * wave + number)));
            let direction = TAU * (f64::from(wave) + draw(1)) / 16.0;
            let part = (f64::from(5 * wave % 8) + draw(2)) / 8.0;
            let cycles_per_m = (1.0 - part) / wavelength_max_m + part / wavelength_min_m;
            [cycles_per_m * libm::cos(direction), cycles_per_m * libm::sin(direction), draw(3)]
        });
        let (low_n, high_n) = (f64::from(self.low_n), f64::from(self.high_n));
        Arc::new(NoiseField { waves: waves.collect(), wavelength_min_m, low_n, high_n })
    }
}

#[derive(Debug)]
struct NoiseField {
    /// Cycles per metre along x and y, and a phase in turns.
    waves: Vec<[f64; 3]>,
    wavelength_min_m: f64,
    low_n: f64,
    high_n: f64,
}

impl Field for NoiseField {
    fn at(&self, context: &Context) -> f64 {
        let wave = |[x, y, phase]: &[f64; 3]| libm::cos(TAU * (x * context.x_m + y * context.y_m + phase));
        let mean = self.waves.iter().map(wave).sum::<f64>() / self.waves.len() as f64;
        f64::midpoint(self.low_n, self.high_n) + 0.5 * (self.high_n - self.low_n) * mean
    }

    fn detail_m(&self) -> Option<f64> {
        Some(0.1 * self.wavelength_min_m)
    }
}

/// The fraction from the hash of `number`, as defined in `PROTOCOL.md`.
fn drawn(number: u32) -> f64 {
    let mut v = u64::from(number);
    for (shift, factor) in [(16, 0x7feb_352d), (15, 0x846c_a68b), (16, 1)] {
        v = ((v ^ (v >> shift)) * factor) & 0xffff_ffff;
    }
    (v / 256) as f64 / 16_777_216.0
}
