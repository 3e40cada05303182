"""Methods that choose the level of each trial."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from .._arguments import array, flag, number, refusal, whole
from ._psychometric import LEVEL_MAX, LEVEL_MIN, Array, Grid, Task, checked_grid, checked_level, checked_task

TRIALS_MAX = 1_000_000
"""Largest number of trials of a method."""
LEVELS_MAX = 1000
"""Largest number of levels of a method."""


class Method(Protocol):
    """Chooses the level of each trial. The same answers lead to the same levels, so that a session can be resumed."""

    def next_level(self) -> float | None:
        """The level of the next trial; ``None`` after the last one."""

    def answer(self, level: float, correct: bool) -> None:
        """Takes the answer to a trial at a level."""


class ConstantStimuli:
    """Presents each level equally often: once per round, in a random order by seed."""

    def __init__(self, levels: ArrayLike, repetitions: int, *, seed: int = 0) -> None:
        one_round = _levels(levels)
        whole("repetitions", repetitions, 1, TRIALS_MAX // len(one_round))
        rng = np.random.default_rng(whole("seed", seed, 0))
        self._levels = [float(level) for _ in range(repetitions) for level in rng.permutation(one_round)]
        self._next = 0

    def next_level(self) -> float | None:
        """The level of the next trial; ``None`` after the last one."""
        return self._levels[self._next] if self._next < len(self._levels) else None

    def answer(self, level: float, correct: bool) -> None:
        """Takes the answer to a trial at a level."""
        checked_level(level), flag("correct", correct)
        self._next += 1


class UpDown:
    """A transformed staircase: a wrong answer raises the next level, ``down`` right answers in a row lower it.

    With ``down=2`` levels converge to 70.7 % correct, with 3 to 79.4 % (Levitt 1971, doi:10.1121/1.1912375). ``step``
    is the factor from level to level; it is squared until the first reversal. The staircase ends after ``trials``, and
    stays between ``least``, by default a 400th of ``start``, and ``largest``, by default four times ``start``.
    """

    def __init__(
        self,
        start: float,
        *,
        trials: int,
        down: int = 3,
        step: float = 1.25,
        least: float | None = None,
        largest: float | None = None,
    ) -> None:
        self._level = number("start", start, LEVEL_MIN, LEVEL_MAX)
        self._least = number("least", self._level / 400 if least is None else least, 0.0, self._level)
        self._largest = number("largest", 4 * self._level if largest is None else largest, self._level)
        self._left, self._down = whole("trials", trials, 1, TRIALS_MAX), whole("down", down, 1, TRIALS_MAX)
        self._step = number("step", step, 1.001, 1000.0)
        self._right_in_a_row = 0
        self._last_move = 0
        self._has_reversed = False

    def next_level(self) -> float | None:
        """The level of the next trial; ``None`` after the last one."""
        return self._level if self._left > 0 else None

    def answer(self, level: float, correct: bool) -> None:
        """Takes the answer to a trial at a level."""
        checked_level(level), flag("correct", correct)
        self._left -= 1
        self._right_in_a_row = self._right_in_a_row + 1 if correct else 0
        if not correct:
            self._move(1)
        elif self._right_in_a_row == self._down:
            self._right_in_a_row = 0
            self._move(-1)

    def _move(self, direction: int) -> None:
        self._has_reversed = self._has_reversed or self._last_move == -direction
        self._last_move = direction
        factor = self._step if self._has_reversed else self._step**2
        self._level = float(np.clip(self._level * factor**direction, self._least, self._largest))


class QuestPlus:
    """Chooses the level whose answer minimises the expected entropy (Watson 2017, doi:10.1167/17.3.10).

    ``levels`` can be presented, some tens at most. Ties are broken by the order of ``levels``. Without ``grid``,
    thresholds are sought from a tenth of the smallest level to ten times the largest.
    """

    def __init__(self, levels: ArrayLike, task: Task, *, trials: int, grid: Grid | None = None) -> None:
        self._levels = _levels(levels)
        self.task, self._grid = checked_task(task), Grid.around(self._levels) if grid is None else checked_grid(grid)
        self._left = whole("trials", trials, 1, TRIALS_MAX)
        self._correct = np.stack([self._grid.correct(level, task).ravel() for level in self._levels])
        self._wrong = 1.0 - self._correct
        # Terms of the entropy of an answer that are the same for every trial.
        self._correct_log = _times_log(self._correct)
        self._wrong_log = _times_log(self._wrong)
        self._posterior = np.full(self._correct.shape[1], 1.0 / self._correct.shape[1])

    @property
    def posterior(self) -> Array:
        """Probability of each combination of the grid's parameters, as :meth:`Grid.correct`."""
        return self._posterior.reshape(self._grid.correct(0.0, self.task).shape)

    def next_level(self) -> float | None:
        """The level of the next trial; ``None`` after the last one."""
        if self._left <= 0:
            return None
        return self._levels[int(np.argmax(self.expected_information()))]

    def expected_information(self) -> Array:
        """Expected information of an answer at each level about the parameters, in nats.

        This is the mutual information of answer and parameters: the expected reduction of the parameters' entropy.
        """
        right = self._correct @ self._posterior
        answer_entropy = -(_times_log(right) + _times_log(1.0 - right))
        given_parameters = -((self._correct_log + self._wrong_log) @ self._posterior)
        return np.asarray(answer_entropy - given_parameters, dtype=np.float64)

    def answer(self, level: float, correct: bool) -> None:
        """Takes the answer to a trial at one of the levels."""
        if level not in self._levels:
            raise refusal("level", "one of the method's levels", level)
        given = self._correct if flag("correct", correct) else self._wrong
        self._posterior = self._posterior * given[self._levels.index(level)]
        self._posterior /= self._posterior.sum()
        self._left -= 1


def _levels(levels: ArrayLike) -> list[float]:
    found = array("levels", levels)
    if found.ndim != 1 or not 1 <= found.size <= LEVELS_MAX:
        raise refusal("levels", f"a list of 1 to {LEVELS_MAX} numbers", levels)
    return [checked_level(float(level)) for level in found]


def _times_log(share: Array) -> Array:
    """``share * ln(share)``, which is 0 at 0."""
    return np.asarray(share * np.log(np.maximum(share, 1e-300)), dtype=np.float64)
