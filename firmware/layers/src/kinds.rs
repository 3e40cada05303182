//! The kinds of layer: the list from which everything that covers all kinds is generated.

#[cfg(feature = "bitmap")]
pub(crate) mod bitmap;
#[cfg(feature = "edge")]
pub(crate) mod button;
pub(crate) mod constant;
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
#[cfg(feature = "stream")]
pub(crate) mod stream;
#[cfg(feature = "vibration")]
pub(crate) mod vibration;

#[cfg_attr(not(feature = "bitmap"), allow(unused_imports, reason = "constant layers have no bit"))]
use frixel_wire::hello::feature;
use frixel_wire::message::{ConfigRefusal, Refusal};
use frixel_wire::scene::SceneError;

use crate::click::Click;
use crate::context::Context;
use crate::interval::Interval;
use crate::kind::{Kind, evaluate};
use crate::layout::{FORM_AT, RecordBytes};
use crate::parameters::{Parameters, UnknownForm};
use crate::point::Point;
use crate::prepare::Preparation;
use crate::region::{ActiveRegion, Region};

/// Generates the enums of all kinds, and the functions that dispatch on them, from one list.
macro_rules! kinds {
    ($(
        $(#[doc = $doc:literal])*
        $(#[cfg($cfg:meta)])?
        $number:literal => $kind:ident in $module:ident, $bit:expr;
    )*) => {
        $( $(#[cfg($cfg)])? pub use $module::$kind; )*

        /// Kind and parameters of a layer. Frictions are electric, in newtons, before the gain; dimensionless factors
        /// in a layer with multiplicative blend.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum Layer {
            $( $(#[doc = $doc])* $(#[cfg($cfg)])? $kind($kind), )*
        }

        /// Coefficients of a layer. Its tag is a byte of its own, so that the tick finds the kind at once.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(u8)]
        pub(crate) enum Coefficients {
            $( $(#[cfg($cfg)])? $kind(<$kind as Kind>::Coefficients), )*
        }

        /// Whether this crate knows a kind with this number, whether or not its feature is enabled.
        pub(crate) const fn is_known(number: u8) -> bool {
            let mut known = false;
            $( known |= number == $number; )*
            known
        }

        /// Bits of [`frixel_wire::hello::feature`] of the kinds whose features are enabled.
        pub(crate) const KIND_FEATURES: u32 = {
            let mut bits = 0;
            $( $(#[cfg($cfg)])? { bits |= $bit; } )*
            bits
        };

        impl Layer {
            /// Numbers in records of the kinds whose features are enabled.
            pub const NUMBERS: &'static [u8] = &[$( $(#[cfg($cfg)])? $number, )*];

            /// The kind's number in records.
            pub const fn number(&self) -> u8 {
                match self { $( $(#[cfg($cfg)])? Self::$kind(_) => $number, )* }
            }

            /// The bit of [`frixel_wire::hello::feature`] that a board needs to play the layer, or 0.
            pub const fn feature(&self) -> u32 {
                match self { $( $(#[cfg($cfg)])? Self::$kind(_) => $bit, )* }
            }

            /// Whether the layer plays the host's stream, and fades with it.
            pub const fn is_streamed(&self) -> bool {
                match self { $( $(#[cfg($cfg)])? Self::$kind(_) => <$kind as Kind>::STREAMED, )* }
            }

            pub(crate) fn read(number: u8, bytes: &RecordBytes, record: u8) -> Result<Self, SceneError> {
                match number {
                    $( $(#[cfg($cfg)])? $number => Parameters::read(bytes).map(Self::$kind), )*
                    kind => return Err(SceneError::UnknownKind { record, kind }),
                }
                .map_err(|UnknownForm(value)| SceneError::UnknownChoice { record, offset: FORM_AT as u8, value })
            }

            pub(crate) const fn cost_elsewhere(&self) -> u32 {
                match self { $( $(#[cfg($cfg)])? Self::$kind(_) => <$kind as Kind>::COST_ELSEWHERE, )* }
            }

            pub(crate) fn prepare(
                &self,
                layer: u8,
                preparation: &mut Preparation,
            ) -> Result<Coefficients, Refusal> {
                match self {
                    $( $(#[cfg($cfg)])? Self::$kind(kind) => {
                        Kind::prepare(kind, layer, preparation).map(Coefficients::$kind)
                    } )*
                }
            }
        }

        impl Coefficients {
            /// Electric friction, in N, before the gain; or a factor. The finger is inside `region`.
            #[inline]
            pub(crate) fn electric_friction_n(&self, region: &ActiveRegion, context: &mut Context) -> f32 {
                match self { $( $(#[cfg($cfg)])? Self::$kind(kind) => evaluate(kind, region, context), )* }
            }
        }

        /// Name of each kind, with its parameters' names, offsets and lengths.
        #[cfg(test)]
        const LAYOUTS: &[(&str, &[(&str, usize, usize)])] =
            &[$( $(#[cfg($cfg)])? (stringify!($kind), <$kind as Parameters>::LAYOUT), )*];

        /// Calls a function of whichever kind a layer is.
        macro_rules! of_kind {
            ($layer:expr, $named:ident => $call:expr) => {
                match $layer { $( $(#[cfg($cfg)])? Layer::$kind($named) => $call, )* }
            };
        }
    };
}

kinds! {
    /// The same friction everywhere.
    1 => Constant in constant, 0;
    /// Parallel stripes.
    #[cfg(feature = "grating")]
    2 => Grating in grating, feature::GRATING;
    /// A picture.
    #[cfg(feature = "bitmap")]
    3 => Bitmap in bitmap, feature::BITMAP;
    /// Band-limited noise.
    #[cfg(feature = "noise")]
    4 => Noise in noise, feature::NOISE;
    /// A line with a ridge or a well along it, and a click when the finger crosses it.
    #[cfg(feature = "edge")]
    5 => Edge in edge, feature::EDGE;
    /// A button that fills its region, and a click when the finger slides in.
    #[cfg(feature = "edge")]
    6 => Button in button, feature::EDGE;
    /// Friction that changes with time.
    #[cfg(feature = "vibration")]
    7 => Vibration in vibration, feature::VIBRATION;
    /// A curve over sliding speed.
    #[cfg(feature = "speed")]
    8 => Speed in speed, feature::SPEED;
    /// What the host sends while the scene plays.
    #[cfg(feature = "stream")]
    9 => Stream in stream, feature::STREAM;
    /// Rings around a middle.
    #[cfg(feature = "rings")]
    10 => Rings in rings, feature::RINGS;
}

impl Layer {
    /// CRC-32 of the bitmap that the layer uses; `None` without a bitmap.
    pub fn bitmap_crc32(&self) -> Option<u32> {
        of_kind!(self, kind => Kind::bitmap_crc32(kind))
    }

    /// The layer's click, if its height is not zero.
    pub fn click(&self) -> Option<Click> {
        of_kind!(self, kind => Kind::click(kind)).filter(Click::is_felt)
    }

    /// Bounds of the layer's friction before its gain and apart from rounding, in N, or as a factor; `points` are the
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

    pub(crate) fn cost(&self) -> u32 {
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
                // After the fields that all records have in common, or the form byte.
                assert!(*offset >= GAIN_AT + 4 || (*offset, *len) == (FORM_AT, 1), "{kind}: {name}");
                for owner in &mut owners[*offset..offset + len] {
                    assert_eq!(std::mem::replace(owner, *name), "", "{kind}: {name}");
                }
            }
        }
    }
}
