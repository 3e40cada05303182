//! The kinds of layer: the list from which all code that covers all kinds is generated.

#[cfg(feature = "bitmap")]
pub(crate) mod bitmap;
#[cfg(feature = "edge")]
pub(crate) mod button;
pub(crate) mod constant;
#[cfg(feature = "direction")]
pub(crate) mod direction;
#[cfg(feature = "edge")]
pub(crate) mod edge;
#[cfg(feature = "grating")]
pub(crate) mod grating;
#[cfg(feature = "noise")]
pub(crate) mod noise;
#[cfg(feature = "rings")]
pub(crate) mod rings;
#[cfg(feature = "speed")]
pub(crate) mod speed;
#[cfg(feature = "spokes")]
pub(crate) mod spokes;
#[cfg(feature = "stream")]
pub(crate) mod stream;
#[cfg(feature = "vibration")]
pub(crate) mod vibration;

use frixel_wire::message::{ConfigRefusal, Refusal};
use frixel_wire::scene::SceneError;

use crate::click::Click;
use crate::context::Context;
use crate::cost::Cost;
use crate::interval::Interval;
use crate::kind::{Evaluate, Kind, evaluate};
use crate::layout::{FORM_AT, RecordBytes};
use crate::parameters::{Parameters, UnknownForm};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::{ActiveRegion, Region};

