//! The kinds of layer, one file each: the fields in a scene file, their conversion to a record, and the kind's
//! reference. The reference follows the kind's definition in `docs/design/scenes.md` and `PROTOCOL.md`, and shares no
//! code with the board.

#![allow(clippy::wildcard_imports, reason = "every kind is written with the same words")]

mod bitmap;
mod button;
mod click;
mod constant;
mod direction;
mod drift;
mod edge;
mod grating;
mod noise;
mod rings;
mod samples;
mod speed;
mod spokes;
mod stream;
mod vibration;
mod wave;

use std::f64::consts::TAU;
use std::fmt::Debug;
use std::sync::Arc;

use frixel_layers::{Blend, Click, Interval, Layer as RecordLayer, Region as RecordRegion, Wave, range};

use crate::cover::Cell;
use crate::fields::Fields;
use crate::grammar::Absence::{Means, Mistake, Number};
use crate::grammar::{AmountFields, FieldSpec, Holds, LengthFields, Range};
use crate::layer::{Amount, Layer, LowHigh, Rectangle, Region, Unit};
use crate::log::Log;
use crate::lower::{Lowering, MM, place};
use crate::mistake::FieldMistake;
use crate::program::Program;
use crate::reference::Context;
use crate::source::Places;
use crate::tables::{ANGLE_DEG, HIGH, LOW, PLACE_MM, SIZE_MM, WAVELENGTH_MM, amount, flag, length, number, word};
use crate::warning::Warning;

pub(crate) use bitmap::{Bitmap, Levels, PITCH_MM};

/// The fields of a kind of layer, as written in a file.
pub(crate) trait LayerFields: Sized {
    /// The value of `kind`.
    const WORD: &'static str;
    /// The allowed blends.
    const BLENDS: &'static [(&'static str, Blend)] =
        &[("replace", Blend::Replace), ("add", Blend::Add), ("multiply", Blend::Multiply), ("max", Blend::Max)];
    /// The default blend.
    const BLEND: Blend = Blend::Replace;
    /// Whether the layer needs a region with a rim: a rectangle or an ellipse.
    const NEEDS_RIM: bool = false;
    /// Whether frictions of a layer that replaces others default to totals.
    const TOTALS: bool = false;

    /// Reads the fields of the kind, and reports mistakes between them.
    fn read(fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Self>;

    /// Name of the field that sets the largest or the least friction of a record's layer. By default, the fields of the
    /// largest and the least amount.
    fn extreme(&self, most: bool, places: &Places, record: &RecordLayer) -> &'static str {
        let _ = record;
        LowHigh::extreme(most, places)
    }

    /// The fields that a click of the record's layer is added to, each with its friction, and the field of the click.
    /// `None` for a kind without clicks.
    fn clicked(&self, places: &Places, record: &RecordLayer) -> Option<Clicked> {
        let _ = (places, record);
        None
    }

    /// Whether a layer of this kind acts on the whole screen if it has no region.
    fn fills_screen(&self) -> bool {
        true
    }

    /// Moves the places in the kind's own fields, for a copy of the layer.
    fn move_by(&mut self, x_mm: f64, y_mm: f64) {
        let _ = (x_mm, y_mm);
    }

    /// Compiles the layer to a record. Returns `None` after a mistake, which has been logged.
    fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered>;
}

/// The fields to which a click is added.
pub(crate) struct Clicked {
    /// Names of fields, each with its friction, N.
    pub(crate) bases: Vec<(&'static str, f64)>,
    /// The field of the click.
    pub(crate) click: &'static str,
}

/// The compiled form of a layer's fields.
pub(crate) struct Lowered {
    pub(crate) layer: RecordLayer,
    /// Where the layer acts if the file names no region: `None` for the whole screen.
    pub(crate) outline: Option<Region>,
}

impl From<RecordLayer> for Lowered {
    fn from(layer: RecordLayer) -> Self {
        Self { layer, outline: None }
    }
}

/// Reference of a layer over plane and time, in `f64`, before its gain: electric friction in newtons, or a factor.
pub(crate) trait Field: Debug + Send + Sync {
    /// The friction in a context, without clicks.
    fn at(&self, context: &Context) -> f64;

    /// Whether the friction at a place is constant in time, apart from clicks. Otherwise the layer reaches both of its
    /// bounds at every place.
    fn is_still(&self) -> bool {
        true
    }

    /// Extremes of a still layer in a cell, clicks included. `bounds` are those of the whole layer, from
    /// `frixel-layers`. The default treats them as reached, so that a refusal depends on the numbers in the scene file,
    /// and not on the seed of a noise.
    fn extremes_in(&self, cell: Cell, bounds: Interval<f64>) -> Extremes {
        let _ = cell;
        Extremes::Reached(bounds)
    }

    /// Length over which the friction varies little, m; `None` if it is uniform.
    fn detail_m(&self) -> Option<f64> {
        None
    }

    /// The click, if it has an effect.
    fn click(&self) -> Option<Click> {
        None
    }

    /// Whether a place is beyond the line whose crossing causes a click.
    fn is_beyond(&self, x_m: f64, y_m: f64) -> bool {
        let _ = (x_m, y_m);
        true
    }

    /// Whether a finger that slides into the region causes a click.
    fn clicks_on_entry(&self) -> bool {
        false
    }

