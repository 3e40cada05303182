"""Where the simulated finger goes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _frixel
from ._arguments import array, flag, real, refusal, whole
from .errors import ParameterError

__all__ = ["Stroke"]


class Stroke:
    """The motion of a finger over a screen. Made by `straight`, `human` or `from_arrays`.

    Places are in mm from the top left corner of the screen.
    """

    @staticmethod
    def straight(
        from_mm: tuple[float, float],
        to_mm: tuple[float, float],
        *,
        speed_mm_s: float = 100.0,
        minimum_jerk: bool = False,
    ) -> Stroke:
        """From one place straight to another.

        Parameters
        ----------
        from_mm, to_mm
            Start and end: x and y, mm.
        speed_mm_s
            Mean speed, mm/s.
        minimum_jerk
            Start and end at rest, as a hand does, rather than at constant speed.
        """
        speed = real("speed_mm_s", speed_mm_s)
        return _Straight(_place("from_mm", from_mm), _place("to_mm", to_mm), speed, flag("minimum_jerk", minimum_jerk))

    @staticmethod
    def human(seed: int, *, seconds: float | None = None, rough: bool = False) -> Stroke:
        """The touches of a person, others for every seed.

        Parameters
        ----------
        seed
            Seed of the person's motion.
        seconds
            Duration, s; without it, that of the play, or else 10 s.
        rough
            With the accelerations of recorded strokes before smoothing, 2 to 5 times as much.
        """
        lasts_s = None if seconds is None else real("seconds", seconds)
        return _Human(whole("seed", seed, 0), lasts_s, flag("rough", rough))

    @staticmethod
    def from_arrays(t_s: ArrayLike, x_mm: ArrayLike, y_mm: ArrayLike, load_n: ArrayLike | None = None) -> Stroke:
        """Through places at times, straight and at constant speed between them.

        Parameters
        ----------
        t_s
            Times from the start, s, from 0 and rising; shape (n,), at least 2.
        x_mm, y_mm
            Places, mm, shape (n,); not a number while the finger is off the screen.
        load_n
            Normal loads, N, above 0 and at most 50, shape (n,); not a number where none is known.

        Raises
        ------
        ParameterError
            The arrays are not of one length, times do not rise, or a load is none of a finger. Messages count rows as
            in a CSV file, whose header is row 1, and call the load `force_n`.
        """
        columns = [array(name, values) for name, values in {"t_s": t_s, "x_mm": x_mm, "y_mm": y_mm}.items()]
        load = None if load_n is None else array("load_n", load_n)
        shapes = {column.shape for column in [*columns, *([] if load is None else [load])]}
        if len(shapes) > 1 or columns[0].ndim != 1:
            raise ParameterError(f"a stroke has arrays of one length, found shapes {sorted(shapes)}")
        stroke = _Rows(columns[0], columns[1], columns[2], load)
        _frixel.check_stroke(stroke)
        return stroke


def _place(name: str, place: tuple[float, float]) -> tuple[float, float]:
    x_and_y = array(name, place)
    if x_and_y.shape != (2,):
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
