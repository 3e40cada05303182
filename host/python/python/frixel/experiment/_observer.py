"""A simulated observer, whose threshold is known."""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np

from ._psychometric import SAME_DIFFERENT, Task


class Observer:
    """Compares the logarithms of two frictions, each with internal noise, and lapses.

    ``noise`` is the standard deviation of one felt ln(friction), ``lapse`` the share of trials that are answered
    without attention, ``criterion`` the difference of ln(friction), in units of its noise, from which the observer says
    "different". An observer of infinite noise guesses.
    """

    def __init__(self, noise: float, *, lapse: float = 0.02, criterion: float = 1.5, seed: int = 0) -> None:
        if not (noise > 0.0 and 0.0 <= lapse < 1.0 and criterion >= 0.0):
            raise ValueError("an observer has noise above 0, a lapse rate from 0 to 1, and a criterion from 0")
        self._noise, self._lapse, self._criterion = noise, lapse, criterion
        self._rng = np.random.default_rng(seed)

    def stronger(self, first_n: float, second_n: float) -> int:
        """Which of two felt frictions, in any one unit, the observer calls the stronger one: 0 or 1."""
        if self._rng.random() < self._lapse:
            return int(self._rng.integers(2))
        felt = np.log([first_n, second_n]) + self._rng.normal(0.0, self._noise, 2)
        return int(felt[1] > felt[0])

    def answers(self, level: float, task: Task) -> bool:
        """Whether the answer to a trial at a level counts as correct."""
        if self._rng.random() < self._lapse:
            return bool(self._rng.random() < 0.5)
        return bool(self._rng.random() < self.correct_share(level, task))

    def correct_share(self, level: float, task: Task) -> float:
        """Share of correct answers at a level, without lapses."""
        signal = math.log1p(level) / (math.sqrt(2.0) * self._noise) if math.isfinite(self._noise) else 0.0
        normal = NormalDist()
        if task == SAME_DIFFERENT:
            return normal.cdf(signal - self._criterion) + normal.cdf(-signal - self._criterion)
        return normal.cdf(signal)

    def threshold(self, task: Task) -> float:
        """The level that is 1 - 1/e of the way from guessing to always right: what an estimate should find."""
        guess = self.correct_share(0.0, task)
        wanted = guess + (1.0 - guess) * -math.expm1(-1.0)
        low, high = 1e-6, 1e6
        for _ in range(200):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if self.correct_share(middle, task) < wanted else (low, middle)
        return middle
