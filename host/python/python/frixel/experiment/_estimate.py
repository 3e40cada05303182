"""Estimates from answers: a threshold with its interval, or none if the answers are no better than guessing."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TextIO

import numpy as np
from numpy.typing import ArrayLike

from .._arguments import array, each, flag, refusal, whole
from ..errors import ParameterError
from ._psychometric import STEP, Array, Grid, Task, checked_grid, checked_level, checked_task

EVIDENCE_MIN = 1000.0
"""Least likelihood ratio to guessing. At most one guesser in 1,000 exceeds it, whatever the method, and however often
the ratio is evaluated (Ville's inequality)."""
RANGE_MAX = 1e6
"""Ratio of the largest to the smallest threshold of a prior over six decades. A grid that depends on the levels gets
the weight of its thresholds in this prior, so that Ville's inequality also holds where answers choose the levels."""


class Answers:
    """Numbers of correct answers at each level. Estimates do not depend on the order of the trials."""

    def __init__(self, trials: Iterable[tuple[float, bool | np.bool_]] = ()) -> None:
        self._counts: dict[float, tuple[int, int]] = {}
        for trial in each("trials", trials):
            try:
                level, correct = trial
            except (TypeError, ValueError) as error:
                raise refusal("a trial", "a level and an answer", trial) from error
            self.add(level, correct)

    def add(self, level: float, correct: bool) -> None:
        """Adds a trial at a level, from 0; ``correct`` is ``True`` or ``False``."""
        taken, is_correct = checked_level(level), flag("correct", correct)
        right, total = self._counts.get(taken, (0, 0))
        self._counts[taken] = (right + is_correct, total + 1)

    def __len__(self) -> int:
        return sum(total for _, total in self._counts.values())

    @property
    def levels(self) -> list[float]:
        """The levels, from the smallest."""
        return sorted(self._counts)

    @property
    def table(self) -> list[tuple[float, int, int]]:
        """Rows of (level, correct, total) in order of level, as ``psignifit`` takes them."""
        return [(level, *self._counts[level]) for level in sorted(self._counts)]

    def write_csv(self, file: TextIO) -> None:
        """Writes :attr:`table` with the header ``level,correct,total``."""
        if not hasattr(file, "write"):
            raise refusal("file", "open for writing", file)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("level", "correct", "total"))
        writer.writerows(self.table)

    def log_likelihood(self, task: Task, grid: Grid) -> Array:
        """Logarithm of the likelihood for each combination of the grid's parameters, as :meth:`Grid.correct`."""
        total = np.zeros_like(checked_grid(grid).correct(0.0, task))
        for level, right, count in self.table:
            # Keeps the logarithms finite where a share is 0 or 1.
            share = np.clip(grid.correct(level, task), 1e-12, 1.0 - 1e-12)
            total += right * np.log(share) + (count - right) * np.log1p(-share)
        return np.asarray(total, dtype=np.float64)

    def log_likelihood_of_guessing(self, task: Task) -> float:
        """Logarithm of the largest likelihood of a guess rate that is the same at every level."""
        rows = self.table
        right, total = sum(row[1] for row in rows), len(self)
        rates = np.asarray(checked_task(task).guess_rates)
        if not task.is_guess_rate_known:
            # A person who says "different" whatever is presented can have any share.
            rates = np.array([right / total]) if total else rates
        rates = np.clip(rates, 1e-12, 1.0 - 1e-12)
        return float(np.max(right * np.log(rates) + (total - right) * np.log1p(-rates)))


@dataclass(frozen=True)
class Estimate:
    """The result of answers: a threshold in the unit of the levels, if they are clearly better than guessing.

    Attributes
    ----------
    threshold
        Level at which the person, without lapses, is 1 - 1/e of the way from guessing to always right: median of the
        posterior. ``None`` for answers that are no better than guessing.
    interval
        95 % interval of the threshold, with 2.5 % of the posterior on either side.
    evidence
        Likelihood of the answers for a person who notices, averaged over the grid, relative to a guesser. Below 1000,
        there is no threshold.
    trials
        Number of trials.
    is_bounded
        Whether the interval lies within the levels that were presented. If not, it depends on the shape of the
        psychometric function, and more extreme levels are needed.
    """

    threshold: float | None
    interval: tuple[float, float] | None
    evidence: float
    trials: int
    is_bounded: bool

    def __str__(self) -> str:
        if self.threshold is None or self.interval is None:
            return (
                f"no better than guessing: {self.trials} trials are {self.evidence:.2g} times as likely if the person "
                f"notices, and {EVIDENCE_MIN:.0f} times is needed"
            )
        low, high = self.interval
        more = "" if self.is_bounded else "; it reaches beyond the levels that were presented: present others"
        return f"threshold {self.threshold:.3g}, {low:.3g} to {high:.3g} (95 %), of {self.trials} trials{more}"


