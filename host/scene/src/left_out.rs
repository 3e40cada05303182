//! What the compiler left out of a program, and why.

use thiserror::Error;

/// Something that a scene file has and that its program does without. Its text is a sentence for a person.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum LeftOut {
    /// A layer that another takes the place of wherever it acts.
    #[error("{layer} is left out: {by} takes its place everywhere")]
    Covered {
        /// The layer.
        layer: String,
        /// What covers it.
        by: String,
    },
    /// A layer that changes nothing.
    #[error("{layer} is left out: it changes nothing")]
    Idle {
        /// The layer.
        layer: String,
    },
    /// A layer that asks for the same everywhere and always.
    #[error("{layer} is played as a constant: it asks for the same everywhere")]
    Flat {
        /// The layer.
        layer: String,
    },
    /// A constant that was joined to the one below it.
    #[error("{layer} is left out: it is reckoned into {into}")]
    Folded {
        /// The layer.
        layer: String,
        /// The layer below it.
        into: String,
    },
    /// Part of a picture that nobody can find.
    #[error("{picture}: {whole} samples are cropped to the {kept} that can be found")]
    Cropped {
        /// The picture's file.
        picture: String,
        /// Samples of the whole picture.
        whole: usize,
        /// Samples that are kept.
        kept: usize,
    },
    /// A picture that is the same as another.
    #[error("{picture} is sent once for several layers: {bytes} bytes less")]
    Shared {
        /// The picture's file.
        picture: String,
        /// Its samples, a byte each.
        bytes: usize,
    },
    /// A picture that no layer needs any more.
    #[error("a picture of {bytes} bytes is left out: no layer that is left shows it")]
    Bitmap {
        /// Its samples, a byte each.
        bytes: usize,
    },
}
