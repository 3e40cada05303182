//! Declares each parameter of a kind of layer once, with its type, its offset in the record, its accepted range, and
//! its meaning.

use frixel_wire::bytes::{get_at, put_at};
use frixel_wire::message::{ConfigField, ConfigRefusal};

use crate::layout::{FORM_AT, RecordBytes};

/// A form byte that is unknown to its kind of layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct UnknownForm(pub(crate) u8);

/// A type that a parameter can have.
pub(crate) trait Parameter: Sized {
    /// Bytes of the parameter in a record, without the form byte.
    const LEN: usize;

    /// Reads the parameter at an offset of a record.
    fn read(record: &RecordBytes, offset: usize) -> Result<Self, UnknownForm>;

    /// Writes the parameter at an offset of a record.
    fn write(&self, record: &mut RecordBytes, offset: usize);

    /// Checks the ranges that belong to the type; `layer` is the layer number for a refusal.
    fn check(&self, layer: u8) -> Result<(), ConfigRefusal> {
        let _ = layer;
        Ok(())
    }
}

/// Parameters of a kind; implemented by [`parameters!`].
pub(crate) trait Parameters: Sized {
    /// Name, offset and length of each.
    #[cfg(test)]
    const LAYOUT: &[(&str, usize, usize)];

    /// Reads them from a record.
    fn read(record: &RecordBytes) -> Result<Self, UnknownForm>;

    /// Writes them to a record.
    fn write(&self, record: &mut RecordBytes);

    /// Checks the range of each; `layer` is the layer number for a refusal.
    fn check(&self, layer: u8) -> Result<(), ConfigRefusal>;
}

