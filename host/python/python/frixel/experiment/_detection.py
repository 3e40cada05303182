"""The stimulus of a detection experiment, and the finger profile from its threshold.

In each trial the finger makes two strokes, one with the stimulus: friction that oscillates at 160 Hz, near which
fingers are most sensitive (Vardar 2016, doi:10.1007/978-3-319-42321-0_18). A level is the amplitude of its electric
friction, as a share of the largest. The newtons on a person's finger are unknown, so the result is a voltage.
"""

from __future__ import annotations

import datetime
import math

import numpy as np
from numpy.typing import ArrayLike

from .. import _frixel, model
from .._arguments import number, refusal
from .._arguments import text as checked_text
from ..profiles import Finger
from ..scene import Scene
from ._psychometric import Array

STROKE_S = 1.6
"""Duration of each of the two strokes, s."""
STIMULUS_HZ = 160.0
FADE_S = 0.2
"""Fade of the stimulus at either end of a stroke, s, so that no click gives it away."""
SAMPLE_HZ = 4000
GAP_UM = 100.0
"""So large that electric friction is a square of the voltage, whose mean is the same under every carrier."""
EXAMPLE = _frixel.EXAMPLE_FINGER
"""The parameters of the bundled finger `example`, which a perceptual profile keeps."""
NORMAL_LOAD_N = EXAMPLE["normal_load_n"]
CONTACT = model.Contact(
    radius_m=1e-3 * EXAMPLE["radius_mm"],
    stiffness_pa_per_m=EXAMPLE["stiffness_pa_per_m"],
    friction_coefficient=EXAMPLE["friction_coefficient"],
    gap_m=1e-6 * GAP_UM,
)
"""Finger for which the board computes voltages. Any finger will do, because only the voltages count."""
LEVELS = [float(level) for level in np.geomspace(1e-3, 1.0, 31)]


def scene(voltage_v_rms: float) -> Scene:
    """The scene of the experiment: a stream over the whole screen, up to a voltage."""
    high_n = float(model.eval(CONTACT, voltage_v_rms, NORMAL_LOAD_N).electric_friction_n)
    return Scene.from_dict(
        {
            "screen": {"width_mm": 120.0, "height_mm": 80.0, "coating": [{"thickness_um": 1.0, "permittivity": 1.0}]},
            "finger": {**EXAMPLE, "skin_gap_um": GAP_UM - 1.0},
            "drive": {"voltage_max_v_rms": voltage_v_rms},
            "layer": [{"kind": "stream", "above": "natural", "low_n": 0.0, "high_n": _frixel.REACH * high_n}],
        }
    )


def samples(level: float) -> Array:
    """Samples of a stroke with the stimulus, at `SAMPLE_HZ`, for the stream of `scene`; at level 0 without it."""
    time_s = np.arange(round(STROKE_S * SAMPLE_HZ)) / SAMPLE_HZ
    fade = np.minimum(np.minimum(time_s, STROKE_S - time_s) / FADE_S, 1.0)
    return np.asarray(level * fade * (0.5 - 0.5 * np.cos(2 * math.pi * STIMULUS_HZ * time_s)), dtype=np.float64)


def voltage_of(level: ArrayLike, voltage_v_rms: float) -> Array:
    """The voltage at the peaks of a stimulus, V rms, of an experiment up to `voltage_v_rms`."""
    largest_n = model.eval(CONTACT, voltage_v_rms, NORMAL_LOAD_N).electric_friction_n
    shares = np.minimum(np.asarray(level, dtype=np.float64), 1.0)
    return model.invert(CONTACT, shares * largest_n, NORMAL_LOAD_N, electric=True)


def perceptual_finger(
    threshold_v_rms: float,
    interval_v_rms: tuple[float, float],
    *,
    method: str,
    screen: str = "example",
    date: datetime.date | None = None,
) -> Finger:
    """The profile of a finger from its detection threshold, without forces (`docs/design/scenes.md`, `[finger]`).

    Parameters
    ----------
    threshold_v_rms, interval_v_rms
        Rms voltage at the threshold, and its 95 % interval, V.
    method, screen, date
        How, on which screen, and when the threshold was found. Default date: today.

    >>> perceptual_finger(22, (19, 26), method="QUEST+, 60 trials").text.splitlines()[5]
    'origin = "perceptual"'
    """
    found = number("threshold_v_rms", threshold_v_rms, 0.0, 1000.0)
    try:
        low, high = (number("interval_v_rms", value, 0.0, 1000.0) for value in interval_v_rms)
    except (TypeError, ValueError) as error:
        raise refusal("interval_v_rms", "two voltages, the lower one first", interval_v_rms) from error
    if not low <= found <= high:
        raise refusal("interval_v_rms", "two voltages around the threshold", interval_v_rms)
    if not (date is None or isinstance(date, datetime.date)):
        raise refusal("date", "a datetime.date", date)
    evidence = {
        "origin": "perceptual",
        "date": (date or datetime.datetime.now().astimezone().date()).isoformat(),
        "method": checked_text("method", method),
        "screen": checked_text("screen", screen),
        "threshold_v_rms": found,
        "threshold_interval_v_rms": [low, high],
    }
    return Finger.from_dict({**EXAMPLE, **evidence})
