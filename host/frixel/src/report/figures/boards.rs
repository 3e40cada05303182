//! The caption sentence about the cost on a board.

use crate::report::counts::Counts;

/// Whether the page has a figure of a cost on a board, and if not, why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BoardCostFigure {
    Shown,
    NotInTheFile,
    NoFile,
}

impl BoardCostFigure {
    /// Says whether the figure is shown, or why not: `shown` is the figure, `counts` the file of counts, if there is
    /// one.
    pub(super) fn new<T>(shown: Option<&T>, counts: Option<&Counts>) -> Self {
        match (shown, counts) {
            (Some(_), _) => Self::Shown,
            (None, Some(_)) => Self::NotInTheFile,
            (None, None) => Self::NoFile,
        }
    }

    /// A sentence for the caption of the following figure. `what` names the operation whose cost is meant.
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
