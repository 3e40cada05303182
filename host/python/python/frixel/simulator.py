"""Plays on the simulated board, under a simulated finger, in virtual time."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _frixel
from ._arguments import flag, mapping, real, refusal, shown, whole
from .errors import FrixelWarning, ParameterError
from .profiles import Finger, Screen, TouchSource
from .recording import Recording
from .scene import Scene
from .stroke import Stroke

__all__ = ["Simulator", "run"]


class Simulator:
    """A simulated board with a finger on its screen. The same settings give the same bits on every machine.

    Parameters
    ----------
    scene
        The scene, or the tables of its file.
    finger
        The finger that the scene is compiled for, in place of the scene's own: a `Finger`, the name of a bundled
        finger, or the fields of its file.
    screen
        The screen, in place of the scene's own.
    stroke
        The finger's path. Default: a sweep over the screen that then visits each layer that it missed.
    seed
        Seed of the world's noise, from 0.
    person
        Seed of a simulated person, for whom the scene is not compiled. Default: the scene's finger.
    touch
        The touch source. Default: 100 reports a second, 10 ms late.
    ideal
        A world without load changes, noise, pre-sliding, leakage, offsets and lost touch reports.
    leakage
        Whether charge leaks through the skin below 250 Hz; measurements disagree (`docs/inside/evidence.md`).
    mean_square
        Whether friction follows the mean squared voltage of the carrier, rather than that of each tick; unmeasured.
    rows_per_s
        Rows of the recording per second, a divisor of 40,000.

    Raises
    ------
    SceneError
        The scene, the finger, the screen or the touch source has mistakes.
    ParameterError
        A value is not accepted, or no bundled profile has this name.
    """

    def __init__(
        self,
        scene: Scene | Mapping[str, Any],
        *,
        finger: Finger | str | Mapping[str, Any] | None = None,
        screen: Screen | str | Mapping[str, Any] | None = None,
        stroke: Stroke | None = None,
        seed: int = 1,
        person: int | None = None,
        touch: TouchSource | str | int | Mapping[str, Any] | None = None,
        ideal: bool = False,
        leakage: bool = True,
        mean_square: bool = False,
        rows_per_s: int = 1000,
    ) -> None:
        if not (stroke is None or isinstance(stroke, Stroke)):
            raise refusal("a stroke", "made by Stroke.straight, human or from_arrays", stroke)
        scene = Scene.of(scene)
        if screen is not None:
            scene = scene.with_screen(screen)
        if finger is not None:
            scene = scene.with_finger(finger)
        self.scene = scene
        self.stroke = stroke
        self.seed = whole("seed", seed, 0)
        self.person = None if person is None else whole("person", person, 0)
        self.touch = None if touch is None else TouchSource.of(touch)
        self.ideal, self.leakage = flag("ideal", ideal), flag("leakage", leakage)
        self.mean_square = flag("mean_square", mean_square)
        self.rows_per_s = whole("rows_per_s", rows_per_s, 1, _frixel.TICK_HZ)

    def run(self, seconds: float | None = None) -> Recording:
        """Play the scene from its beginning.

        Parameters
        ----------
        seconds
            Duration, s. Default: that of the stroke.

        Returns
        -------
        Recording
            Felt friction, reference friction, and the output of the board.

        Raises
        ------
        ParameterError
            The stroke, the duration or the rate is not accepted.
        PlayError
            The simulated board refuses the scene, or stopped.
        KeyboardInterrupt
            Ctrl-C, at once.

        Warns
        -----
        FrixelWarning
            A board refuses the scene, which is played as a draft, clamped; or the stroke leaves the screen.
        """
        seconds = None if seconds is None else real("seconds", seconds)
        columns, made, off_screen = _frixel.simulate(self.scene.compiled, self, seconds)
        self.scene._warn_of_draft()
        if off_screen:
            warnings.warn(off_screen, FrixelWarning, stacklevel=2)
        settings = {
            "frixel": _frixel.__version__,
            "scene": self.scene.name,
            "stroke": None if self.stroke is None else repr(self.stroke),
            "seconds": seconds,
            "seed": self.seed,
            "person": self.person,
            "touch": None if self.touch is None else self.touch.name,
            "ideal": self.ideal,
            "leakage": self.leakage,
            "mean_square": self.mean_square,
            "rows_per_s": self.rows_per_s,
        }
        given = {name: value for name, value in settings.items() if value is not None}
        return Recording({name: np.asarray(values) for name, values in columns.items()}, given, self.scene, made)


def run(cell: Mapping[str, Any]) -> Recording:
    """Play one cell of a study: the arguments of `Simulator`, and `seconds`.

    A pure function of values that can be pickled, so that `map(frixel.run, cells)` works with processes, Dask and
    Slurm.

    >>> run({"scene": {"layer": [{"kind": "constant", "friction_fraction": 0.5}]}, "seconds": 0.01}).rows
    10
    """
    arguments = dict(mapping("cell", cell))
    seconds = arguments.pop("seconds", None)
    unknown = [shown(name) for name in arguments if name not in _ARGUMENTS]
    if unknown:
        raise ParameterError(f"a cell has no {unknown[0]}: its keys are Simulator's arguments and `seconds`")
    if "scene" not in arguments:
        raise ParameterError("a cell lacks `scene`: give a Scene or its tables")
    return Simulator(**arguments).run(seconds)


_ARGUMENTS = inspect.signature(Simulator).parameters.keys()
