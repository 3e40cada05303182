//! What belongs to each kind of layer.

use frixel_layers::{Beat, Wave};
use frixel_wire::scene::CURVE_POINTS_MAX;

use super::super::fields::{Fields, Range};
use super::super::log::Log;
use super::super::mistake::Mistake;
use super::super::source::Places;
use super::amount::{Amount, FACTOR, Names, Unit};
use super::region::{PLACE_MM, SIZE_MM};

const WAVELENGTH_MM: Range = Range::new(0.05, 2_000.0, " mm");
const PITCH_MM: Range = Range::new(0.02, 10.0, " mm");
const ANGLE_DEG: Range = Range::new(-360.0, 360.0, " degrees");
const DUTY: Range = Range::new(0.01, 0.99, "");
const CLICK_MS: Range = Range::new(0.1, 1_000.0, " ms");
const FREQUENCY_HZ: Range = Range::new(0.01, 1_000.0, " Hz");
const BURST_MS: Range = Range::new(1.0, 60_000.0, " ms");
const RAMP_MS: Range = Range::new(0.0, 30_000.0, " ms");
const SPEED_MM_PER_S: Range = Range::new(0.0, 10_000.0, " mm/s");
const SEED: Range = Range::new(0.0, 4_294_967_295.0, "");
/// Distance of a picture's samples where the file names none.
const PITCH_DEFAULT_MM: f64 = 0.25;
/// How long a click takes where the file says nothing.
const CLICK_DEFAULT_MS: f64 = 20.0;

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
            Self::Constant => Some(Kind::Constant { friction: Amount::read(fields, Names::FRICTION, unit, log)? }),
            Self::Grating => grating(fields, unit, log),
            Self::Bitmap => bitmap(fields, unit, log).map(Kind::Bitmap),
            Self::Noise => noise(fields, unit, log),
            Self::Edge => edge(fields, unit, log),
            Self::Button => button(fields, unit, log),
            Self::Vibration => vibration(fields, unit, log),
            Self::Speed => speed(fields, log),
            Self::Stream => {
                let (low, high) = low_and_high(fields, unit, log);
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
            let (low_name, high_name) = (places.first_of(Names::LOW.all()), places.first_of(Names::HIGH.all()));
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
        let either = |low: Names, high: Names| if most { high } else { low };
        let names = match self {
            Self::Constant { .. } => Names::FRICTION,
            Self::Bitmap(Bitmap { black, white, .. }) if black.is_above(*white) => either(Names::WHITE, Names::BLACK),
            Self::Bitmap(_) => either(Names::BLACK, Names::WHITE),
            Self::Edge { .. } => Names::RIDGE,
            Self::Button { rim, face, .. } if face.is_above(*rim) => either(Names::RIM, Names::FACE),
            Self::Button { .. } => either(Names::FACE, Names::RIM),
            Self::Speed { .. } => return "factors",
            _ => either(Names::LOW, Names::HIGH),
        };
        places.first_of(names.all())
    }
}

fn low_and_high(fields: &mut Fields, unit: Unit, log: &mut Log) -> (Option<Amount>, Option<Amount>) {
    (Amount::read(fields, Names::LOW, unit, log), Amount::read(fields, Names::HIGH, unit, log))
}

fn grating(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let square = Wave::Square { duty: 0.5 };
    let waves = [("sine", Wave::Sine), ("square", square), ("triangle", Wave::Triangle), ("saw", Wave::Saw)];
    let wave = fields.optional_choice(log, "wave", &waves).unwrap_or_default();
    let wave = match wave {
        Wave::Square { .. } => Wave::Square { duty: fields.optional_number(log, "duty", DUTY).unwrap_or(0.5) as f32 },
        other => other,
    };
    let wavelength_mm = fields.number(log, "wavelength_mm", WAVELENGTH_MM);
    let angle_deg = fields.optional_number(log, "angle_deg", ANGLE_DEG).unwrap_or(0.0);
    let phase_deg = fields.optional_number(log, "phase_deg", ANGLE_DEG).unwrap_or(0.0);
    let (low, high) = low_and_high(fields, unit, log);
    Some(Kind::Grating { wave, wavelength_mm: wavelength_mm?, angle_deg, phase_deg, low: low?, high: high? })
}

