//! `[[layer]]`: what a person writes for one layer.

use frixel_wire::scene::{Blend, Wave};

use super::fields::{Fields, Range};
use super::log::Log;
use super::mistake::Mistake;
use super::source::Places;

const PLACE_MM: Range = Range::new(-2_000.0, 2_000.0, " mm");
const SIZE_MM: Range = Range::new(0.01, 2_000.0, " mm");
const WAVELENGTH_MM: Range = Range::new(0.05, 2_000.0, " mm");
const PITCH_MM: Range = Range::new(0.02, 10.0, " mm");
const FRICTION_N: Range = Range::new(-100.0, 100.0, " N");
const ANGLE_DEG: Range = Range::new(-360.0, 360.0, " degrees");
const GAIN: Range = Range::new(-100.0, 100.0, "");
/// Distance of a picture's samples where the file names none.
const PITCH_DEFAULT_MM: f64 = 0.25;

/// One layer as written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Layer {
    /// How messages call it: its number from one, and its name or kind.
    pub(super) title: String,
    pub(super) region: Option<Rectangle>,
    pub(super) blend: Blend,
    pub(super) gain: f64,
    pub(super) above: Above,
    pub(super) kind: Kind,
    pub(super) places: Places,
}

/// What a layer's frictions count from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Above {
    /// From the finger's friction at no voltage.
    Natural,
    /// From zero: they are totals.
    Zero,
}

/// A rectangle on the screen, from its top left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub(super) x_mm: f64,
    pub(super) y_mm: f64,
    pub(super) width_mm: f64,
    pub(super) height_mm: f64,
}

/// What a layer is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    Constant { friction_n: f64 },
    Grating { wave: Wave, wavelength_mm: f64, angle_deg: f64, phase_deg: f64, low_n: f64, high_n: f64 },
    Bitmap(Bitmap),
}

/// A picture's place and friction.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bitmap {
    pub(super) picture: String,
    pub(super) x_mm: f64,
    pub(super) y_mm: f64,
    pub(super) width_mm: f64,
    pub(super) height_mm: Option<f64>,
    pub(super) pitch_mm: f64,
    pub(super) black_n: f64,
    pub(super) white_n: f64,
}

#[derive(Clone, Copy)]
enum KindName {
    Constant,
    Grating,
    Bitmap,
}

impl Layer {
    /// Reads layer `number`, counted from one.
    pub(super) fn read(mut fields: Fields, number: usize, log: &mut Log) -> Option<Self> {
        fields.rename(format!("layer {number}"));
        let kinds = [("constant", KindName::Constant), ("grating", KindName::Grating), ("bitmap", KindName::Bitmap)];
        let name = fields.optional_text(log, "name");
        // Without its kind nobody knows what fields the layer should have.
        let Some(kind_name) = fields.choice(log, "kind", &kinds) else {
            fields.give_up_without(log, "kind");
            return None;
        };
        let title = match (&name, kind_name) {
            (Some(name), _) => format!("layer {number} \"{name}\""),
            (None, KindName::Constant) => format!("layer {number} (constant)"),
            (None, KindName::Grating) => format!("layer {number} (grating)"),
            (None, KindName::Bitmap) => format!("layer {number} (bitmap)"),
        };
        fields.rename(title.clone());
        let region = fields.optional_table(log, "region").map(|fields| rectangle(fields, log));
        let blend = fields.optional_choice(log, "blend", &[("replace", Blend::Replace), ("add", Blend::Add)]);
        let gain = fields.optional_number(log, "gain", GAIN).unwrap_or(1.0);
        let above = fields.optional_choice(log, "above", &[("natural", Above::Natural), ("zero", Above::Zero)]);
        let kind = match kind_name {
            KindName::Constant => constant(&mut fields, log),
            KindName::Grating => grating(&mut fields, log),
            KindName::Bitmap => bitmap(&mut fields, log).map(Kind::Bitmap),
        };
        let places = fields.close(log);
        let blend = blend.unwrap_or_default();
        if blend == Blend::Add && above == Some(Above::Zero) {
            log.add(places.field("above"), Mistake::AddedTotal { layer: title.clone() });
        }
        let above = above.unwrap_or(match (kind_name, blend) {
            (KindName::Constant, Blend::Replace) => Above::Zero,
            _ => Above::Natural,
        });
        let region = match region {
            Some(region) => Some(region?),
            None => None,
        };
        let kind = kind?;
        if let Kind::Grating { low_n, high_n, .. } = kind
            && low_n > high_n
        {
            log.add(places.field("low_n"), Mistake::LowAboveHigh { low_n, high_n });
        }
        Some(Self { title, region, blend, gain, above, kind, places })
    }
}

fn rectangle(mut fields: Fields, log: &mut Log) -> Option<Rectangle> {
    fields.rename("this region".to_owned());
    let x_mm = fields.number(log, "x_mm", PLACE_MM);
    let y_mm = fields.number(log, "y_mm", PLACE_MM);
    let width_mm = fields.number(log, "width_mm", SIZE_MM);
    let height_mm = fields.number(log, "height_mm", SIZE_MM);
    fields.close(log);
    Some(Rectangle { x_mm: x_mm?, y_mm: y_mm?, width_mm: width_mm?, height_mm: height_mm? })
}

fn constant(fields: &mut Fields, log: &mut Log) -> Option<Kind> {
    Some(Kind::Constant { friction_n: fields.number(log, "friction_n", FRICTION_N)? })
}

fn grating(fields: &mut Fields, log: &mut Log) -> Option<Kind> {
    let wave = fields.optional_choice(log, "wave", &[("sine", Wave::Sine), ("square", Wave::Square)]);
    let wavelength_mm = fields.number(log, "wavelength_mm", WAVELENGTH_MM);
    let angle_deg = fields.optional_number(log, "angle_deg", ANGLE_DEG).unwrap_or(0.0);
    let phase_deg = fields.optional_number(log, "phase_deg", ANGLE_DEG).unwrap_or(0.0);
    let low_n = fields.number(log, "low_n", FRICTION_N);
    let high_n = fields.number(log, "high_n", FRICTION_N);
    Some(Kind::Grating {
        wave: wave.unwrap_or_default(),
        wavelength_mm: wavelength_mm?,
        angle_deg,
        phase_deg,
        low_n: low_n?,
        high_n: high_n?,
    })
}

fn bitmap(fields: &mut Fields, log: &mut Log) -> Option<Bitmap> {
    let picture = fields.text(log, "picture");
    let x_mm = fields.number(log, "x_mm", PLACE_MM);
    let y_mm = fields.number(log, "y_mm", PLACE_MM);
    let width_mm = fields.number(log, "width_mm", SIZE_MM);
    let height_mm = fields.optional_number(log, "height_mm", SIZE_MM);
    let pitch_mm = fields.optional_number(log, "pitch_mm", PITCH_MM).unwrap_or(PITCH_DEFAULT_MM);
    let black_n = fields.number(log, "black_n", FRICTION_N);
    let white_n = fields.number(log, "white_n", FRICTION_N);
    Some(Bitmap {
        picture: picture?,
        x_mm: x_mm?,
        y_mm: y_mm?,
        width_mm: width_mm?,
        height_mm,
        pitch_mm,
        black_n: black_n?,
        white_n: white_n?,
    })
}
