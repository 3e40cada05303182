//! Rings around a centre.

use frixel_layers::Rings as Record;

use super::wave::WaveField;
use super::*;

const X: LengthFields = length!("x", X, PLACE_MM, Mistake, "x of the middle");
const Y: LengthFields = length!("y", Y, PLACE_MM, Mistake, "y of the middle");
const WAVELENGTH: FieldSpec = number("wavelength_mm", WAVELENGTH_MM, Mistake, "from ring to ring");

/// `kind = "rings"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rings {
    wave: Wave,
    x_mm: f64,
    y_mm: f64,
    wavelength_mm: f64,
    /// 0 for rings that do not move.
    drift_mm_per_s: f64,
    amounts: LowHigh,
}

impl LayerFields for Rings {
    const WORD: &'static str = "rings";

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let wave = wave::read(fields, log);
        let x_mm = fields.length_mm(log, &X);
        let y_mm = fields.length_mm(log, &Y);
        let wavelength_mm = fields.number(log, &WAVELENGTH);
        let drift_mm_per_s = drift::read(fields, wavelength_mm, log);
        let amounts = LowHigh::read(fields, [&LOW, &HIGH], unit, log);
        let (x_mm, y_mm, wavelength_mm) = (x_mm?, y_mm?, wavelength_mm?);
        Some(Self { wave, x_mm, y_mm, wavelength_mm, drift_mm_per_s, amounts: amounts? })
    }

    fn move_by(&mut self, x_mm: f64, y_mm: f64) {
        self.x_mm += x_mm;
        self.y_mm += y_mm;
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let record = Record {
            wave: self.wave,
            x_m: (self.x_mm * MM) as f32,
            y_m: (self.y_mm * MM) as f32,
            cycles_per_m: (1.0 / (self.wavelength_mm * MM)) as f32,
            trough_n: lowering.amount(layer, self.amounts.low),
            crest_n: lowering.amount(layer, self.amounts.high),
            drift_hz: drift::drift_hz(self.drift_mm_per_s, self.wavelength_mm) as f32,
        };
        Some(RecordLayer::Rings(record).into())
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        Arc::new(*self)
    }

    fn without_place(self) -> Self {
        Self { x_m: 0.0, y_m: 0.0, ..self }
    }
}

/// Phase of rings at a place and time 0, in turns.
fn turns(rings: &Record, x_m: f64, y_m: f64) -> f64 {
    f64::from(rings.cycles_per_m) * libm::hypot(x_m - f64::from(rings.x_m), y_m - f64::from(rings.y_m))
}

fn wave_of(rings: &Record) -> WaveField {
    WaveField::new(rings.wave, rings.trough_n, rings.crest_n)
}

impl Field for Record {
    fn at(&self, context: &Context) -> f64 {
        wave_of(self).at_turns(turns(self, context.x_m, context.y_m) - f64::from(self.drift_hz) * context.t_s)
    }

    fn is_still(&self) -> bool {
        self.drift_hz == 0.0
    }

    /// The nearest point of a cell is the centre or lies on the cell's border; the farthest is a corner. The distance
    /// covers the interval in between.
    fn extremes_in(&self, cell: Cell, _bounds: Interval<f64>) -> Extremes {
        let nearest = cell.nearest_to(self.x_m.into(), self.y_m.into());
        let places = cell.corners().into_iter().chain([nearest]);
        Extremes::Reached(wave_of(self).interval(Interval::of(places.map(|(x_m, y_m)| turns(self, x_m, y_m)))))
    }

    fn detail_m(&self) -> Option<f64> {
        Some(0.1 / f64::from(self.cycles_per_m))
    }
}
