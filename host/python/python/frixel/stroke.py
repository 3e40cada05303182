"""The path of the simulated finger."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _frixel
from ._arguments import array, check_finite, flag, positive, refusal, whole
from .errors import ParameterError

__all__ = ["Stroke"]


class Stroke:
    """The motion of a finger over a screen. Made by `straight`, `human` or `from_arrays`.

    Places are in mm from the top left corner of the screen.
    """

    def __init__(self) -> None:
        raise ParameterError("a stroke is made by Stroke.straight, human or from_arrays: call one of these")

    @staticmethod
    def straight(
        from_mm: tuple[float, float],
        to_mm: tuple[float, float],
        *,
        speed_mm_s: float = 100.0,
        minimum_jerk: bool = False,
    ) -> Stroke:
        """A straight stroke from one place to another.

        Parameters
        ----------
        from_mm, to_mm
            Start and end: x and y, mm.
        speed_mm_s
            Mean speed, mm/s, above 0.
        minimum_jerk
            Start and end at rest, as a hand does, rather than at constant speed.

        Raises
        ------
        ParameterError
            A value is not accepted.
        """
        speed = positive("speed_mm_s", speed_mm_s)
        return _Straight(_place("from_mm", from_mm), _place("to_mm", to_mm), speed, flag("minimum_jerk", minimum_jerk))

    @staticmethod
    def human(seed: int, *, seconds: float | None = None, rough: bool = False) -> Stroke:
        """The touches of a person, different for every seed.

        Parameters
        ----------
        seed
            Seed of the person's motion, from 0.
        seconds
            Duration, s, above 0. Default: that of the play, or else 10 s.
        rough
            With the accelerations of recorded strokes before smoothing, which are 2 to 5 times as large.

        Raises
        ------
        ParameterError
            A value is not accepted.
        """
        lasts_s = None if seconds is None else positive("seconds", seconds)
        return _Human(whole("seed", seed, 0), lasts_s, flag("rough", rough))

    @staticmethod
    def from_arrays(t_s: ArrayLike, x_mm: ArrayLike, y_mm: ArrayLike, load_n: ArrayLike | None = None) -> Stroke:
        """A stroke through places at times, straight and at constant speed between them.

        Parameters
        ----------
        t_s
            Times, s, from 0 and rising; shape (n,), at least 2. The finger is off the screen until the first time. A
            first time above 10 s counts as another clock's, and becomes 0.
        x_mm, y_mm
            Places, mm, shape (n,); NaN in both while the finger is off the screen.
        load_n
            Normal loads, N, above 0 and at most 50, shape (n,); NaN where none is known.

        Raises
        ------
        ParameterError
            The arrays differ in length, times do not rise, or a place or a load is out of range. Messages name the
            element.
        """
        given = {"t_s": t_s, "x_mm": x_mm, "y_mm": y_mm, **({} if load_n is None else {"load_n": load_n})}
        columns = {name: array(name, values) for name, values in given.items()}
        shapes = {column.shape for column in columns.values()}
        if len(shapes) > 1 or columns["t_s"].ndim != 1:
            raise ParameterError(f"a stroke has arrays of one length, found shapes {sorted(shapes)}")
        for name, values in columns.items():
            check_finite(name, values, or_nan=name != "t_s")
        stroke = _Rows(columns["t_s"], columns["x_mm"], columns["y_mm"], columns.get("load_n"))
        _frixel.check_stroke(stroke)
        return stroke


def _place(name: str, place: tuple[float, float]) -> tuple[float, float]:
    x_and_y = array(name, place)
    if x_and_y.shape != (2,) or not np.isfinite(x_and_y).all():
        raise refusal(name, "x and y in mm", place)
    return float(x_and_y[0]), float(x_and_y[1])


@dataclass(frozen=True)
class _Straight(Stroke):
    from_mm: tuple[float, float]
    to_mm: tuple[float, float]
    speed_mm_s: float
    minimum_jerk: bool


@dataclass(frozen=True)
class _Human(Stroke):
    seed: int
    seconds: float | None
    rough: bool


@dataclass(frozen=True, eq=False)
class _Rows(Stroke):
    t_s: NDArray[np.float64] = field(repr=False)
    x_mm: NDArray[np.float64] = field(repr=False)
    y_mm: NDArray[np.float64] = field(repr=False)
    load_n: NDArray[np.float64] | None = field(repr=False)
