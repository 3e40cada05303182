//! Fingers, screens and touch sources: bundled ones by their names, others by the texts of their files.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::compile_error::CompileError;
use super::file_kind::FileKind;
use super::nearest::Nearest;
use super::printable::brief;

/// A finger, a screen or a touch source.
///
/// ```
/// use frixel_scene::{FingerProfile, Profile};
///
/// assert_eq!(FingerProfile::bundled_names()[0], "example");
/// assert_eq!(FingerProfile::bundled("example"), Some(FingerProfile::example()));
/// assert!(FingerProfile::parse("radius = 8", "mine.toml").is_err());
/// ```
pub trait Profile: Sized {
    /// The kind of its file.
    const KIND: FileKind;

    /// The names of the bundled ones, the default first.
    fn bundled_names() -> Vec<&'static str>;

    /// The bundled one of a name.
    fn bundled(name: &str) -> Option<Self>;

    /// Reads the text or the bytes of a file. Messages call the file `name`.
    fn parse(text: impl AsRef<[u8]>, name: &str) -> Result<Self, CompileError>;
}

/// A profile as users name it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NamedProfile {
    /// Name of a bundled one, or of its file.
    pub name: String,
    /// Text of its file; absent for a bundled one.
    pub text: Option<String>,
}

/// Why a name or a file is not a profile.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ProfileError {
    /// None is bundled under this name.
    #[error("no bundled {kind} is named `{}`: {}", brief(.name), advice(.nearest))]
    NotBundled {
        /// Its kind in messages.
        kind: &'static str,
        /// The name.
        name: String,
        /// The names of the bundled ones, and the nearest of them.
        nearest: Nearest,
    },
    /// The file has mistakes.
    #[error(transparent)]
    Mistakes(#[from] CompileError),
}

fn advice(nearest: &Nearest) -> String {
    match &nearest.suggestion {
        Some(suggestion) => format!("did you mean `{suggestion}`?"),
        None if nearest.known.len() == 1 => format!("the bundled one is {}", nearest.known.join("")),
        None => format!("the bundled ones are {}", nearest.known.join(", ")),
    }
}

impl NamedProfile {
    /// The profile.
    pub fn read<P: Profile>(&self) -> Result<P, ProfileError> {
        let Self { name, text } = self;
        match text {
            Some(text) => Ok(P::parse(text, name)?),
            None => P::bundled(name).ok_or_else(|| ProfileError::NotBundled {
                kind: P::KIND.word(),
                name: name.clone(),
                nearest: Nearest::new(name, P::bundled_names()),
            }),
        }
    }
}
