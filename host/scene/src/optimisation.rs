//! Optimisations made by the compiler, with the reason for each.

use thiserror::Error;

/// A part of the scene file that its program does not need. It displays as a sentence.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub(crate) enum Optimisation {
    /// A layer that another layer replaces wherever it applies.
    #[error("{layer} is optimised away: {by} replaces it everywhere")]
    Covered { layer: String, by: String },
    /// A layer without effect.
    #[error("{layer} is optimised away: it changes nothing")]
    Idle { layer: String },
    /// A layer whose target friction is the same everywhere and at all times.
    #[error("{layer} is played as a constant: its friction is the same everywhere")]
    Flat { layer: String },
    /// A constant that was merged into the layer below it.
    #[error("{layer} is optimised away: it is merged into {into}")]
    Folded { layer: String, into: String },
    /// Part of a picture that lies outside its region or the screen.
    #[error("{picture}: {whole} samples are cropped to the {kept} inside its region and the screen")]
    Cropped { picture: String, whole: usize, kept: usize },
    /// A picture that is equal to another one.
    #[error("{picture} is sent once for several layers: {bytes} bytes less")]
    Shared { picture: String, bytes: usize },
    /// A picture that no remaining layer shows.
    #[error("a picture of {bytes} bytes is optimised away: no remaining layer shows it")]
    Bitmap { bytes: usize },
}
