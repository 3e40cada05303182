"""A session with one participant, in which every answer is on the disk before the next trial."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from .. import _frixel
from .._arguments import check_callable, each, mapping, participant_code, refusal, text, whole
from .._arguments import path as checked_path
from ..device import Device
from ..errors import ParameterError
from ..recording import Recording
from ..scene import Scene
from ..simulator import Simulator
from ._estimate import Answers, Estimate, estimate
from ._folder import ExperimentError, Folder, sha256
from ._methods import Method, QuestPlus
from ._psychometric import Task, checked_level, checked_task

FORMAT = 1
KEPT_MAX_BYTES = 256 << 20
"""Largest number of bytes of simulated recordings that are kept for the same play in the same run."""
_LOG = logging.getLogger("frixel.experiment")
_RUN: WeakValueDictionary[int, Method] = WeakValueDictionary()
"""The methods that a run has taken, by identity: a method need not be hashable."""


@dataclass(frozen=True)
class Trial:
    """One trial, the argument of ``play`` and ``answer``."""

    number: int
    """From 0, through the whole session."""
    block: str
    """Name of the block."""
    level: float
    """Level of the stronger presentation; 0 for a catch trial."""
    target: int
    """Index of the stronger presentation: 0 or 1, by seed."""
    is_practice: bool
    """Whether the trial is practice: its answer does not count."""
    is_catch: bool
    """Whether the trial is a catch trial, in addition to the method's trials."""


@dataclass
class _Kept:
    """A recording, and its file in the folder once written."""

    recording: Recording
    name: str | None = None

    @property
    def size(self) -> int:
        """Bytes of its columns."""
        return sum(values.nbytes for values in self.recording.values())


@dataclass(frozen=True)
class _Play:
    """A play of the current trial."""

    kept: _Kept
    began_s: float
    ended_s: float

    def row(self) -> dict[str, Any]:
        """The play as a part of its trial's row."""
        recording = self.kept.recording
        row = {
            "recording": self.kept.name,
            "scene": sha256(recording.scene.text.encode()),
            "began_s": self.began_s,
            "ended_s": self.ended_s,
        }
        return {**row, "board_s": recording.settings["board_s"]} if "board_s" in recording.settings else row


