//! What a page without a figure of counts says instead.

use crate::report::counts::Counts;

/// Whether the page has a figure of what something takes on a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Boards {
    Shown,
    NotInTheFile,
    NoFile,
}

impl Boards {
    /// `shown` is the figure; it is `None` when the file lacks the counts for it.
    pub(super) fn new<T>(shown: Option<&T>, counts: Option<&Counts>) -> Self {
        match (shown, counts) {
            (Some(_), _) => Self::Shown,
            (None, Some(_)) => Self::NotInTheFile,
            (None, None) => Self::NoFile,
        }
    }

    /// For the caption of the figure behind; `what` takes something on a board.
    pub(super) fn sentence(self, what: &str) -> String {
        match self {
            Self::Shown => format!("What {what} takes on a board is in the figure before this one."),
            Self::NotInTheFile => format!(
                "What {what} takes on a board is not shown: the file given with --bench has no count of one. cargo \
                 xtask bench writes a file that has, target/bench/bench.json."
            ),
            Self::NoFile => format!(
                "What {what} takes on a board is not shown: this page was made without --bench. cargo xtask bench \
                 counts it, and frixel report --bench target/bench/bench.json shows it."
            ),
        }
    }
}
