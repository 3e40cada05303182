//! The caption sentence about the cost on a board.

/// Whether the page has a figure of a cost on a board, and if not, why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BoardCostFigure {
    Shown,
    NotInTheFile,
}

impl BoardCostFigure {
    /// Says whether the figure is shown.
    pub(super) fn new<T>(shown: Option<&T>) -> Self {
        if shown.is_some() { Self::Shown } else { Self::NotInTheFile }
    }

    /// A sentence for the caption of the following figure. `what` names the operation whose cost is meant.
    pub(super) fn sentence(self, what: &str) -> String {
        match self {
            Self::Shown => format!("What {what} takes on a board is in the figure before this one."),
            Self::NotInTheFile => format!(
                "What {what} takes on a board is not shown: the file given with --bench has no count of one. cargo \
                 xtask bench writes a file that has, target/bench/bench.json."
            ),
        }
    }
}
