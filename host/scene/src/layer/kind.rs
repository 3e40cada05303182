//! What belongs to each kind of layer.

use frixel_wire::scene::{Beat, CURVE_POINTS_MAX, Wave};

use super::super::fields::Fields;
use super::super::grammar::{AmountFields, FieldSpec};
use super::super::log::Log;
use super::super::mistake::Mistake;
use super::super::source::Places;
use super::super::tables;
use super::amount::{Amount, Unit};

/// What a layer is.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) enum Kind {
    Constant { friction: Amount },
    Grating { wave: Wave, wavelength_mm: f64, angle_deg: f64, phase_deg: f64, low: Amount, high: Amount },
    Bitmap(Bitmap),
    Noise { seed: u32, wavelength_min_mm: f64, wavelength_max_mm: f64, low: Amount, high: Amount },
    Edge { x_mm: f64, y_mm: f64, angle_deg: f64, width_mm: f64, ridge: Amount, click: Option<Click> },
    Button { rim_width_mm: f64, rim: Amount, face: Amount, click: Option<Click> },
    Vibration { beat: Beat, frequency_hz: f64, low: Amount, high: Amount, burst: Option<Burst> },
    Speed { speeds_mm_per_s: Vec<f64>, factors: Vec<f64> },
    Stream { low: Amount, high: Amount },
}

/// A picture's place and friction.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct Bitmap {
    pub(in super::super) picture: String,
    /// Place and width; `None` for those of the region.
    pub(in super::super) x_mm: Option<f64>,
    pub(in super::super) y_mm: Option<f64>,
    pub(in super::super) width_mm: Option<f64>,
    pub(in super::super) height_mm: Option<f64>,
    pub(in super::super) pitch_mm: f64,
    pub(in super::super) angle_deg: f64,
    pub(in super::super) tiled: bool,
    pub(in super::super) black: Amount,
    pub(in super::super) white: Amount,
}

/// A short pulse when the finger crosses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Click {
    pub(in super::super) height: Amount,
    pub(in super::super) decay_ms: f64,
}

/// `burst` of a vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Burst {
    pub(in super::super) period_ms: f64,
    pub(in super::super) on_ms: f64,
    pub(in super::super) ramp_ms: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum KindName {
    Constant,
    Grating,
    Bitmap,
    Noise,
    Edge,
    Button,
    Vibration,
    Speed,
    Stream,
}

impl KindName {
    pub(super) const ALL: [Self; 9] = [
        Self::Constant,
        Self::Grating,
        Self::Bitmap,
        Self::Noise,
        Self::Edge,
        Self::Button,
        Self::Vibration,
        Self::Speed,
        Self::Stream,
    ];

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Grating => "grating",
            Self::Bitmap => "bitmap",
            Self::Noise => "noise",
            Self::Edge => "edge",
            Self::Button => "button",
            Self::Vibration => "vibration",
            Self::Speed => "speed",
            Self::Stream => "stream",
        }
    }

    pub(super) fn read(self, fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
        match self {
            Self::Constant => {
                Some(Kind::Constant { friction: Amount::read(fields, &tables::constant::FRICTION, unit, log)? })
            }
            Self::Grating => grating(fields, unit, log),
            Self::Bitmap => bitmap(fields, unit, log).map(Kind::Bitmap),
            Self::Noise => noise(fields, unit, log),
            Self::Edge => edge(fields, unit, log),
            Self::Button => button(fields, unit, log),
            Self::Vibration => vibration(fields, unit, log),
            Self::Speed => speed(fields, log),
            Self::Stream => {
                let (low, high) = low_and_high(fields, [&tables::stream::LOW, &tables::stream::HIGH], unit, log);
                Some(Kind::Stream { low: low?, high: high? })
            }
        }
    }
}

impl Kind {
    /// Finds mistakes between fields.
    pub(super) fn check(&self, places: &Places, log: &mut Log) {
        if let Self::Grating { low, high, .. }
        | Self::Noise { low, high, .. }
        | Self::Vibration { low, high, .. }
        | Self::Stream { low, high } = self
            && low.is_above(*high)
        {
            let (low_name, high_name) =
                (places.first_of(tables::grating::LOW.names()), places.first_of(tables::grating::HIGH.names()));
            let mistake = Mistake::LowAboveHigh { low_name, low: low.number(), high_name, high: high.number() };
            log.add(places.field(low_name), mistake);
        }
        if let Self::Noise { wavelength_min_mm: low, wavelength_max_mm: high, .. } = self
            && low > high
        {
            let (low_name, high_name) = ("wavelength_min_mm", "wavelength_max_mm");
            log.add(places.field(low_name), Mistake::LowAboveHigh { low_name, low: *low, high_name, high: *high });
        }
    }