fn bitmap(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Bitmap> {
    // What a region says need not be said again.
    let mut place = |field, range| {
        if !fields.has_been_read("region") {
            fields.require(field);
        }
        fields.optional_number(log, field, range)
    };
    let (x_mm, y_mm, width_mm) = (place("x_mm", PLACE_MM), place("y_mm", PLACE_MM), place("width_mm", SIZE_MM));
    let picture = fields.text(log, "picture");
    let height_mm = fields.optional_number(log, "height_mm", SIZE_MM);
    let pitch_mm = fields.optional_number(log, "pitch_mm", PITCH_MM).unwrap_or(PITCH_DEFAULT_MM);
    let angle_deg = fields.optional_number(log, "angle_deg", ANGLE_DEG).unwrap_or(0.0);
    let tiled = fields.flag(log, "tiled", false);
    // Bare glass, and the most that the drive gives: what a friction image without numbers means.
    let (black, white) = match unit {
        Unit::Friction => (Amount::Fraction(0.0), Amount::Fraction(1.0)),
        Unit::Factor => (Amount::Factor(0.0), Amount::Factor(1.0)),
    };
    let black = Amount::optional(fields, Names::BLACK, unit, log).unwrap_or(black);
    let white = Amount::optional(fields, Names::WHITE, unit, log).unwrap_or(white);
    let picture = picture?;
    Some(Bitmap { picture, x_mm, y_mm, width_mm, height_mm, pitch_mm, angle_deg, tiled, black, white })
}

fn noise(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let seed = fields.optional_whole(log, "seed", SEED).unwrap_or(0.0) as u32;
    let wavelength_min_mm = fields.number(log, "wavelength_min_mm", WAVELENGTH_MM);
    let wavelength_max_mm = fields.number(log, "wavelength_max_mm", WAVELENGTH_MM);
    let (low, high) = low_and_high(fields, unit, log);
    Some(Kind::Noise {
        seed,
        wavelength_min_mm: wavelength_min_mm?,
        wavelength_max_mm: wavelength_max_mm?,
        low: low?,
        high: high?,
    })
}

fn edge(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let x_mm = fields.number(log, "x_mm", PLACE_MM);
    let y_mm = fields.number(log, "y_mm", PLACE_MM);
    let angle_deg = fields.optional_number(log, "angle_deg", ANGLE_DEG).unwrap_or(0.0);
    let width_mm = fields.number(log, "width_mm", SIZE_MM);
    let ridge = Amount::read(fields, Names::RIDGE, unit, log);
    let click = click(fields, unit, log);
    Some(Kind::Edge { x_mm: x_mm?, y_mm: y_mm?, angle_deg, width_mm: width_mm?, ridge: ridge?, click })
}

fn button(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let rim_width_mm = fields.number(log, "rim_width_mm", SIZE_MM);
    let rim = Amount::read(fields, Names::RIM, unit, log);
    let face = Amount::read(fields, Names::FACE, unit, log);
    let click = click(fields, unit, log);
    Some(Kind::Button { rim_width_mm: rim_width_mm?, rim: rim?, face: face?, click })
}

fn click(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Click> {
    let decay_ms = fields.optional_number(log, "click_ms", CLICK_MS).unwrap_or(CLICK_DEFAULT_MS);
    Some(Click { height: Amount::optional(fields, Names::CLICK, unit, log)?, decay_ms })
}

fn vibration(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
    let beats = [("sine", Beat::Sine), ("square", Beat::Square)];
    let beat = fields.optional_choice(log, "wave", &beats).unwrap_or_default();
    let frequency_hz = fields.number(log, "frequency_hz", FREQUENCY_HZ);
    let (low, high) = low_and_high(fields, unit, log);
    let wanted = fields.has("burst");
    let burst = fields.optional_table(log, "burst").and_then(|fields| burst(fields, log));
    if wanted && burst.is_none() {
        return None;
    }
    Some(Kind::Vibration { beat, frequency_hz: frequency_hz?, low: low?, high: high?, burst })
}

fn burst(mut fields: Fields, log: &mut Log) -> Option<Burst> {
    fields.rename("this burst".to_owned());
    let period_ms = fields.number(log, "period_ms", BURST_MS);
    let on_ms = fields.number(log, "on_ms", BURST_MS);
    let ramp_ms = fields.optional_number(log, "ramp_ms", RAMP_MS).unwrap_or(0.0);
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
    let speeds_mm_per_s = fields.numbers(log, "speeds_mm_per_s", SPEED_MM_PER_S);
    let factors = fields.numbers(log, "factors", FACTOR);
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