class Session:
    """The answers of one participant in a folder: a manifest, a line for each trial, and the recordings of all plays.

    In a folder that has trials already, the session is resumed if the manifest is the same: no answered trial is
    repeated, and at most the running trial is lost. ``participant`` is a code of letters, digits, ``-``, ``_`` and
    ``.``, not a name.

    :meth:`play` plays and records, and adds the SHA-256 of each recording to the manifest. ``played`` has texts by
    names of your choice that must not change between runs, such as stimuli that are played in another way. The manifest
    has their SHA-256, and a folder with other texts is refused.

    ``on_marker`` is called with ``"began"``, ``"play"``, ``"presented"`` or ``"answered"``, and the trial, at that
    moment: for an outlet of Lab Streaming Layer, or a trigger line. ``"play"`` comes just before the simulator plays,
    or as soon as a board reports that it plays; ``"answered"`` once the answer is on the disk.

    Raises :class:`ExperimentError` for a folder of another session, or a folder that another process writes into.
    """

    def __init__(
        self,
        folder: str | Path,
        participant: str,
        task: Task,
        *,
        seed: int,
        played: Mapping[str, str | bytes] | None = None,
        on_marker: Callable[[str, Trial], object] | None = None,
    ) -> None:
        checked_task(task)
        whole("seed", seed, 0)
        if on_marker is not None:
            check_callable("on_marker", on_marker)
        self._participant = participant_code(participant)
        self._task, self._seed, self._on_marker = task, seed, on_marker
        contents = sorted(mapping("played", {} if played is None else played).items())
        for name, content in contents:
            if not isinstance(content, bytes):
                text(f"the text {name!r} of `played`", content)
        manifest = {
            "format": FORMAT,
            "participant": participant,
            "task": task.name,
            "seed": seed,
            "played": {name: sha256(read if isinstance(read, bytes) else read.encode()) for name, read in contents},
        }
        self._folder = Folder(checked_path("folder", folder), manifest)
        # Times of different runs are on different clocks.
        self._run = 1 + max((row["run"] for row in self._folder.rows), default=-1)
        self._begin_s = time.monotonic()
        self._repeated = 0
        self._is_cut_off = False
        self._trial_now: Trial | None = None
        self._plays: list[_Play] = []
        self._kept: dict[Any, _Kept] = {}

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Lets another process write into the folder."""
        self._folder.close()

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The answered trials: the fields of :class:`Trial`, ``response``, ``correct``, ``run``, ``plays``, and
        ``played_s``, ``presented_s`` and ``answered_s`` after the beginning of that run, in seconds.

        Each of ``plays`` has ``recording``, its file in the folder, ``scene``, the SHA-256 of the scene's text,
        ``began_s`` and ``ended_s``, and on a board ``board_s``, the board's time of the recording's first row. A play
        on a board begins when the board reports it.
        """
        return [dict(row) for row in self._folder.rows]

    def play(
        self,
        scene: Scene | Mapping[str, Any],
        *,
        on: Device | None = None,
        seconds: float | None = None,
        **settings: Any,
    ) -> Recording:
        """Plays a scene in a trial, and keeps its recording once the trial is answered.

        On the simulator, ``settings`` are those of :class:`frixel.Simulator`. A repeated play with the same settings
        returns the earlier recording, as long as it is among the last 256 MiB of this run. On a board, ``on``, the
        scene plays for ``seconds`` (:meth:`frixel.Device.record`).

        Outside of a trial, use :class:`frixel.Simulator` or :meth:`frixel.Device.record`.
        """
        self._folder.check_open()
        if not (on is None or isinstance(on, Device)):
            raise refusal("`on`", "a board from Device.open", on)
        if on is not None and (settings or seconds is None):
            raise ParameterError("a play on a board accepts `seconds`, but no settings of the simulator")
        if self._trial_now is None:
            raise ExperimentError(
                "no trial is running that this play could belong to: call it within `play` or `answer` of `run`, or "
                "use Simulator or Device.record"
            )
        began_s = self._now_s()

        def begins() -> None:
            nonlocal began_s
            began_s = self._now_s()
            self._mark("play")

        if on is None or seconds is None:
            simulator = Simulator(scene, **settings)
            begins()
            kept = self._simulated(simulator, seconds)
        else:
            kept = _Kept(on.record(scene, seconds, on_active=begins))
        self._plays.append(_Play(kept, began_s, self._now_s()))
        return kept.recording

    def replay(self, number: int) -> int:
        """Plays the plays of a trial again, from their recordings alone, and compares every bit.

        Returns the number of plays, all of which are equal. Raises :class:`ExperimentError` for a trial without plays,
        and :class:`frixel.PlayError` if a play differs, or was on a board.
        """
        if whole("number", number, 0) >= len(self._folder.rows):
            raise ExperimentError(f"trial {number} is not answered: there are {len(self._folder.rows)}, from 0")
        plays = self._folder.rows[number]["plays"]
        if not plays:
            raise ExperimentError(f"trial {number} played nothing through its session: play with `session.play`")
        for play in plays:
            _frixel.replay(self._folder.recording(play["recording"]), play["recording"])
        return len(plays)

    def run(
        self,
        method: Method,
        play: Callable[[Trial], object],
        answer: Callable[[Trial], int],
        *,
        block: str = "main",
        practice: Sequence[float] = (),
        catch_every: int | None = None,
        break_every: int | None = None,
        on_break: Callable[[int], object] | None = None,
    ) -> Answers:
        """Presents the trials of a block, and returns its answers, including those of earlier runs.

        ``play`` presents a trial with :meth:`play`, and returns when the person has felt it. ``answer`` returns the
        index of the presentation that felt stronger, 0 or 1; in a same-different task, 1 for "different". ``practice``
        has levels of trials before the first one, whose answers do not count. After every ``catch_every`` trials of the
        method, a trial at level 0 follows. ``on_break`` is called with the number of trials so far, after every
        ``break_every``. An exception in ``on_break``, ``play`` or ``answer`` ends the run; the same program resumes
        there when it opens the session again. Each run needs a new ``method``.
        """
        for name, act in {
            "play": play,
            "answer": answer,
            **({} if on_break is None else {"on_break": on_break}),
        }.items():
            check_callable(name, act)
        for name, every in {"catch_every": catch_every, "break_every": break_every}.items():
            if every is not None:
                whole(name, every, 1)
        practised_levels = [checked_level(level) for level in each("practice", practice)]
        text("block", block)
        if not (hasattr(method, "next_level") and hasattr(method, "answer")):
            raise refusal("method", "a Method, such as QuestPlus", method)
        if self._is_cut_off:
            raise ExperimentError("the previous run was cut off: open the session again to resume it there")
        if isinstance(method, QuestPlus) and method.task != self._task:
            raise ParameterError(
                f"the method is for the task {method.task.name}, and the session for {self._task.name}: give both the "
                "same task"
            )
        if id(method) in _RUN:
            raise ParameterError("this method was given to another run: make a new one for each `run`")
        self._is_cut_off = True
        answers = Answers()
        for practised in practised_levels:
            self._trial(play, answer, block, practised, is_practice=True)
        # A class of one's own may have slots, without one for weak references.
        with suppress(TypeError):
            _RUN[id(method)] = method
        count = 0
        while (level := method.next_level()) is not None:
            correct = self._trial(play, answer, block, level)
            method.answer(level, correct)
            answers.add(level, correct)
            count += 1
            if catch_every and count % catch_every == 0:
                answers.add(0.0, self._trial(play, answer, block, 0.0, is_catch=True))
            if on_break and break_every and count % break_every == 0 and self._repeated == len(self._folder.rows):
                on_break(count)
        self._is_cut_off = False
        return answers

    def estimate(self, answers: Answers) -> Estimate:
        """The estimate from the answers of a block: see :func:`frixel.experiment.estimate`."""
        return estimate(answers, self._task)

    def _trial(
        self,
        play: Callable[[Trial], object],
        answer: Callable[[Trial], int],
        block: str,
        level: float,
        *,
        is_practice: bool = False,
        is_catch: bool = False,
    ) -> bool:
        """Presents a trial, or reads its answer if an earlier run had one. Returns whether it is correct."""
        number = self._repeated
        # By the number alone, so that a resumed session presents the same.
        target = int(np.random.default_rng([self._seed, number]).integers(2))
        trial = Trial(number, block, level, target, is_practice, is_catch)
        self._repeated += 1
        if number < len(self._folder.rows):
            return self._recorded(trial)
        if number > 0 and self._folder.rows[-1]["run"] != self._run:
            _LOG.warning(
                "the session goes on with trial %d: those before it are answered; if the previous run ended in it, "
                "that presentation is lost",
                number,
            )
        self._folder.check_open()
        with self._presenting(trial):
            played_s = self._now_s()
            play(trial)
            presented_s = self._now_s()
            self._mark("presented")
            response = answer(trial)
            answered_s = self._now_s()
            is_same_different = self._task.name == "same-different"
            # A bool would mean "correct", not a presentation.
            if response not in (0, 1) or (isinstance(response, (bool, np.bool_)) and not is_same_different):
                raise ExperimentError(
                    f"trial {number}: an answer must be 0 or 1, but is {response!r}: write int(...) if True means the "
                    "second presentation"
                )
            times = {"played_s": played_s, "presented_s": presented_s, "answered_s": answered_s}
            correct = bool(response == (1 if is_same_different else target))
            answered = {"response": int(response), "correct": correct, "run": self._run, "plays": self._kept_plays()}
            self._folder.append({**asdict(trial), **answered, **times})
            self._mark("answered")
        return correct

    @contextmanager
    def _presenting(self, trial: Trial) -> Iterator[None]:
        """The context in which a trial runs. Logs the loss of the trial if an exception ends it."""
        self._trial_now = trial
        try:
            self._mark("began")
            yield
        except BaseException:
            if len(self._folder.rows) == trial.number:
                _LOG.warning(
                    "trial %d is lost: it was not answered; those before it are kept, and the same program goes on "
                    "there",
                    trial.number,
                )
            raise
        finally:
            self._trial_now, self._plays = None, []

    def _kept_plays(self) -> list[dict[str, Any]]:
        """Write the recordings of the trial's plays, and return the plays for its row."""
        # The same recording may be in two plays.
        new = list({id(play.kept): play.kept for play in self._plays if play.kept.name is None}.values())
        names = self._folder.keep([kept.recording for kept in new], self._participant)
        for kept, name in zip(new, names, strict=True):
            kept.name = name
        return [play.row() for play in self._plays]

    def _recorded(self, trial: Trial) -> bool:
        row = self._folder.rows[trial.number]
        differing = [name for name, value in asdict(trial).items() if row.get(name) != value]
        if differing:
            name = differing[0]
            raise ExperimentError(
                f"trial {trial.number} had {name} {row.get(name)!r}, and would now have {asdict(trial)[name]!r}: go on "
                "with the same methods, blocks and seeds, or give another folder"
            )
        return bool(row["correct"])

    def _simulated(self, simulator: Simulator, seconds: float | None) -> _Kept:
        """A play on the simulator: an earlier one, if it is the same."""
        key = (
            simulator.scene,
            simulator.stroke,
            simulator.seed,
            simulator.person,
            simulator.touch,
            simulator.ideal,
            simulator.leakage,
            simulator.rows_per_s,
            seconds,
        )
        if key not in self._kept:
            # Later trials with the same play share its read-only columns.
            recording = simulator.run(seconds)
            kept = self._kept[key] = _Kept(recording)
            size = sum(kept.size for kept in self._kept.values())
            while size > KEPT_MAX_BYTES:
                size -= self._kept.pop(next(iter(self._kept))).size
            return kept
        return self._kept[key]

    def _mark(self, marker: str) -> None:
        if self._on_marker is not None and self._trial_now is not None:
            self._on_marker(marker, self._trial_now)

    def _now_s(self) -> float:
        return round(time.monotonic() - self._begin_s, 6)
