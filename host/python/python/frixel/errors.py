"""What goes wrong, as one family of exceptions."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from operator import index

__all__ = ["FitError", "FrixelError", "Mistake", "ParameterError", "PlayError", "SceneError"]


class FrixelError(Exception):
    """Base of every exception of this package."""


class ParameterError(FrixelError, ValueError):
    """A value that is not taken: the message says what was found, and what is expected."""


def whole(name: str, value: object, least: int, most: int = 2**64 - 1) -> int:
    """A whole number from `least` to `most`; `name` is what the message calls it."""
    try:
        number = index(value)  # type: ignore[arg-type]
    except TypeError:
        number = None
    if number is None or not least <= number <= most:
        raise ParameterError(f"{name} is a whole number from {least} to {most}, found {value!r}")
    return number


def number(name: str, value: object, least: float, most: float) -> float:
    """A number from `least` to `most`; `name` is what the message calls it."""
    try:
        found = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        found = math.nan
    if not least <= found <= most:
        limits = f"from {least:g} to {most:g}" if math.isfinite(most) else f"of at least {least:g}"
        raise ParameterError(f"{name} is a number {limits}, found {value!r}")
    return found


def participant_code(value: object) -> str:
    """The code of a participant, by the rule of `frixel play --participant`."""
    if not (isinstance(value, str) and re.fullmatch(r"[A-Za-z0-9_.-]{1,32}", value)):
        raise ParameterError(f"participant {value!r}: give a code of 1 to 32 letters, digits, -, _ and ., and no name")
    return value


class FitError(FrixelError, ValueError):
    """Measured friction does not give a finger: the message says why, and what to measure."""


class PlayError(FrixelError):
    """A board, simulated or not, does not take a scene, or stopped while it played."""


@dataclass(frozen=True)
class Mistake:
    """One mistake in a scene, or in a file that it names."""

    file: str
    """The file, as messages call it."""
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
    """A scene has mistakes, or cannot be read. The message has a line for each mistake.

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
