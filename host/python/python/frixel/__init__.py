"""frixel: a touchscreen's friction made programmable.

`frixel.model` is the contact model over arrays; `Scene` is what is felt where; `docs/python.md` has the first steps.
"""

from . import errors, model
from ._frixel import __version__
from .device import Device, Telemetry
from .errors import FitError, FrixelError, Mistake, ParameterError, PlayError, SceneError
from .fitting import Fit, fit
from .profiles import Finger, Screen, TouchSource
from .recording import COLUMNS, Recording
from .scene import Scene
from .simulator import Simulator, run
from .stroke import Stroke

__all__ = [
    "COLUMNS",
    "Device",
    "Finger",
    "Fit",
    "FitError",
    "FrixelError",
    "Mistake",
    "ParameterError",
    "PlayError",
    "Recording",
    "Scene",
    "SceneError",
    "Screen",
    "Simulator",
    "Stroke",
    "Telemetry",
    "TouchSource",
    "__version__",
    "errors",
    "fit",
    "model",
    "run",
]
