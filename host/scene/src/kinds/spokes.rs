//! Spokes around a centre.

use frixel_layers::Spokes as Record;

use super::wave::WaveField;
use super::*;

const X: LengthFields = length!("x", X, PLACE_MM, Mistake, "x of the middle");
const Y: LengthFields = length!("y", Y, PLACE_MM, Mistake, "y of the middle");
const NUMBER: FieldSpec =
    FieldSpec::new("number", Holds::Whole(Range::new(1.0, 255.0, "")), Mistake, "spokes per turn");
const ANGLE: FieldSpec = number(
    "angle_deg",
    ANGLE_DEG,
    Number(0.0),
    "rotation of the spokes: at 0 one begins to the right of the middle, at 90 below it",
);

/// Width below which spokes fade, m.
const NARROW_M: f64 = 1e-3;

/// `kind = "spokes"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spokes {
    wave: Wave,
    x_mm: f64,
    y_mm: f64,
    number: f64,
    angle_deg: f64,
    amounts: LowHigh,
}

impl LayerFields for Spokes {
    const WORD: &'static str = "spokes";

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        let wave = wave::read(fields, log);
        let x_mm = fields.length_mm(log, &X);
        let y_mm = fields.length_mm(log, &Y);
        let number = fields.number(log, &NUMBER);
        let angle_deg = fields.angle_deg(log, &ANGLE);
        let amounts = LowHigh::read(fields, [&LOW, &HIGH], unit, log);
        Some(Self { wave, x_mm: x_mm?, y_mm: y_mm?, number: number?, angle_deg, amounts: amounts? })
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
            phase_turns: (-self.number * self.angle_deg / 360.0).rem_euclid(1.0) as f32,
            trough_n: lowering.amount(layer, self.amounts.low),
            crest_n: lowering.amount(layer, self.amounts.high),
            number: self.number as u8,
        };
        Some(RecordLayer::Spokes(record).into())
    }
}

impl IntoField for Record {
    fn field(&self, _region: RecordRegion, _program: &Program) -> Arc<dyn Field> {
        let (trough_n, crest_n) = (f64::from(self.trough_n), f64::from(self.crest_n));
        Arc::new(SpokesField {
            middle_m: (f64::from(self.x_m), f64::from(self.y_m)),
            number: f64::from(self.number),
            phase_turns: f64::from(self.phase_turns),
            mean_n: 0.5 * (trough_n + crest_n),
            wave: WaveField { wave: self.wave, trough_n, crest_n },
        })
    }

    fn without_place(self) -> Self {
        Self { x_m: 0.0, y_m: 0.0, phase_turns: 0.0, ..self }
    }
}

#[derive(Debug)]
struct SpokesField {
    middle_m: (f64, f64),
    number: f64,
    phase_turns: f64,
    mean_n: f64,
    wave: WaveField,
}

impl SpokesField {
    fn off_middle_m(&self, (x_m, y_m): (f64, f64)) -> (f64, f64) {
        (x_m - self.middle_m.0, y_m - self.middle_m.1)
    }

    /// Fraction of the wave that remains at a distance: the square of a spoke's width in mm, at most 1.
    fn fade(&self, distance_m: f64) -> f64 {
        let width_m = TAU * distance_m / self.number;
        (width_m / NARROW_M).powi(2).min(1.0)
    }

    /// The wave at an angle in turns.
    fn wave_n(&self, turns: f64) -> f64 {
        self.wave.at_turns(self.number * turns + self.phase_turns)
    }
}

impl Field for SpokesField {
    fn at(&self, context: &Context) -> f64 {
        let (x_m, y_m) = self.off_middle_m((context.x_m, context.y_m));
        let fade = self.fade(libm::hypot(x_m, y_m));
        self.mean_n + fade * (self.wave_n(libm::atan2(y_m, x_m) / TAU) - self.mean_n)
    }

    /// Seen from outside a rectangle, its corners lie at the ends of the angles that it covers, and it covers less than
    /// half a turn.
    fn extremes_in(&self, cell: Cell, bounds: Interval<f64>) -> Extremes {
        let corners = cell.corners().map(|corner| self.off_middle_m(corner));
        let nearest = self.off_middle_m(cell.nearest_to(self.middle_m.0, self.middle_m.1));
        let nearest_m = libm::hypot(nearest.0, nearest.1);
        let wave_n = if nearest_m > 0.0 {
            let middle = self.off_middle_m(cell.middle());
            let middle_turns = libm::atan2(middle.1, middle.0) / TAU;
            // The angle from the direction of the cell's middle.
            let beside = corners.map(|(x_m, y_m)| {
                let along = x_m * middle.0 + y_m * middle.1;
                libm::atan2(y_m * middle.0 - x_m * middle.1, along) / TAU
            });
            let turns = beside.map(|beside| self.number * (middle_turns + beside) + self.phase_turns);
            self.wave.interval(Interval::of(turns))
        } else {
            bounds
        };
        let farthest_m = corners.map(|(x_m, y_m)| libm::hypot(x_m, y_m)).into_iter().fold(0.0, f64::max);
        let fades = Interval::of([self.fade(nearest_m), self.fade(farthest_m)]);
        let mean_n = Interval::of([self.mean_n]);
        let extremes_n = mean_n.plus(fades.times(wave_n.plus(Interval::of([-self.mean_n]))));
        // Where spokes fade, angle and distance reach their extremes at different places.
        if fades.low < 1.0 { Extremes::Bounded(extremes_n) } else { Extremes::Reached(extremes_n) }
    }

    fn detail_m(&self) -> Option<f64> {
        Some(0.1 * NARROW_M)
    }
}