    /// The field that asks for the most, or for the least.
    pub(in super::super) fn extreme(&self, most: bool, places: &Places) -> &'static str {
        use tables::{bitmap, button, constant, edge, grating};
        let either = |low: AmountFields, high: AmountFields| if most { high } else { low };
        let amount = match self {
            Self::Constant { .. } => constant::FRICTION,
            Self::Bitmap(Bitmap { black, white, .. }) if black.is_above(*white) => either(bitmap::WHITE, bitmap::BLACK),
            Self::Bitmap(_) => either(bitmap::BLACK, bitmap::WHITE),
            Self::Edge { .. } => edge::RIDGE,
            Self::Button { rim, face, .. } if face.is_above(*rim) => either(button::RIM, button::FACE),
            Self::Button { .. } => either(button::FACE, button::RIM),
            Self::Speed { .. } => return tables::speed::FACTORS.name,
            _ => either(grating::LOW, grating::HIGH),
        };
        places.first_of(amount.names())
    }
}

fn low_and_high(
    fields: &mut Fields,
    [low, high]: [&AmountFields; 2],
    unit: Unit,
    log: &mut Log,
) -> (Option<Amount>, Option<Amount>) {
    (Amount::read(fields, low, unit, log), Amount::read(fields, high, unit, log))
}

fn grating(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let square = Wave::Square { duty: 0.5 };
    let waves = [("sine", Wave::Sine), ("square", square), ("triangle", Wave::Triangle), ("saw", Wave::Saw)];
    let wave = fields.choice(log, &tables::grating::WAVE, &waves).unwrap_or_default();
    let wave = match wave {
        Wave::Square { .. } => Wave::Square { duty: fields.number_or_default(log, &tables::grating::DUTY) as f32 },
        other => other,
    };
    let wavelength_mm = fields.number(log, &tables::grating::WAVELENGTH_MM);
    let angle_deg = fields.number_or_default(log, &tables::grating::ANGLE_DEG);
    let phase_deg = fields.number_or_default(log, &tables::grating::PHASE_DEG);
    let (low, high) = low_and_high(fields, [&tables::grating::LOW, &tables::grating::HIGH], unit, log);
    Some(Kind::Grating { wave, wavelength_mm: wavelength_mm?, angle_deg, phase_deg, low: low?, high: high? })
}

