"""A simulated observer with a known threshold."""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np

from .._arguments import number, positive, real, refusal, whole
from ._psychometric import SAME_DIFFERENT, Task, checked_level, checked_task


class Observer:
    """Compares the logarithms of two frictions, each with internal noise, and lapses.

    ``noise`` is the standard deviation of one felt ln(friction), ``lapse`` the share of trials that are answered
    without attention, ``criterion`` the difference of ln(friction), in units of its noise, from which the observer
    answers "different". An observer with infinite noise guesses.

    By default, the noise of an answer depends on the number of answers before it. In a session that may be resumed,
    give the number of the ``trial``: its noise then depends on that number only.
    """

    def __init__(self, noise: float, *, lapse: float = 0.02, criterion: float = 1.5, seed: int = 0) -> None:
        expected = "above 0 and at most 1 (0.06 is 6 %), or infinite"
        self._noise = real("noise", noise, expected)
        if not (0.0 < self._noise <= 1.0 or self._noise == math.inf):
            raise refusal("noise", expected, noise)
        self._lapse = number("lapse", lapse, 0.0, 0.99)
        self._criterion = number("criterion", criterion, 0.0, 100.0)
        self._seed = whole("seed", seed, 0)
        self._rng = np.random.default_rng(self._seed)

    def stronger(self, first_n: float, second_n: float, *, trial: int | None = None) -> int:
        """Index, 0 or 1, of the friction that the observer calls stronger, of two in any one unit."""
        frictions = [positive(name, value) for name, value in (("first_n", first_n), ("second_n", second_n))]
        rng = self._noise_of(trial)
        if rng.random() < self._lapse:
            return int(rng.integers(2))
        felt = np.log(frictions) + rng.normal(0.0, self._noise, 2)
        return int(felt[1] > felt[0])

    def answers(self, level: float, task: Task, *, trial: int | None = None) -> bool:
        """Whether the answer to a trial at a level counts as correct."""
        rng = self._noise_of(trial)
        if rng.random() < self._lapse:
            return bool(rng.random() < 0.5)
        return bool(rng.random() < self.correct_share(level, task))

    def _noise_of(self, trial: int | None) -> np.random.Generator:
        return self._rng if trial is None else np.random.default_rng([self._seed, whole("trial", trial, 0)])

    def correct_share(self, level: float, task: Task) -> float:
        """Share of correct answers at a level, without lapses."""
        level = checked_level(level)
        signal = math.log1p(level) / (math.sqrt(2.0) * self._noise) if math.isfinite(self._noise) else 0.0
        return self._share(signal, checked_task(task))

    def _share(self, signal: float, task: Task) -> float:
        """Share of correct answers for a difference of ln(friction), in units of its noise."""
        normal = NormalDist()
        if task == SAME_DIFFERENT:
            return normal.cdf(signal - self._criterion) + normal.cdf(-signal - self._criterion)
        return normal.cdf(signal)

    def threshold(self, task: Task) -> float:
        """The level that is 1 - 1/e of the way from guessing to always right, which an estimate should find."""
        guess = self._share(0.0, checked_task(task))
        target = guess + (1.0 - guess) * -math.expm1(-1.0)
        low, high = 0.0, 200.0
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._share(middle, task) < target else (low, middle)
        difference = middle * math.sqrt(2.0) * self._noise
        # Beyond this, the level would overflow.
        return math.expm1(difference) if difference < 700.0 else math.inf
