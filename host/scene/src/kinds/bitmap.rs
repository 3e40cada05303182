//! A picture.

use std::ops::RangeInclusive;

use frixel_layers::Bitmap as Record;

use super::constant::ConstantField;
use super::samples::Samples;
use super::*;
use crate::picture::Ground;
use crate::tables::layer::REGION;

const PICTURE: FieldSpec = FieldSpec::new(
    "picture",
    Holds::Text,
    Mistake,
    "a PNG or JPEG file, found from the folder of the file that names it",
);
const X: LengthFields = length!("x", X, PLACE_MM, Means("the region's"), "left side of the picture");
const Y: LengthFields = length!("y", Y, PLACE_MM, Means("the region's"), "top side of the picture");
const WIDTH: LengthFields = length!("width", X, SIZE_MM, Means("the region's"), "its width");
const HEIGHT: LengthFields = length!(
    "height",
    Y,
    SIZE_MM,
    Means("the picture's proportions; the region's, if `width_mm` is the region's too"),
    "its height",
);
const ANGLE: FieldSpec = number("angle_deg", ANGLE_DEG, Number(0.0), "rotation about its centre");
const TILED: FieldSpec =
    flag("tiled", false, "`true`: it is repeated in both directions, over the region or the screen");
/// Finest and coarsest pitch.
pub(crate) const PITCH_MM: Range = Range::new(0.02, 10.0, " mm");
const PITCH: FieldSpec = FieldSpec::new(
    "pitch_mm",
    Holds::NumberOrAuto(PITCH_MM),
    Means("`\"auto\"`"),
    "spacing of the samples that the board plays; `\"auto\"`: the finest that fits the board",
);
const LEVELS: FieldSpec = word(
    "levels",
    Means("`\"full\"`"),
    "`\"full\"`: the black and white of the file; `\"stretch\"`: the darkest and the lightest hundredth of the \
     picture become black and white",
);
const TRANSPARENT: FieldSpec = word(
    "transparent",
    Means("`\"black\"`"),
    "`\"black\"` or `\"white\"`: the ground behind transparent parts of the picture",
);
const INVERT: FieldSpec = flag("invert", false, "`true`: black and white are exchanged, also those of `transparent`");
const BLACK: AmountFields = amount!("black", Means("0"), "friction of black");
const WHITE: AmountFields =
    amount!("white", Means("the largest friction in reach; a factor of 1"), "friction of white");

/// The grey levels that become black and white.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Levels {
    /// Black and white of the file.
    Full,
    /// The darkest and the lightest hundredth of the picture.
    Stretch,
}

/// `kind = "bitmap"`.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bitmap {
    pub(crate) picture: String,
    /// Place and width; `None` to use those of the region.
    pub(crate) x_mm: Option<f64>,
    pub(crate) y_mm: Option<f64>,
    pub(crate) width_mm: Option<f64>,
    pub(crate) height_mm: Option<f64>,
    /// `None` for the finest pitch that fits.
    pub(crate) pitch_mm: Option<f64>,
    pub(crate) levels: Levels,
    pub(crate) ground: Ground,
    pub(crate) is_inverted: bool,
    pub(crate) angle_deg: f64,
    pub(crate) tiled: bool,
    black: Amount,
    white: Amount,
}

impl LayerFields for Bitmap {
    const WORD: &'static str = "bitmap";

    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self> {
        // Place and width default to those of the region.
        let mut place = |field: &LengthFields| {
            if !fields.places().has(REGION.name) && !fields.has(field.px.name) {
                fields.require_place(&field.mm);
            }
            fields.length_mm(log, field)
        };
        let (x_mm, y_mm, width_mm) = (place(&X), place(&Y), place(&WIDTH));
        let picture = fields.free_text(log, &PICTURE);
        let height_mm = fields.length_mm(log, &HEIGHT);
        let pitch_mm = fields.number_or_auto(log, &PITCH);
        let levels = [("full", Levels::Full), ("stretch", Levels::Stretch)];
        let levels = fields.choice(log, &LEVELS, &levels).unwrap_or(Levels::Full);
        let grounds = [("black", Ground::Black), ("white", Ground::White)];
        let ground = fields.choice(log, &TRANSPARENT, &grounds).unwrap_or_default();
        let is_inverted = fields.flag(log, &INVERT);
        let angle_deg = fields.angle_deg(log, &ANGLE);
        let tiled = fields.flag(log, &TILED);
        // Defaults of a picture without amounts: black is bare glass, white the largest reachable friction.
        let (black, white) = match unit {
            Unit::Friction => (Amount::Fraction(0.0), Amount::Fraction(1.0)),
            Unit::Factor => (Amount::Factor(0.0), Amount::Factor(1.0)),
        };
        let black = Amount::read(fields, &BLACK, unit, log).unwrap_or(black);
        let white = Amount::read(fields, &WHITE, unit, log).unwrap_or(white);
        let picture = picture?;
        Some(Self {
            picture,
            x_mm,
            y_mm,
            width_mm,
            height_mm,
            pitch_mm,
            levels,
            ground,
            is_inverted,
            angle_deg,
            tiled,
            black,
            white,
        })
    }

