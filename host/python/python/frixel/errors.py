"""The exceptions of this package."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

__all__ = [
    "ColumnError",
    "FitError",
    "FrixelError",
    "FrixelWarning",
    "Mistake",
    "ParameterError",
    "PlayError",
    "SceneError",
]


class FrixelError(Exception):
    """Base of every exception of this package."""


class ParameterError(FrixelError, ValueError):
    """A value that is not accepted: the message has what was found, and what was expected."""


class ColumnError(ParameterError, KeyError):
    """A recording has no column of this name; also a `KeyError`."""

    def __str__(self) -> str:
        return str(self.args[0])


class FrixelWarning(UserWarning):
    """A doubtful result: the message says why, and what to do."""


class FitError(FrixelError, ValueError):
    """Measured friction does not give a finger: the message says why, and what to measure."""


class PlayError(FrixelError):
    """A board, simulated or real, refuses a scene, or stopped while it played."""


@dataclass(frozen=True)
class Mistake:
    """One mistake in a scene, or in a file that it names."""

    file: str
    """Name of the file in messages."""
    line: int
    """Line, from 1."""
    column: int
    """Column in characters, from 1."""
    text: str
    """The text at that position; empty at the end of the file."""
    nearest: str | None
    """The valid name nearest to an unknown one, if one is near."""
    message: str
    """What was found, what is expected, and what to do."""


class SceneError(FrixelError, ValueError):
    """A scene has mistakes, or cannot be read. The message has one line per mistake.

    Attributes
    ----------
    mistakes
        All mistakes, at most 100, in the order of the file; empty if the file cannot be read.
    """

    mistakes: Sequence[Mistake]

    def __init__(self, message: str, mistakes: Sequence[Mistake] = ()) -> None:
        super().__init__(message, mistakes)
        self.mistakes = list(mistakes)

    def __str__(self) -> str:
        return str(self.args[0])

    @property
    def line(self) -> int | None:
        """Line of the first mistake, from 1."""
        return self.mistakes[0].line if self.mistakes else None

    @property
    def column(self) -> int | None:
        """Column of the first mistake in characters, from 1."""
        return self.mistakes[0].column if self.mistakes else None
