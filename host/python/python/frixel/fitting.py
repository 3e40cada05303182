"""A finger's profile from measured friction."""

from __future__ import annotations

import csv
import datetime
import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _frixel
from ._arguments import each, number, real, refusal, whole
from ._arguments import text as checked_text
from .errors import FitError, ParameterError
from .profiles import Finger, Screen

__all__ = ["Fit", "fit"]


@dataclass(frozen=True)
class Fit:
    """A fitted finger.

    Attributes
    ----------
    finger
        The finger, for `Scene.with_finger` and `Simulator`; `finger.text` is its file.
    summary
        The numbers of `frixel finger fit --json` (`docs/design/outputs.md`), each with its 95 % interval under its name
        with `_interval`. The main ones are `friction_coefficient`, without a unit; `electric_friction_n`, N, at
        `stated_voltage_v_rms`, V rms, under `normal_load_n`, N; `voltage_exponent`, without a unit; `skin_gap_um`, um;
        `bandwidth_hz`, Hz.
    words
        The summary in words: the results, what they say about the model, and what the data cannot tell.
    """

    finger: Finger
    summary: dict[str, Any]
    words: str

    def __str__(self) -> str:
        return self.words


@dataclass(frozen=True)
class _Settings:
    empirical: bool
    voltage_v_rms: float
    normal_load_n: float | None
    carrier_hz: float
    sine: bool
    without: list[str]
    seed: int
    date: str
    method: str
    screen: Screen


def fit(
    data: Mapping[str, ArrayLike],
    *,
    law: Literal["contact", "empirical"] = "contact",
    screen: Screen | str | Mapping[str, Any] = "example",
    voltage_v_rms: float = 150.0,
    normal_load_n: float | None = None,
    carrier_hz: float = 1000.0,
    waveform: Literal["square", "sine"] = "square",
    without: Sequence[str] = (),
    method: str = "load cell, strokes with the drive switched on and off",
    date: datetime.date | None = None,
    seed: int = 1,
) -> Fit:
    """Fit a finger to the samples of a force sensor, as `frixel finger fit` does.

    Parameters
    ----------
    data
        Columns of shape (n,), for example a `pandas.DataFrame`: `voltage_v_rms` (V), `normal_force_n` and `friction_n`
        (N), and optionally `time_s` (s), `stroke` (the name or number of each stroke) and `speed_mm_s` (mm/s), with
        `nan` for unknown values. The finger slides in strokes, while the drive is switched on and off. Names may state
        other units, and tables of means are accepted, as by the command; other columns are ignored. Messages count rows
        as in a CSV file, whose header is row 1.
    law
        `contact` for the contact model, which refuses data that contradict it; `empirical` for a law fitted to the
        data alone.
    screen
        The screen that friction was measured on.
    voltage_v_rms
        Voltage at which the contact model's electric friction is stated, V rms.
    normal_load_n
        Normal load of the profile, N. Default: the median of the data.
    carrier_hz, waveform
        Carrier of the measurement: its frequency, 125 to 5000 Hz, and its shape, with edges of 20 us. An empirical law
        is not corrected: it holds under the carrier of its measurement.
    without
        Names of strokes to leave out.
    method, date
        How and when friction was measured, for the profile. Default date: today.
    seed
        Seed of the bootstrap that gives the intervals.

    Raises
    ------
    ParameterError
        Columns differ in length, or a value is not accepted.
    FitError
        A column is missing or has an invalid number, or the data do not determine a finger.
    KeyboardInterrupt
        Ctrl-C, at once.
    """
    if law not in ("contact", "empirical"):
        raise refusal("the law", "'contact' or 'empirical'", law)
    if waveform not in ("square", "sine"):
        raise refusal("the waveform", "'square' or 'sine'", waveform)
    if not (hasattr(data, "keys") and hasattr(data, "__getitem__")):
        raise refusal("data", "a dictionary of columns or a DataFrame", data)
    if not (date is None or isinstance(date, datetime.date)):
        raise refusal("date", "a datetime.date", date)
    table = _csv(data)
    day = (date or datetime.datetime.now().astimezone().date()).isoformat()
    settings = _Settings(
        law == "empirical",
        real("voltage_v_rms", voltage_v_rms),
        None if normal_load_n is None else real("normal_load_n", normal_load_n),
        number("carrier_hz", carrier_hz, 125.0, 5000.0),
        waveform == "sine",
        [str(name) for name in each("without", without)],
        whole("seed", seed, 0),
        day,
        checked_text("method", method),
        Screen.of(screen),
    )
    summary, words, profile = _frixel.fit_finger(table, settings)
    return Fit(Finger.parse(profile), json.loads(summary), words)


def _csv(data: Mapping[str, ArrayLike]) -> str:
    """The columns as a CSV table, for the reader and the validation of the command, with the same row numbers."""
    columns = {str(name): np.asarray(data[name]) for name in data}
    # A single word or number, such as a participant, is not a column.
    columns = {name: values for name, values in columns.items() if values.ndim > 0}
    for name, values in columns.items():
        if values.dtype.kind in "mM":
            raise refusal(f"data[{name!r}]", "numbers (seconds for a time)", values.dtype)
    shapes = {values.shape for values in columns.values()}
    if len(shapes) > 1 or any(len(shape) != 1 for shape in shapes):
        raise ParameterError(f"data: columns must have the same length, found shapes {sorted(shapes)}")
    if not columns:
        raise FitError("the data have no columns: give voltage_v_rms, normal_force_n and friction_n")
    text = io.StringIO()
    # Quoted, a word is neither a comment nor a separator.
    writer = csv.writer(text, quoting=csv.QUOTE_NONNUMERIC, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*(values.tolist() for values in columns.values()), strict=True))
    return text.getvalue()
