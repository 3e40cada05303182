//! Errors in a scene, with sentences that state the value found, the expected value and the remedy.

use core::fmt;

use postcard::experimental::max_size::MaxSize;
use serde::{Deserialize, Serialize};

use super::{CURVE_POINTS_MAX, POINTS_MAX, POLYGON_POINTS_MAX, RECORDS_MAX};

/// Why bytes are not a valid scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, MaxSize)]
pub enum SceneError {
    /// The layout version is not the supported one.
    Version {
        /// The value found.
        found: u16,
    },
    /// The length does not match the numbers of records and points in the header.
    Length {
        /// The value found.
        found: u32,
        /// Length that follows from the header.
        expected: u32,
    },
    /// The carrier's shape is unknown.
    UnknownCarrier(u8),
    /// The kind of a record is unknown.
    UnknownKind {
        /// Number of the record, from zero.
        record: u8,
        /// Its kind.
        kind: u8,
    },
    /// The region, blend or form of a record is unknown.
    UnknownChoice {
        /// Number of the record, from zero.
        record: u8,
        /// Offset of the unknown byte in the record.
        offset: u8,
        /// The byte.
        value: u8,
    },
    /// More records than the layout ([`RECORDS_MAX`]) or the board allows.
    TooManyRecords {
        /// Number of records stated in the header.
        found: u8,
    },
    /// At least one of these header flags is unknown.
    UnknownFlags(u8),
    /// An unused byte of the header or of a record is not zero.
    NotZero {
        /// Number of the record, from zero; [`SceneError::HEADER`] for the header.
        record: u8,
        /// Offset of the byte in the header or record.
        offset: u8,
    },
    /// More points than the layout allows ([`POINTS_MAX`]).
    TooManyPoints {
        /// Number of points stated in the header.
        found: u8,
    },
    /// A polygon or a curve has too few or too many points, or refers to points outside the scene.
    Points {
        /// Number of the record, from zero.
        record: u8,
        /// Index of its first point, from zero.
        first: u8,
        /// Number of its points.
        count: u8,
    },
    /// The region of a button is neither a rectangle nor an ellipse.
    ButtonRegion {
        /// Number of the record, from zero.
        record: u8,
    },
}

impl SceneError {
    /// Record number that denotes the header.
    pub const HEADER: u8 = u8::MAX;
}

/// Sentences from the perspective of the side that reads the bytes: the board, if it refuses a scene.
impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Version { found } => write!(
                f,
                "a scene of layout version {found} cannot be read: use firmware and frixel command of one version"
            ),
            Self::Length { found, expected } => {
                write!(f, "the scene has {found} bytes where {expected} were expected: compile and upload it again")
            }
            Self::UnknownCarrier(shape) => write!(f, "carrier shape {shape} is not known: flash newer firmware"),
            Self::UnknownKind { record, kind } => {
                write!(f, "layer {record} (the first is 0) is of kind {kind}, which is not known: flash newer firmware")
            }
            Self::UnknownChoice { record, offset, value } => {
                let what = match offset {
                    1 => "region",
                    2 => "blend",
                    3 => "form",
                    _ => "byte",
                };
                write!(
                    f,
                    "layer {record} (the first is 0) has {what} {value}, which is not known: flash newer firmware"
                )
            }
            Self::TooManyRecords { found } => {
                write!(f, "the scene has {found} layers, more than the {RECORDS_MAX} that the board accepts: use fewer")
            }
            Self::TooManyPoints { found } => {
                write!(
                    f,
                    "the scene has {found} points, more than the {POINTS_MAX} allowed: draw its polygons with fewer \
                     vertices"
                )
            }
            Self::Points { record, first, count } => write!(
                f,
                "layer {record} (the first is 0) uses {count} points from point {first} on: a polygon has 3 to \
                 {POLYGON_POINTS_MAX} of the scene's points, a curve of speed 2 to {CURVE_POINTS_MAX}"
            ),
            Self::ButtonRegion { record } => {
                write!(
                    f,
                    "layer {record} (the first is 0) is a button: give it a rectangle or an ellipse as its region"
                )
            }
            Self::UnknownFlags(flags) => {
                write!(f, "the scene has flags {flags:#04x}, some of them unknown: flash newer firmware")
            }
            Self::NotZero { record, offset } => {
                match record {
                    Self::HEADER => f.write_str("the scene's header")?,
                    record => write!(f, "layer {record} (the first is 0)")?,
                }
                write!(
                    f,
                    " has byte {offset} set, which nothing uses: compile the scene again, or flash newer firmware"
                )
            }
        }
    }
}

impl core::error::Error for SceneError {}
