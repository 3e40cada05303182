"""The psychometric function, tasks, and the grid of its parameters."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._arguments import array, each, number, refusal, text

Array = NDArray[np.float64]

LEVEL_MIN = 1e-100
"""Smallest level above 0, in any unit."""
LEVEL_MAX = 1e100
"""Largest level, in any unit."""
BEYOND_LEVELS = 10.0
"""Factor by which the sought thresholds extend beyond the smallest and the largest level."""
STEP = 0.09
"""Step of ln(threshold)."""


@dataclass(frozen=True)
class Task:
    """The question of a trial, with its guess rate."""

    name: str
    guess_rates: tuple[float, ...]
    """Shares of "correct" at level 0: one share if the design fixes it, or all possible ones, equally likely."""

    def __post_init__(self) -> None:
        text("name", self.name)
        rates = tuple(number("a guess rate", rate, 0.0, 1.0) for rate in each("guess_rates", self.guess_rates))
        if not rates:
            raise refusal("guess_rates", "one share or more", self.guess_rates)
        object.__setattr__(self, "guess_rates", rates)

    @property
    def is_guess_rate_known(self) -> bool:
        """Whether the design fixes the guess rate. If not, trials at level 0 are needed."""
        return len(self.guess_rates) == 1


TWO_ALTERNATIVES = Task("2afc", (0.5,))
"""Two presentations; the person names the stronger one."""

SAME_DIFFERENT = Task("same-different", (0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5))
"""Two presentations; "different" counts as correct, also at level 0, where its share is the false-alarm rate."""


def checked_level(level: object) -> float:
    """A level: 0, or a number that leaves room for a grid around it."""
    found = number("level", level, 0.0, LEVEL_MAX)
    if 0.0 < found < LEVEL_MIN:
        raise refusal("level", f"0, or a number from {LEVEL_MIN:g} to {LEVEL_MAX:g}", level)
    return found


def checked_task(task: object) -> Task:
    """A task."""
    if not isinstance(task, Task):
        raise refusal("a task", "TWO_ALTERNATIVES or SAME_DIFFERENT", task)
    return task


def checked_grid(grid: object) -> Grid:
    """A grid."""
    if not isinstance(grid, Grid):
        raise refusal("grid", "a Grid", grid)
    return grid


def weibull(level: ArrayLike, threshold: ArrayLike, slope: ArrayLike, guess: ArrayLike, lapse: ArrayLike) -> Array:
    """Share of correct answers: ``guess + (1 - guess - lapse) (1 - exp(-(level / threshold) ** slope))``.

    At the threshold, a person without lapses is 1 - 1/e of the way from guessing to always being right: 81.6 % correct
    in a task of two alternatives (Watson and Pelli 1983, doi:10.3758/BF03202828).
    """
    level, threshold, slope, guess, lapse = (
        np.asarray(value, dtype=np.float64) for value in (level, threshold, slope, guess, lapse)
    )
    with np.errstate(over="ignore"):
        felt = -np.expm1(-((level / threshold) ** slope))
    return np.asarray(guess + (1.0 - guess - lapse) * felt, dtype=np.float64)


def _slopes() -> Array:
    return np.geomspace(0.8, 3.0, 8)


def _lapses() -> Array:
    return np.array([0.0, 0.01, 0.02, 0.03])


@dataclass(frozen=True)
class Grid:
    """The parameters of an estimate, with a uniform prior over their combinations.

    Thresholds are in the unit of the levels. An observer whose sensitivity is proportional to the difference has a
    slope of 1.3; the default is 0.8 to 3, with lapses up to 3 %.
    """

    thresholds: Array
    slopes: Array = field(default_factory=_slopes)
    lapses: Array = field(default_factory=_lapses)

    def __post_init__(self) -> None:
        limits = {
            "thresholds": (LEVEL_MIN / BEYOND_LEVELS, LEVEL_MAX * BEYOND_LEVELS),
            "slopes": (0.01, 100.0),
            "lapses": (0.0, 0.99),
        }
        for name, (least, most) in limits.items():
            values = array(name, getattr(self, name))
            is_rising = values.ndim == 1 and values.size > 0 and bool((np.diff(values) > 0).all())
            if not (is_rising and least <= values[0] and values[-1] <= most):
                raise refusal(name, f"numbers from {least:g} to {most:g} in rising order", getattr(self, name))
            object.__setattr__(self, name, values)

    @classmethod
    def around(cls, levels: Iterable[float]) -> Grid:
        """The grid for these levels: thresholds from a tenth of the smallest above 0 to ten times the largest."""
        felt = [found for found in (checked_level(level) for level in each("levels", levels)) if found > 0.0] or [1.0]
        least, most = min(felt) / BEYOND_LEVELS, max(felt) * BEYOND_LEVELS
        return cls(np.geomspace(least, most, math.ceil(math.log(most / least) / STEP) + 1))

    def correct(self, level: float, task: Task) -> Array:
        """Share of correct answers at a level, for every combination: (thresholds, slopes, lapses, guess rates)."""
        level, task = checked_level(level), checked_task(task)
        return weibull(
            level,
            self.thresholds[:, None, None, None],
            self.slopes[None, :, None, None],
            np.asarray(task.guess_rates)[None, None, None, :],
            self.lapses[None, None, :, None],
        )
