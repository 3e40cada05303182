//! How a check ends that does not fail.

use std::env;

/// Whether a check ran completely.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All of it ran, and passed.
    Passed,
    /// A part did not run, because a program that it needs is not installed. The rest passed.
    Skipped,
}

impl Outcome {
    /// The outcome of two checks together.
    pub(crate) fn and(self, other: Self) -> Self {
        if self == Self::Passed { other } else { Self::Skipped }
    }
}

/// Skips a check because of `missing`, which says what to install. In continuous integration this is a failure.
pub(crate) fn skip(check: &str, missing: String) -> Result<Outcome, String> {
    if is_ci() {
        return Err(missing);
    }
    eprintln!("SKIPPED: {check}: {missing}");
    Ok(Outcome::Skipped)
}

pub(crate) fn is_ci() -> bool {
    env::var_os("CI").is_some_and(|ci| !ci.is_empty() && ci != "false" && ci != "0")
}