/// Declares the parameters of a kind of layer as `name: type = offset in range`, below a doc comment. The range is a
/// [`Range`] for parameters of type `f32`; other types have their own.
macro_rules! parameters {
    (
        $(#[$meta:meta])*
        pub struct $kind:ident {
            $( $(#[$parameter_meta:meta])* $parameter:ident: $type:ty = $offset:literal $(in $range:expr)?, )*
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $kind {
            $( $(#[$parameter_meta])* pub $parameter: $type, )*
        }

        $( const _: () = assert!(
            $offset + <$type as $crate::parameters::Parameter>::LEN <= $crate::layout::RECORD_LEN,
            "the parameter lies outside the record"
        ); )*

        impl $crate::parameters::Parameters for $kind {
            #[cfg(test)]
            const LAYOUT: &[(&str, usize, usize)] = &[
                $( (stringify!($parameter), $offset, <$type as $crate::parameters::Parameter>::LEN), )*
            ];

            fn read(
                record: &$crate::layout::RecordBytes,
            ) -> Result<Self, $crate::parameters::UnknownForm> {
                Ok(Self { $( $parameter: $crate::parameters::Parameter::read(record, $offset)?, )* })
            }

            fn write(&self, record: &mut $crate::layout::RecordBytes) {
                $( $crate::parameters::Parameter::write(&self.$parameter, record, $offset); )*
            }

            fn check(&self, layer: u8) -> Result<(), ::frixel_wire::message::ConfigRefusal> {
                $(
                    $crate::parameters::Parameter::check(&self.$parameter, layer)?;
                    $( $range.check(self.$parameter, layer)?; )?
                )*
                Ok(())
            }
        }
    };
}
pub(crate) use parameters;

impl Parameter for f32 {
    const LEN: usize = 4;

    fn read(record: &RecordBytes, offset: usize) -> Result<Self, UnknownForm> {
        Ok(Self::from_le_bytes(get_at(record, offset)))
    }

    fn write(&self, record: &mut RecordBytes, offset: usize) {
        put_at(record, offset, self.to_le_bytes());
    }
}

impl Parameter for u32 {
    const LEN: usize = 4;

    fn read(record: &RecordBytes, offset: usize) -> Result<Self, UnknownForm> {
        Ok(Self::from_le_bytes(get_at(record, offset)))
    }

    fn write(&self, record: &mut RecordBytes, offset: usize) {
        put_at(record, offset, self.to_le_bytes());
    }
}

impl Parameter for u8 {
    const LEN: usize = 1;

    fn read(record: &RecordBytes, offset: usize) -> Result<Self, UnknownForm> {
        let [byte] = get_at(record, offset);
        Ok(byte)
    }

    fn write(&self, record: &mut RecordBytes, offset: usize) {
        put_at(record, offset, [*self]);
    }
}

/// A form byte of 0 or 1.
impl Parameter for bool {
    const LEN: usize = 1;

    fn read(record: &RecordBytes, _offset: usize) -> Result<Self, UnknownForm> {
        match form(record) {
            0 => Ok(false),
            1 => Ok(true),
            other => Err(UnknownForm(other)),
        }
    }

    fn write(&self, record: &mut RecordBytes, _offset: usize) {
        put_form(record, u8::from(*self));
    }
}

/// The form byte of a record: a choice between a few forms of the kind.
pub(crate) fn form(record: &RecordBytes) -> u8 {
    let [form] = get_at(record, FORM_AT);
    form
}

/// Writes the form byte of a record.
pub(crate) fn put_form(record: &mut RecordBytes, form: u8) {
    put_at(record, FORM_AT, [form]);
}

/// The accepted range of a parameter. A number outside is refused, never silently clamped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Name of the parameter in a refusal.
    pub field: ConfigField,
    /// Least number.
    pub min: f64,
    /// Largest number.
    pub max: f64,
}

impl Range {
    const fn new(field: ConfigField, min: f64, max: f64) -> Self {
        Self { field, min, max }
    }

    /// Refuses a number outside the range, or NaN; `layer` is the layer number for the refusal.
    // Every range is a constant: if inlined, the compiler converts its limits to `f32` instead of the processor, which
    // has no `f64`.
    #[allow(clippy::inline_always, reason = "a call would convert both limits in software")]
    #[inline(always)]
    pub fn check(&self, found: f32, layer: u8) -> Result<(), ConfigRefusal> {
        within(self.field, found, self.min as f32, self.max as f32, layer)
    }

    /// The same range for another parameter.
    pub(crate) const fn named(self, field: ConfigField) -> Self {
        Self { field, ..self }
    }
}

/// Accepts a number from `min` to `max`, and refuses NaN; `layer` is the layer number for the refusal.
// Not inlined, since nearly every check calls it.
#[inline(never)]
pub fn within(field: ConfigField, found: f32, min: f32, max: f32, layer: u8) -> Result<(), ConfigRefusal> {
    if found >= min && found <= max { Ok(()) } else { Err(ConfigRefusal { field, found, min, max, layer }) }
}

/// The ranges of layers that boards accept, in SI units. The host's compiler uses the same ranges.
pub mod range {
    use frixel_wire::message::{ConfigField, GAIN_MAX};

    use super::Range;

    /// Largest distance from the screen's corner along an axis, m.
    pub const LENGTH_MAX_M: f64 = 2.0;
    /// Largest wave number of stripes and noise, cycles per metre.
    const CYCLES_PER_M_MAX: f64 = 2e4;

    /// Gain of a layer.
    pub const GAIN: Range = Range::new(ConfigField::Gain, -GAIN_MAX, GAIN_MAX);
    /// Electric friction in a layer's parameters, N; or a factor.
    pub const FRICTION_N: Range = Range::new(ConfigField::Friction, -100.0, 100.0);
    /// Left or top end of a region, m.
    pub const REGION_PLACE_M: Range = Range::new(ConfigField::Region, -LENGTH_MAX_M, LENGTH_MAX_M);
    /// Width or height of a region, m. Its inverse is finite, and a rectangle is at least one step wide.
    pub const REGION_SIZE_M: Range = Range::new(ConfigField::Region, 4e-9, LENGTH_MAX_M);
    /// Coordinate of a polygon's vertex, m.
    pub const VERTEX_M: Range = REGION_PLACE_M.named(ConfigField::Vertex);
    /// Cycles per metre along an axis.
    pub const CYCLES_PER_M: Range = Range::new(ConfigField::WaveVector, -CYCLES_PER_M_MAX, CYCLES_PER_M_MAX);
    /// Phase, turns.
    pub const PHASE_TURNS: Range = Range::new(ConfigField::Phase, -1000.0, 1000.0);
    /// Fraction of a turn in which a square wave is high.
    pub const DUTY: Range = Range::new(ConfigField::Duty, 0.01, 0.99);
    /// Angle, turns.
    pub const ANGLE_TURNS: Range = Range::new(ConfigField::Angle, -1.0, 1.0);
    /// Corner of a bitmap, m.
    pub const BITMAP_PLACE_M: Range = REGION_PLACE_M.named(ConfigField::BitmapPlacement);
    /// Spacing of a bitmap's samples, m.
    pub const PITCH_M: Range = Range::new(ConfigField::BitmapPlacement, 1e-5, 0.1);
    /// Wavelength, m.
    pub const WAVELENGTH_M: Range = Range::new(ConfigField::Wavelength, 1.0 / CYCLES_PER_M_MAX, LENGTH_MAX_M);
    /// Place of a line, m.
    pub const SHAPE_PLACE_M: Range = REGION_PLACE_M.named(ConfigField::Shape);
    /// Width of a ridge or a rim, m.
    pub const SHAPE_WIDTH_M: Range = Range::new(ConfigField::Shape, 1e-5, LENGTH_MAX_M);
    /// Decay of a click, s.
    pub const CLICK_S: Range = Range::new(ConfigField::Duration, 0.0, 1.0);
    /// Period of a burst, s.
    pub const BURST_S: Range = Range::new(ConfigField::Duration, 0.0, 60.0);
    /// Frequency of a vibration, Hz.
    pub const FREQUENCY_HZ: Range = Range::new(ConfigField::VibrationFrequency, 0.01, 1000.0);
    /// Frequency at which the waves of a moving grating or moving rings pass a place, Hz.
    pub const DRIFT_HZ: Range = Range::new(ConfigField::VibrationFrequency, -1000.0, 1000.0);
    /// Sliding speed of a curve's point, m/s.
    pub const SPEED_M_PER_S: Range = Range::new(ConfigField::CurveSpeed, 0.0, 10.0);
    /// Smallest spacing of a curve's speeds, m/s.
    pub const SPEED_STEP_MIN_M_PER_S: f64 = 1e-5;
}
