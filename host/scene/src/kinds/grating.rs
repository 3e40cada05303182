//! Parallel stripes.

use frixel_layers::Grating as Record;

use super::wave::WaveField;
use super::*;

const WAVELENGTH: FieldSpec = number("wavelength_mm", WAVELENGTH_MM, Mistake, "from stripe to stripe");
const ANGLE: FieldSpec = number("angle_deg", ANGLE_DEG, Number(0.0), "direction across the stripes");
const PHASE: FieldSpec = number(
    "phase_deg",
    ANGLE_DEG,
    Number(0.0),
    "position in the wave at the `origin`. At 0, a sine is at its middle and rises, a square's high part begins, \
     and triangle and saw are low and rise",
);

const ORIGIN: FieldSpec = word(
    "origin",
    Means("`\"screen\"`"),
    "`\"screen\"`: the phase counts from the screen's top left corner; `\"region\"`: from that of the layer's region, so \
     that the stripes move with it",
);

/// Origin of the phase.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Origin {
    Screen,
    Region,
}

/// `kind = "grating"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Grating {
    wave: Wave,
    wavelength_mm: f64,
    angle_deg: f64,
    phase_deg: f64,
    origin: Origin,
    /// 0 for stripes that do not move.
    drift_mm_per_s: f64,
    amounts: LowHigh,
}

impl LayerFields for Grating {
    const WORD: &'static str = "grating";

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let wave = wave::read(fields, log);
        let wavelength_mm = fields.number(log, &WAVELENGTH);
        let angle_deg = fields.angle_deg(log, &ANGLE);
        let phase_deg = fields.angle_deg(log, &PHASE);
        let origins = [("screen", Origin::Screen), ("region", Origin::Region)];
        let origin = fields.choice(log, &ORIGIN, &origins).unwrap_or(Origin::Screen);
        let drift_mm_per_s = drift::read(fields, wavelength_mm, log);
        let amounts = LowHigh::read(fields, [&LOW, &HIGH], unit, log);
        let (wavelength_mm, amounts) = (wavelength_mm?, amounts?);
        Some(Self { wave, wavelength_mm, angle_deg, phase_deg, origin, drift_mm_per_s, amounts })
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let (cycles_per_m_x, cycles_per_m_y) = place::wave_vector(self.wavelength_mm, self.angle_deg);
        let (x_m, y_m) = match (self.origin, &layer.region) {
            (Origin::Region, Some(region)) => (MM * region.bounds().x_mm, MM * region.bounds().y_mm),
            _ => (0.0, 0.0),
        };
        let origin_turns = f64::from(cycles_per_m_x) * x_m + f64::from(cycles_per_m_y) * y_m;
        let record = Record {
            wave: self.wave,
            cycles_per_m_x,
            cycles_per_m_y,
            phase_turns: (self.phase_deg / 360.0 - origin_turns).rem_euclid(1.0) as f32,
            trough_n: lowering.amount(layer, self.amounts.low),
            crest_n: lowering.amount(layer, self.amounts.high),
            drift_hz: drift::drift_hz(self.drift_mm_per_s, self.wavelength_mm) as f32,
        };
        Some(RecordLayer::Grating(record).into())
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        Arc::new(*self)
    }

    fn without_place(self) -> Self {
        let cycles_per_m = libm::hypot(self.cycles_per_m_x.into(), self.cycles_per_m_y.into());
        // In a rotated grating, the two differ by rounding.
        let cycles_per_m_x = (100.0 * cycles_per_m).round() as f32 / 100.0;
        Self { phase_turns: 0.0, cycles_per_m_x, cycles_per_m_y: 0.0, ..self }
    }
}

/// Phase of a grating at a place and time 0, in turns.
fn turns(grating: &Record, x_m: f64, y_m: f64) -> f64 {
    let [along_x, along_y, phase] =
        [grating.cycles_per_m_x, grating.cycles_per_m_y, grating.phase_turns].map(f64::from);
    along_x * x_m + along_y * y_m + phase
}

fn wave_of(grating: &Record) -> WaveField {
    WaveField::new(grating.wave, grating.trough_n, grating.crest_n)
}

impl Field for Record {
    fn at(&self, context: &Context) -> f64 {
        wave_of(self).at_turns(turns(self, context.x_m, context.y_m) - f64::from(self.drift_hz) * context.t_s)
    }

    fn is_still(&self) -> bool {
        self.drift_hz == 0.0
    }

    /// Over a rectangle, the phase covers the interval between its extremes.
    fn extremes_in(&self, cell: Cell, _bounds: Interval<f64>) -> Extremes {
        let turns = Interval::of(cell.corners().into_iter().map(|(x_m, y_m)| turns(self, x_m, y_m)));
        Extremes::Reached(wave_of(self).interval(turns))
    }

    fn detail_m(&self) -> Option<f64> {
        Some(0.1 / libm::hypot(self.cycles_per_m_x.into(), self.cycles_per_m_y.into()))
    }
}