fn bitmap(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Bitmap> {
    // What a region says need not be said again.
    let mut place = |field: &FieldSpec| {
        if !fields.has_been_read(tables::layer::REGION.name) {
            fields.require(field);
        }
        fields.number(log, field)
    };
    let (x_mm, y_mm) = (place(&tables::bitmap::X_MM), place(&tables::bitmap::Y_MM));
    let width_mm = place(&tables::bitmap::WIDTH_MM);
    let picture = fields.text(log, &tables::bitmap::PICTURE);
    let height_mm = fields.number(log, &tables::bitmap::HEIGHT_MM);
    let pitch_mm = fields.number_or_default(log, &tables::bitmap::PITCH_MM);
    let angle_deg = fields.number_or_default(log, &tables::bitmap::ANGLE_DEG);
    let tiled = fields.flag(log, &tables::bitmap::TILED);
    // Bare glass, and the most that the drive gives: what a friction image without numbers means.
    let (black, white) = match unit {
        Unit::Friction => (Amount::Fraction(0.0), Amount::Fraction(1.0)),
        Unit::Factor => (Amount::Factor(0.0), Amount::Factor(1.0)),
    };
    let black = Amount::read(fields, &tables::bitmap::BLACK, unit, log).unwrap_or(black);
    let white = Amount::read(fields, &tables::bitmap::WHITE, unit, log).unwrap_or(white);
    let picture = picture?;
    Some(Bitmap { picture, x_mm, y_mm, width_mm, height_mm, pitch_mm, angle_deg, tiled, black, white })
}

fn noise(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let seed = fields.number_or_default(log, &tables::noise::SEED) as u32;
    let wavelength_min_mm = fields.number(log, &tables::noise::WAVELENGTH_MIN_MM);
    let wavelength_max_mm = fields.number(log, &tables::noise::WAVELENGTH_MAX_MM);
    let (low, high) = low_and_high(fields, [&tables::noise::LOW, &tables::noise::HIGH], unit, log);
    Some(Kind::Noise {
        seed,
        wavelength_min_mm: wavelength_min_mm?,
        wavelength_max_mm: wavelength_max_mm?,
        low: low?,
        high: high?,
    })
}

fn edge(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let x_mm = fields.number(log, &tables::edge::X_MM);
    let y_mm = fields.number(log, &tables::edge::Y_MM);
    let angle_deg = fields.number_or_default(log, &tables::edge::ANGLE_DEG);
    let width_mm = fields.number(log, &tables::edge::WIDTH_MM);
    let ridge = Amount::read(fields, &tables::edge::RIDGE, unit, log);
    let click = click(fields, &tables::edge::CLICK, unit, log);
    Some(Kind::Edge { x_mm: x_mm?, y_mm: y_mm?, angle_deg, width_mm: width_mm?, ridge: ridge?, click })
}

fn button(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let rim_width_mm = fields.number(log, &tables::button::RIM_WIDTH_MM);
    let rim = Amount::read(fields, &tables::button::RIM, unit, log);
    let face = Amount::read(fields, &tables::button::FACE, unit, log);
    let click = click(fields, &tables::button::CLICK, unit, log);
    Some(Kind::Button { rim_width_mm: rim_width_mm?, rim: rim?, face: face?, click })
}

fn click(fields: &mut Fields, height: &AmountFields, unit: Unit, log: &mut Log) -> Option<Click> {
    let decay_ms = fields.number_or_default(log, &tables::CLICK_MS);
    Some(Click { height: Amount::read(fields, height, unit, log)?, decay_ms })
}

fn vibration(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let beats = [("sine", Beat::Sine), ("square", Beat::Square)];
    let beat = fields.choice(log, &tables::vibration::WAVE, &beats).unwrap_or_default();
    let frequency_hz = fields.number(log, &tables::vibration::FREQUENCY_HZ);
    let (low, high) = low_and_high(fields, [&tables::vibration::LOW, &tables::vibration::HIGH], unit, log);
    let wanted = fields.has("burst");
    let burst = fields.table(log, &tables::vibration::BURST).and_then(|fields| burst(fields, log));
    if wanted && burst.is_none() {
        return None;
    }
    Some(Kind::Vibration { beat, frequency_hz: frequency_hz?, low: low?, high: high?, burst })
}

fn burst(mut fields: Fields, log: &mut Log) -> Option<Burst> {
    fields.rename("this burst".to_owned());
    let period_ms = fields.number(log, &tables::burst::PERIOD_MS);
    let on_ms = fields.number(log, &tables::burst::ON_MS);
    let ramp_ms = fields.number_or_default(log, &tables::burst::RAMP_MS);
    let places = fields.close(log);
    let (period_ms, on_ms) = (period_ms?, on_ms?);
    for (field, found, max) in [("on_ms", on_ms, period_ms), ("ramp_ms", ramp_ms, 0.5 * on_ms)] {
        if found > max {
            log.add(places.field(field), Mistake::OutOfRange { field, found, min: 0.0, max, unit: " ms" });
        }
    }
    Some(Burst { period_ms, on_ms, ramp_ms })
}

fn speed(fields: &mut Fields, log: &mut Log) -> Option<Kind> {
    let (offset, factors_offset) = (fields.place("speeds_mm_per_s"), fields.place("factors"));
    let speeds_mm_per_s = fields.numbers(log, &tables::speed::SPEEDS_MM_PER_S);
    let factors = fields.numbers(log, &tables::speed::FACTORS);
    let (speeds_mm_per_s, factors) = (speeds_mm_per_s?, factors?);
    let (found, min, max) = (speeds_mm_per_s.len(), 2, CURVE_POINTS_MAX);
    if !(min..=max).contains(&found) {
        log.add(offset, Mistake::Count { field: "speeds_mm_per_s", found, min, max });
    } else if factors.len() != found {
        let mistake = Mistake::Count { field: "factors", found: factors.len(), min: found, max: found };
        log.add(factors_offset, mistake);
    }
    // A board tells speeds apart that are a hundredth of a millimetre a second apart.
    if let Some([before, after]) = speeds_mm_per_s.array_windows().find(|[before, after]| after - before < 0.02) {
        log.add(offset, Mistake::SpeedsDoNotRise { before: *before, after: *after });
    }
    Some(Kind::Speed { speeds_mm_per_s, factors })
}