def estimate(answers: Answers, task: Task, grid: Grid | None = None) -> Estimate:
    """Estimate the threshold from answers, in the unit of their levels.

    Thresholds are sought from a tenth of the smallest level to ten times the largest, or among those of ``grid``.

    >>> from frixel.experiment import TWO_ALTERNATIVES, Answers, estimate
    >>> trials = [(0.4, True)] * 30 + [(0.1, True)] * 24 + [(0.1, False)] * 6
    >>> trials += [(0.02, True)] * 16 + [(0.02, False)] * 14
    >>> found = estimate(Answers(trials), TWO_ALTERNATIVES)
    >>> 0.05 < found.interval[0] < found.threshold < found.interval[1] < 0.3
    True
    >>> print(estimate(Answers([(0.4, True)] * 15 + [(0.4, False)] * 15), TWO_ALTERNATIVES))
    no better than guessing: 30 trials are 0.097 times as likely if the person notices, and 1000 times is needed
    """
    if not isinstance(answers, Answers):
        raise refusal("answers", "an Answers", answers)
    checked_task(task)
    weight = 1.0
    if grid is None:
        grid = Grid.around(answers.levels)
        weight = min(1.0, grid.thresholds.size * STEP / math.log(RANGE_MAX))
    log_likelihood = answers.log_likelihood(task, grid)
    most = float(log_likelihood.max())
    log_average = most + math.log(weight * float(np.exp(log_likelihood - most).mean()))
    # Avoids an overflow; more evidence than this changes nothing.
    evidence = math.exp(min(log_average - answers.log_likelihood_of_guessing(task), 700.0))
    if evidence < EVIDENCE_MIN:
        return Estimate(None, None, evidence, len(answers), False)
    posterior = np.exp(log_likelihood - log_likelihood.max()).sum(axis=(1, 2, 3))
    low, middle, high = quantiles(grid.thresholds, posterior, (0.025, 0.5, 0.975))
    present = [level for level in answers.levels if level > 0.0]
    is_bounded = low > min(present) and high < max(present)
    return Estimate(middle, (low, high), evidence, len(answers), is_bounded)


def quantiles(thresholds: Array, posterior: Array, parts: Iterable[float]) -> list[float]:
    """Quantiles of a density over the logarithm of the thresholds, piecewise linear between its points."""
    places = np.log(thresholds)
    density = posterior / posterior.max()
    areas = np.concatenate(([0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(places))))
    return [float(np.exp(np.interp(part * areas[-1], areas, places))) for part in parts]


def magnitude_exponent(levels: ArrayLike, ratings: ArrayLike, *, seed: int = 0) -> tuple[float, tuple[float, float]]:
    """Exponent of a magnitude estimation, and its 95 % interval: the slope of ln(rating) over ln(level).

    ``levels`` and ``ratings`` are above zero and of equal length. The interval is from a bootstrap over trials with
    2,000 draws, seeded by ``seed`` (Stevens 1957, doi:10.1037/h0046162).
    """
    x, y = array("levels", levels), array("ratings", ratings)
    if x.shape != y.shape or x.ndim != 1 or not (np.isfinite([x, y]).all() and (np.stack([x, y]) > 0.0).all()):
        raise ParameterError("levels and ratings are two lists of equal length, with numbers above zero")
    x, y = np.log(x), np.log(y)
    if np.unique(x).size < 3:
        raise ParameterError(f"an exponent needs three levels or more, found {np.unique(x).size}")

    def slope(index: np.ndarray) -> float:
        centred = x[index] - x[index].mean()
        return float(centred @ y[index] / (centred @ centred)) if centred.any() else float("nan")

    rng = np.random.default_rng(whole("seed", seed, 0))
    drawn = [slope(rng.integers(x.size, size=x.size)) for _ in range(2000)]
    low, high = np.nanquantile(drawn, (0.025, 0.975))
    return slope(np.arange(x.size)), (float(low), float(high))
