"""Methods: which level comes next."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from ._psychometric import Array, Grid, Task


class Method(Protocol):
    """Chooses the level of each trial. The same answers lead to the same levels, so that a session can be resumed."""

    def next_level(self) -> float | None:
        """The level of the next trial; ``None`` after the last one."""

    def answer(self, level: float, correct: bool) -> None:
        """Takes the answer to a trial at a level."""


class ConstantStimuli:
    """Each of some levels equally often, in an order by seed that has every level once in each round."""

    def __init__(self, levels: ArrayLike, repetitions: int, *, seed: int = 0) -> None:
        one_round = np.ravel(np.asarray(levels, dtype=np.float64))
        if not one_round.size or repetitions < 1:
            raise ValueError("constant stimuli need one level or more, and one repetition or more")
        rng = np.random.default_rng(seed)
        self._levels = [float(level) for _ in range(repetitions) for level in rng.permutation(one_round)]
        self._next = 0

    def next_level(self) -> float | None:
        """The level of the next trial; ``None`` after the last one."""
        return self._levels[self._next] if self._next < len(self._levels) else None

    def answer(self, level: float, correct: bool) -> None:
        """Takes the answer to a trial at a level."""
        self._next += 1


class UpDown:
    """A transformed staircase: one wrong answer makes the next level larger, ``down`` right ones in a row smaller.

    With ``down=2`` levels gather at 70.7 % correct, with 3 at 79.4 % (Levitt 1971, doi:10.1121/1.1912375). ``step`` is
    the factor from level to level; it is squared until the first reversal. The staircase ends after ``trials``.
    """

    def __init__(
        self,
        start: float,
        *,
        trials: int,
        down: int = 3,
        step: float = 1.25,
        least: float = 0.002,
        largest: float = 3.0,
    ) -> None:
        if not (least <= start <= largest and step > 1.0 and down >= 1 and trials >= 1):
            raise ValueError("a staircase starts between its least and largest level, with a step above 1")
        self._level, self._least, self._largest = start, least, largest
        self._left, self._down, self._step = trials, down, step
        self._right_in_a_row = 0
        self._last_move = 0
        self._has_reversed = False

    def next_level(self) -> float | None:
        """The level of the next trial; ``None`` after the last one."""
        return self._level if self._left > 0 else None

    def answer(self, level: float, correct: bool) -> None:
        """Takes the answer to a trial at a level."""
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
    """The level of which the answer is expected to leave the least entropy (Watson 2017, doi:10.1167/17.3.10).

    ``levels`` are those that can be presented, at most some tens. Ties are broken by the order of ``levels``.
    """

    def __init__(self, levels: ArrayLike, task: Task, *, trials: int, grid: Grid | None = None) -> None:
        self._levels = [float(level) for level in np.ravel(np.asarray(levels, dtype=np.float64))]
        if not self._levels or trials < 1:
            raise ValueError("QUEST+ needs one level or more, and one trial or more")
        self._task, self._grid, self._left = task, grid or Grid(), trials
        self._correct = np.stack([self._grid.correct(level, task).ravel() for level in self._levels])
        self._wrong = 1.0 - self._correct
        # What the entropy of an answer takes, which is the same for every trial.
        self._correct_log = _times_log(self._correct)
        self._wrong_log = _times_log(self._wrong)
        self._posterior = np.full(self._correct.shape[1], 1.0 / self._correct.shape[1])

    @property
    def posterior(self) -> Array:
        """Probability of each combination of the grid's parameters, as :meth:`Grid.correct`."""
        return self._posterior.reshape(self._grid.correct(0.0, self._task).shape)

    def next_level(self) -> float | None:
        """The level of the next trial; ``None`` after the last one."""
        if self._left == 0:
            return None
        return self._levels[int(np.argmax(self.expected_information()))]

    def expected_information(self) -> Array:
        """What an answer at each level is expected to say of the parameters, in nats.

        The entropy that is left is that of the parameters, less this: the information between answer and parameters.
        """
        right = self._correct @ self._posterior
        answer_entropy = -(_times_log(right) + _times_log(1.0 - right))
        given_parameters = -((self._correct_log + self._wrong_log) @ self._posterior)
        return np.asarray(answer_entropy - given_parameters, dtype=np.float64)

    def answer(self, level: float, correct: bool) -> None:
        """Takes the answer to a trial at one of the levels."""
        index = self._levels.index(level)
        self._posterior = self._posterior * (self._correct if correct else self._wrong)[index]
        self._posterior /= self._posterior.sum()
        self._left -= 1


def _times_log(share: Array) -> Array:
    """``share * ln(share)``, which is 0 at 0."""
    return np.asarray(share * np.log(np.maximum(share, 1e-300)), dtype=np.float64)