    /// The largest friction of a layer that changes with time alone.
    fn largest_over_time_n(&self) -> Option<f64> {
        None
    }
}

/// Extremes of a layer's friction in a cell of the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Extremes {
    /// The layer reaches both.
    Reached(Interval<f64>),
    /// Bounds that may not be reached; only sampling shows.
    Bounded(Interval<f64>),
}

/// Parameters of a kind in a record, and their reference.
pub(crate) trait IntoField: Copy {
    /// The friction over plane and time.
    fn field(&self, region: RecordRegion, program: &Program) -> Arc<dyn Field>;

    /// The same parameters without place and rotation, in which a layer and its copies differ.
    #[must_use]
    fn without_place(self) -> Self {
        self
    }
}

/// The values of the field `kind` of a layer.
pub fn layer_kinds() -> impl Iterator<Item = &'static str> {
    KindName::ALL.iter().map(|(word, _)| *word)
}

/// Reference of uniform friction, N.
pub(crate) fn constant_field(friction_n: f64) -> Arc<dyn Field> {
    Arc::new(constant::ConstantField(friction_n))
}

/// Range of the friction added by a click at any time.
pub(crate) fn click_interval(click: Option<Click>) -> Interval<f64> {
    Interval::of([0.0, click.map_or(0.0, |click| f64::from(click.height_n))])
}

/// Defines the types of all kinds from one list.
macro_rules! kinds {
    ($( $kind:ident in $module:ident, )*) => {
        /// The fields of a layer's kind, as written in a file.
        #[derive(Clone, Debug, PartialEq)]
        pub(crate) enum Kind {
            $( $kind($module::$kind), )*
        }

        /// A value of `kind`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum KindName {
            $( $kind, )*
        }

        impl KindName {
            pub(crate) const ALL: &[(&str, Self)] = &[$( (<$module::$kind as LayerFields>::WORD, Self::$kind), )*];

            pub(crate) fn word(self) -> &'static str {
                match self { $( Self::$kind => <$module::$kind as LayerFields>::WORD, )* }
            }

            pub(crate) fn blends(self) -> (&'static [(&'static str, Blend)], Blend) {
                match self { $( Self::$kind => (<$module::$kind>::BLENDS, <$module::$kind>::BLEND), )* }
            }

            pub(crate) fn needs_rim(self) -> bool {
                match self { $( Self::$kind => <$module::$kind>::NEEDS_RIM, )* }
            }

            pub(crate) fn has_totals(self) -> bool {
                match self { $( Self::$kind => <$module::$kind>::TOTALS, )* }
            }

            pub(crate) fn read(self, fields: &mut Fields, unit: Unit, log: &mut Log) -> Option<Kind> {
                match self { $( Self::$kind => LayerFields::read(fields, unit, log).map(Kind::$kind), )* }
            }
        }

        impl Kind {
            /// Whether a layer of this kind acts on the whole screen if it has no region.
            pub(crate) fn fills_screen(&self) -> bool {
                match self { $( Self::$kind(kind) => LayerFields::fills_screen(kind), )* }
            }

            /// The value of `kind`.
            pub(crate) fn word(&self) -> &'static str {
                match self { $( Self::$kind(_) => <$module::$kind as LayerFields>::WORD, )* }
            }

            /// Name of the field that sets the largest or the least friction of a record's layer.
            pub(crate) fn extreme(&self, most: bool, places: &Places, record: &RecordLayer) -> &'static str {
                match self { $( Self::$kind(kind) => LayerFields::extreme(kind, most, places, record), )* }
            }

            /// The fields that a click of the record's layer is added to; `None` without clicks.
            pub(crate) fn clicked(&self, places: &Places, record: &RecordLayer) -> Option<Clicked> {
                match self { $( Self::$kind(kind) => LayerFields::clicked(kind, places, record), )* }
            }

            /// Moves the places in the kind's own fields.
            pub(crate) fn move_by(&mut self, x_mm: f64, y_mm: f64) {
                match self { $( Self::$kind(kind) => LayerFields::move_by(kind, x_mm, y_mm), )* }
            }

            /// Compiles the layer to a record. Returns `None` after a mistake, which has been logged.
            pub(crate) fn lower(&self, layer: &Layer, lowering: &mut Lowering) -> Option<Lowered> {
                match self { $( Self::$kind(kind) => LayerFields::lower(kind, layer, lowering), )* }
            }
        }

        /// The reference of a record's layer.
        pub(crate) fn field(layer: &RecordLayer, region: RecordRegion, program: &Program) -> Arc<dyn Field> {
            match layer {
                $( RecordLayer::$kind(layer) => IntoField::field(layer, region, program), )*
            }
        }

        /// A record without place and rotation: identical for a layer and its copies.
        pub fn without_place(layer: RecordLayer) -> RecordLayer {
            match layer {
                $( RecordLayer::$kind(layer) => RecordLayer::$kind(IntoField::without_place(layer)), )*
            }
        }
    };
}

kinds! {
    Constant in constant,
    Grating in grating,
    Bitmap in bitmap,
    Noise in noise,
    Edge in edge,
    Button in button,
    Vibration in vibration,
    Speed in speed,
    Stream in stream,
    Rings in rings,
    Spokes in spokes,
    Direction in direction,
}
