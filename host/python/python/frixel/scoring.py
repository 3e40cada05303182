"""Scores: how faithfully simulated fingers feel a scene, and what they notice of it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from typing import Any

from . import _frixel, _tables
from ._arguments import flag, number, refusal, whole
from .profiles import Finger, Screen, TouchSource
from .scene import Scene
from .stroke import Stroke

__all__ = ["Score", "score"]


@dataclass(frozen=True)
class Score:
    """The score of a scene under simulated fingers, not people."""

    summary: dict[str, Any]
    """The output of `frixel score --json`."""
    words: str
    """The table that `frixel score` prints."""
    files: dict[str, str]
    """The tables `score.csv`, one row per play, and `score-layers.csv`, one row per layer, by these names."""

    @property
    def verdict(self) -> str:
        """The layers that the simulated fingers notice, and the levels that they tell apart, in a sentence."""
        return str(self.summary["verdict"])

    @property
    def layers(self) -> list[dict[str, Any]]:
        """One row per layer, as in `score-layers.csv`; `pandas.DataFrame(score.layers)` makes a table of them."""
        return _tables.rows(self.files["score-layers.csv"])

    @property
    def plays(self) -> list[dict[str, Any]]:
        """One row per play, as in `score.csv`."""
        return _tables.rows(self.files["score.csv"])

    @property
    def numbers(self) -> dict[str, dict[str, Any]]:
        """Each metric over all plays, by its name: `mean`, `interval` of 95 % or `None`, `unit`, `title`, `goal`.

        A metric without a value in any play, such as the correlation of flat friction, is absent.
        """
        return {row["key"]: row for row in self.summary["metrics"]}

    def __str__(self) -> str:
        return self.words

    def __repr__(self) -> str:
        return f"<frixel.Score: {self.verdict}>"

    def _repr_html_(self) -> str:
        return f"<pre>{escape(self.words)}</pre>"


@dataclass(frozen=True)
class _Settings:
    stroke: Stroke | str
    people: int | None
    strokes: int
    seeds: int
    seconds: float
    median_speed_mm_per_s: float | None
    touch: TouchSource | None
    ideal: bool
    jobs: int


def score(
    scene: Scene | Mapping[str, Any],
    *,
    finger: Finger | str | Mapping[str, Any] | None = None,
    screen: Screen | str | Mapping[str, Any] | None = None,
    people: int | None = None,
    stroke: Stroke | str = "human",
    strokes: int = _frixel.STROKES,
    seeds: int = _frixel.SEEDS,
    seconds: float = _frixel.STROKE_S,
    median_speed_mm_per_s: float | None = None,
    touch: TouchSource | str | int | Mapping[str, Any] | None = None,
    ideal: bool = False,
    jobs: int | None = None,
) -> Score:
    """Play a scene under simulated fingers, and measure how faithfully they feel it, as `frixel score` does.

    Parameters
    ----------
    scene
        A scene, or the tables of its file.
    finger, screen
        Finger and screen that the scene is compiled for, in place of its own.
    people
        Number of simulated people, from 1 to 1000, drawn from an assumed population; each makes their own strokes.
        The board computes for the scene's finger. Default: the scene's finger only.
    stroke
        `human`, `human-rough` (with the accelerations of recorded strokes before smoothing), `sweep`, or one stroke for
        all.
    strokes
        Number of human strokes, per person. Default: 4.
    seeds
        Repetitions of each stroke, with other loads, noise and lost reports. Default: 2.
    seconds
        Duration of a generated stroke, s: at most 600 s for a human stroke, and a day for `sweep`. Default: 3.
    median_speed_mm_per_s
        Median speed of human strokes, from 1 to 1000 mm/s. Default: each person has their own.
    touch
        The touch source. Default: 100 reports a second, 10 ms late.
    ideal
        A world without noise, load changes, losses and offsets.
    jobs
        Number of plays in parallel; the result does not depend on it. Default: one per processor.

    Raises
    ------
    SceneError
        The scene has mistakes, or a board refuses it.
    ParameterError
        A value is not accepted.
    KeyboardInterrupt
        Ctrl-C, at once.

    >>> plate = {"kind": "constant", "friction_fraction": 0.5}
    >>> score({"layer": [plate]}, strokes=1, seeds=1, seconds=0.5).verdict
    '0 of 1 layer is noticed by the simulated finger; not felt: layer 1 (constant)'
    """
    scene = Scene.of(scene)
    if screen is not None:
        scene = scene.with_screen(screen)
    if finger is not None:
        scene = scene.with_finger(finger)
    if not (isinstance(stroke, Stroke) or stroke in ("human", "human-rough", "sweep")):
        raise refusal("a stroke", '"human", "human-rough", "sweep" or a Stroke', stroke)
    speed = median_speed_mm_per_s
    settings = _Settings(
        stroke,
        None if people is None else whole("people", people, 1, _frixel.COUNT_MAX),
        whole("strokes", strokes, 1, _frixel.COUNT_MAX),
        whole("seeds", seeds, 1, _frixel.COUNT_MAX),
        number("seconds", seconds, 1e-3, _frixel.STROKE_MAX_S),
        None if speed is None else number("median_speed_mm_per_s", speed, *_frixel.MEDIAN_SPEEDS_MM_PER_S),
        None if touch is None else TouchSource.of(touch),
        flag("ideal", ideal),
        0 if jobs is None else whole("jobs", jobs, 1, _frixel.JOBS_MAX),
    )
    summary, words, plays, layers = _frixel.score_scene(scene.compiled, settings)
    return Score(json.loads(summary), words, {"score.csv": plays, "score-layers.csv": layers})
