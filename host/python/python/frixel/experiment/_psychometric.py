"""The psychometric function, tasks, and the grid of its parameters."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Task:
    """What a person is asked, and what one who feels nothing answers."""

    name: str
    guess_rates: tuple[float, ...]
    """Shares of "correct" at level 0: one where the design fixes it, or those that are possible, each as likely."""

    @property
    def is_guess_rate_known(self) -> bool:
        """Whether the design fixes the guess rate. Where it does not, trials at level 0 are needed."""
        return len(self.guess_rates) == 1


TWO_ALTERNATIVES = Task("2afc", (0.5,))
"""Two presentations, of which the person names the stronger one."""

SAME_DIFFERENT = Task("same-different", (0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5))
"""Two presentations; "different" counts as correct, also at level 0, where its share is the false alarms."""


def weibull(level: ArrayLike, threshold: ArrayLike, slope: ArrayLike, guess: ArrayLike, lapse: ArrayLike) -> Array:
    """Share of correct answers: ``guess + (1 - guess - lapse) (1 - exp(-(level / threshold) ** slope))``.

    At the threshold, a person without lapses is 1 - 1/e of the way from guessing to always being right: 81.6 % correct
    in a task of two alternatives (Watson and Pelli 1983, doi:10.3758/BF03202828).
    """
    level, threshold, slope, guess, lapse = (
        np.asarray(value, dtype=np.float64) for value in (level, threshold, slope, guess, lapse)
    )
    felt = -np.expm1(-((level / threshold) ** slope))
    return np.asarray(guess + (1.0 - guess - lapse) * felt, dtype=np.float64)


def _thresholds() -> Array:
    return np.geomspace(0.002, 3.0, 81)


def _slopes() -> Array:
    return np.geomspace(0.8, 3.0, 8)


def _lapses() -> Array:
    return np.array([0.0, 0.01, 0.02, 0.03])


@dataclass(frozen=True)
class Grid:
    """The parameters that an estimate considers, each combination as likely as any other before the first answer.

    Thresholds are levels; their default, 0.002 to 3, holds everything that is published of friction and steps of 10 %.
    The answers of an observer whose sensitivity is in proportion to the difference have a slope of 1.3; the default is
    0.8 to 3, with lapses up to 3 %.
    """

    thresholds: Array = field(default_factory=_thresholds)
    slopes: Array = field(default_factory=_slopes)
    lapses: Array = field(default_factory=_lapses)

    def correct(self, level: float, task: Task) -> Array:
        """Share of correct answers at a level, for every combination: (thresholds, slopes, lapses, guess rates)."""
        return weibull(
            level,
            self.thresholds[:, None, None, None],
            self.slopes[None, :, None, None],
            np.asarray(task.guess_rates)[None, None, None, :],
            self.lapses[None, None, :, None],
        )