/// Generates the enums of all kinds, and the functions that dispatch on them, from one list: the kind's number in
/// records, its type and module, its Cargo feature, and the number of its bit in the hello's features. Numbers are
/// never reused.
macro_rules! kinds {
    ($(
        $(#[doc = $doc:literal])*
        $number:literal => $kind:ident in $module:ident $(, feature $feature:literal bit $bit:literal)?;
    )*) => {
        $( $(#[cfg(feature = $feature)])? pub use $module::$kind; )*

        /// Kind and parameters of a layer. Frictions are electric, in newtons, before the gain; with the multiplicative
        /// blend, they are dimensionless factors.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Layer {
            $( $(#[doc = $doc])* $(#[cfg(feature = $feature)])? $kind($kind), )*
        }

        /// Coefficients of a layer. Its tag is a separate byte, so that the tick finds the kind at once.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(u8)]
        pub(crate) enum Coefficients {
            $( $(#[cfg(feature = $feature)])? $kind(<$kind as Kind>::Coefficients), )*
        }

        /// Number in records and name of each kind, whether or not its feature is enabled.
        pub fn kind_names() -> impl Iterator<Item = (u8, &'static str)> {
            [$( ($number, stringify!($kind)), )*].into_iter()
        }

        /// Whether this crate knows a kind with this number, whether or not its feature is enabled.
        pub(crate) const fn is_known(number: u8) -> bool {
            let mut known = false;
            $( known |= number == $number; )*
            known
        }

        /// Number, feature and bit of the kinds that have a feature, whether or not it is enabled.
        pub const KIND_FEATURES: &[KindFeature] =
            &[$( $( KindFeature { number: $number, name: $feature, bit: 1 << $bit }, )? )*];

        /// The bits of the kinds whose features are enabled.
        pub(crate) const KIND_FEATURES_ON: u32 = {
            let mut bits = 0;
            $( $( if cfg!(feature = $feature) { bits |= 1 << $bit; } )? )*
            bits
        };

        impl Layer {
            /// Numbers in records of the kinds whose features are enabled.
            pub const NUMBERS: &'static [u8] = &[$( $(#[cfg(feature = $feature)])? $number, )*];

            /// The kind's number in records.
            pub const fn number(&self) -> u8 {
                match self { $( $(#[cfg(feature = $feature)])? Self::$kind(_) => $number, )* }
            }

            /// The bit of the hello's features that a board needs to play the layer, or 0.
            pub const fn feature(&self) -> u32 {
                match self { $( $(#[cfg(feature = $feature)])? Self::$kind(_) => 0 $( | 1 << $bit )?, )* }
            }

            /// Whether the layer plays the host's stream, and fades with it.
            pub const fn is_streamed(&self) -> bool {
                match self { $( $(#[cfg(feature = $feature)])? Self::$kind(_) => <$kind as Kind>::STREAMED, )* }
            }

            pub(crate) fn read(number: u8, bytes: &RecordBytes, record: u8) -> Result<Self, SceneError> {
                match number {
                    $( $(#[cfg(feature = $feature)])? $number => Parameters::read(bytes).map(Self::$kind), )*
                    kind => return Err(SceneError::UnknownKind { record, kind }),
                }
                .map_err(|UnknownForm(value)| SceneError::UnknownChoice { record, offset: FORM_AT as u8, value })
            }

            pub(crate) const fn cost_elsewhere(&self) -> Cost {
                match self { $( $(#[cfg(feature = $feature)])? Self::$kind(_) => <$kind as Kind>::COST_ELSEWHERE, )* }
            }

            pub(crate) fn prepare(
                &self,
                layer: u8,
                preparation: &mut Preparation,
            ) -> Result<Coefficients, Refusal> {
                match self {
                    $( $(#[cfg(feature = $feature)])? Self::$kind(kind) => {
                        Kind::prepare(kind, layer, preparation).map(Coefficients::$kind)
                    } )*
                }
            }
        }

        impl Coefficients {
            /// Electric friction, in N, before the gain; or a factor. The finger is inside `region`.
            #[inline]
            pub(crate) fn electric_friction_n(&self, region: &ActiveRegion, context: &mut Context) -> f32 {
                match self { $( $(#[cfg(feature = $feature)])? Self::$kind(kind) => evaluate(kind, region, context), )* }
            }

            /// Called when the host switches the layer on; `tick` is its first tick.
            #[inline]
            pub(crate) fn begin(&mut self, tick: u32) {
                match self { $( $(#[cfg(feature = $feature)])? Self::$kind(kind) => Evaluate::begin(kind, tick), )* }
            }
        }

        /// Name of each kind, with its parameters' names, offsets and lengths.
        #[cfg(test)]
        const LAYOUTS: &[(&str, &[(&str, usize, usize)])] =
            &[$( $(#[cfg(feature = $feature)])? (stringify!($kind), <$kind as Parameters>::LAYOUT), )*];

        /// Calls a function on the kind of a layer.
        macro_rules! of_kind {
            ($layer:expr, $named:ident => $call:expr) => {
                match $layer { $( $(#[cfg(feature = $feature)])? Layer::$kind($named) => $call, )* }
            };
        }
    };
}

kinds! {
    /// The same friction everywhere.
    1 => Constant in constant;
    /// Parallel stripes.
    2 => Grating in grating, feature "grating" bit 0;
    /// A picture.
    3 => Bitmap in bitmap, feature "bitmap" bit 1;
    /// Band-limited noise.
    4 => Noise in noise, feature "noise" bit 5;
    /// A line with a ridge or a well along it, and a click when the finger crosses it.
    5 => Edge in edge, feature "edge" bit 6;
    /// A button that fills its region, and a click when the finger slides in.
    6 => Button in button, feature "edge" bit 6;
    /// Friction that changes with time.
    7 => Vibration in vibration, feature "vibration" bit 7;
    /// A curve over sliding speed.
    8 => Speed in speed, feature "speed" bit 8;
    /// Samples streamed by the host during the play.
    9 => Stream in stream, feature "stream" bit 9;
    /// Rings around a centre.
    10 => Rings in rings, feature "rings" bit 11;
    /// Spokes around a centre.
    11 => Spokes in spokes, feature "spokes" bit 12;
    /// Friction that depends on the direction of the slide.
    12 => Direction in direction, feature "direction" bit 14;
}

// The session uses this bit too.
const _: () = assert!(frixel_wire::hello::feature::STREAM == 1 << 9);

/// The Cargo feature of a kind of layer. Several kinds may share one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KindFeature {
    /// The kind's number in records.
    pub number: u8,
    /// Name of the Cargo feature.
    pub name: &'static str,
    /// Its bit in the features of the hello.
    pub bit: u32,
}

impl Layer {
    /// CRC-32 of the layer's bitmap; `None` without a bitmap.
    pub fn bitmap_crc32(&self) -> Option<u32> {
        of_kind!(self, kind => Kind::bitmap_crc32(kind))
    }

    /// The layer's click, if its height is not zero.
    pub fn click(&self) -> Option<Click> {
        of_kind!(self, kind => Kind::click(kind)).filter(Click::is_felt)
    }

    /// Bounds of the layer's friction before its gain and without rounding, in N, or as a factor; `points` are the
    /// scene's.
    pub fn bounds(&self, points: &[Point]) -> Interval<f32> {
        of_kind!(self, kind => Kind::bounds(kind, points))
    }

    pub(crate) fn write(&self, bytes: &mut RecordBytes) {
        of_kind!(self, kind => Parameters::write(kind, bytes));
    }

    pub(crate) fn check_structure(&self, region: &Region, point_count: u8, record: u8) -> Result<(), SceneError> {
        of_kind!(self, kind => Kind::check_structure(kind, region, point_count, record))
    }

    pub(crate) fn check(&self, points: &[Point], layer: u8) -> Result<(), ConfigRefusal> {
        of_kind!(self, kind => {
            Parameters::check(kind, layer)?;
            Kind::check_relations(kind, points, layer)
        })
    }

    pub(crate) fn cost(&self) -> Cost {
        of_kind!(self, kind => Kind::cost(kind))
    }

    pub(crate) fn table_bytes(&self) -> usize {
        of_kind!(self, kind => Kind::table_bytes(kind))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::{GAIN_AT, RECORD_LEN};

    #[test]
    fn parameters_do_not_overlap() {
        for (kind, layout) in LAYOUTS {
            let mut owners = [""; RECORD_LEN];
            for (name, offset, len) in *layout {
                // After the common fields of all records, or the form byte.
                assert!(*offset >= GAIN_AT + 4 || (*offset, *len) == (FORM_AT, 1), "{kind}: {name}");
                for owner in &mut owners[*offset..offset + len] {
                    assert_eq!(std::mem::replace(owner, *name), "", "{kind}: {name}");
                }
            }
        }
    }
}
