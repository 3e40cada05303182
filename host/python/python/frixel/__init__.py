"""frixel: a touchscreen's friction made programmable.

`frixel.model` is the contact model over arrays, a `Scene` describes the friction of a screen, `frixel.sweep` has
studies of many simulated fingers, and `frixel.experiment` has experiments with people; `docs/python/module.md` has the
first steps.
"""

from . import errors, experiment, model, sweep
from ._frixel import __version__
from .device import Device, Telemetry
from .errors import (
    ColumnError,
    FitError,
    FrixelError,
    FrixelWarning,
    Mistake,
    ParameterError,
    PlayError,
    SceneError,
)
from .fitting import Fit, fit
from .profiles import Finger, Screen, TouchSource
from .recording import COLUMNS, Recording, replay
from .scene import Scene
from .scoring import Score, score
from .simulator import Simulator, run
from .stroke import Stroke

__all__ = [
    "COLUMNS",
    "ColumnError",
    "Device",
    "Finger",
    "Fit",
    "FitError",
    "FrixelError",
    "FrixelWarning",
    "Mistake",
    "ParameterError",
    "PlayError",
    "Recording",
    "Scene",
    "SceneError",
    "Score",
    "Screen",
    "Simulator",
    "Stroke",
    "Telemetry",
    "TouchSource",
    "__version__",
    "errors",
    "experiment",
    "fit",
    "model",
    "replay",
    "run",
    "score",
    "sweep",
]