    fn fills_screen(&self) -> bool {
        self.tiled
    }

    fn move_by(&mut self, x_mm: f64, y_mm: f64) {
        self.x_mm = self.x_mm.map(|place_mm| place_mm + x_mm);
        self.y_mm = self.y_mm.map(|place_mm| place_mm + y_mm);
    }

    fn extreme(&self, most: bool, places: &Places, record: &RecordLayer) -> &'static str {
        let is_black_most = matches!(record, RecordLayer::Bitmap(bitmap) if bitmap.black_n > bitmap.white_n);
        let amount = if most == is_black_most { BLACK } else { WHITE };
        places.first_of(amount.names())
    }

    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
        let visible = layer.region.as_ref().map(Region::bounds);
        let placed = lowering.place_bitmap(layer, self, visible)?;
        let has_own_height = self.height_mm.is_some();
        let warning =
            Warning::of_stretch(layer.title.as_str(), placed.height_factor, placed.height_kept_mm, has_own_height);
        lowering.warn(layer, warning);
        let hidden = placed.is_hidden.then(|| Warning::PictureHidden {
            layer: layer.title.as_str().to_owned(),
            cure: match self.ground {
                Ground::Black if self.is_inverted => "`transparent = \"white\"`",
                Ground::Black => "`transparent = \"white\"` and `invert = true`",
                Ground::White if self.is_inverted => "`transparent = \"black\"` and `invert = false`",
                Ground::White => "`transparent = \"black\"`",
            },
        });
        lowering.warn(layer, hidden);
        let (black_n, white_n) = (lowering.amount(layer, self.black), lowering.amount(layer, self.white));
        let record = Record { black_n, white_n, ..placed.record };
        Some(Lowered { layer: RecordLayer::Bitmap(record), outline: placed.outline })
    }
}

/// Reference of a bitmap layer; NaN everywhere if the program lacks the bitmap.
impl IntoField for Record {
    fn field(&self, _region: RecordRegion, program: &Program) -> Arc<dyn Field> {
        let bitmap = program.bitmap(self.crc32).filter(|bitmap| bitmap.width > 0 && bitmap.height > 0);
        match bitmap {
            Some(bitmap) => Arc::new(Samples::new(bitmap, self)),
            None => Arc::new(ConstantField(f64::NAN)),
        }
    }

    fn without_place(self) -> Self {
        Self { x_m: 0.0, y_m: 0.0, angle_turns: 0.0, ..self }
    }
}

impl Field for Samples {
    fn at(&self, context: &Context) -> f64 {
        self.at_place(context.x_m, context.y_m)
    }

    /// Extremes of a bilinear patch lie at its corners: at sample centres, and at the cell's boundary. For a rotated
    /// picture, all samples within reach of the cell count.
    fn extremes_in(&self, cell: Cell, _bounds: Interval<f64>) -> Extremes {
        let positions = cell.corners().map(|(x_m, y_m)| self.position(x_m, y_m));
        let u = Interval::of(positions.iter().map(|(u, _)| *u));
        let v = Interval::of(positions.iter().map(|(_, v)| *v));
        if self.is_turned() {
            return Extremes::Bounded(Interval::of(self.frictions(around(u, self.width), around(v, self.height))));
        }
        let stretch = |start_m: f64, end_m: f64, first_m: f64, pitch_m: f64, samples: RangeInclusive<i64>| {
            let centres = samples.map(move |n| first_m + (n as f64 + 0.5) * pitch_m);
            let mut stretch = vec![start_m, end_m];
            stretch.extend(centres.filter(|centre_m| (start_m..=end_m).contains(centre_m)));
            stretch
        };
        let columns = stretch(cell.left_m, cell.right_m, self.x_m, self.pitch_m, around(u, self.width));
        let rows = stretch(cell.top_m, cell.bottom_m, self.y_m, self.pitch_y_m, around(v, self.height));
        let places = rows.iter().flat_map(|y_m| columns.iter().map(|x_m| (*x_m, *y_m)));
        Extremes::Reached(Interval::of(places.map(|(x_m, y_m)| self.at_place(x_m, y_m))))
    }

    fn detail_m(&self) -> Option<f64> {
        Some(self.pitch_m.min(self.pitch_y_m))
    }
}

/// Indices of the samples around an interval of positions. A range of twice the number of samples covers every tile.
fn around(positions: Interval<f64>, samples: u32) -> RangeInclusive<i64> {
    let first = libm::floor(positions.low).max(-1e6) as i64;
    let last = libm::ceil(positions.high).min(1e6) as i64;
    first..=last.min(first + 2 * i64::from(samples))
}
