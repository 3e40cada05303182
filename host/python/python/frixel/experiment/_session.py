"""A session with one participant: trials are presented, and every answer is on the disk before the next trial."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

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
from ._methods import Method
from ._psychometric import Task, checked_level, checked_task

FORMAT = 1
KEPT_MAX_BYTES = 256 << 20
"""Most bytes of the simulator's recordings that wait for the same play in the same run."""
_LOG = logging.getLogger("frixel.experiment")


@dataclass(frozen=True)
class Trial:
    """One trial, as ``play`` and ``answer`` get it."""

    number: int
    """From 0, through the whole session."""
    block: str
    """Name of the block."""
    level: float
    """Level of the stronger presentation; 0 for a catch trial."""
    target: int
    """Which presentation is the stronger one: 0 or 1, by seed."""
    is_practice: bool
    """Whether the answer counts for nothing."""
    is_catch: bool
    """Whether the trial is a catch trial, which no method asked for."""


@dataclass
class _Kept:
    """A recording, and its file in the folder once it is there."""

    recording: Recording
    name: str | None = None

    @property
    def size(self) -> int:
        """Bytes of its columns."""
        return sum(values.nbytes for values in self.recording.values())


@dataclass(frozen=True)
class _Play:
    """A play of the trial that runs."""

    kept: _Kept
    began_s: float
    ended_s: float

    def row(self) -> dict[str, Any]:
        """The play as the row of its trial has it."""
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

    A session is resumed in a folder that has trials already, if the manifest is the same: no answered trial is
    repeated, and at most the one that ran is lost. ``participant`` is a code of letters, digits, ``-``, ``_`` and
    ``.``, not a name.

    :meth:`play` plays and records, and the manifest gets the SHA-256 of each recording by itself. ``played`` are texts
    by names of your choice that must not change between two runs, such as what is played in another way. Their SHA-256
    stands in the manifest, too, and a folder with others is refused.

    ``on_marker`` is called with ``"began"``, ``"play"``, ``"presented"`` and ``"answered"`` and the trial, at that
    moment: for an outlet of Lab Streaming Layer, or a trigger line. ``"play"`` comes before the simulator plays, and as
    soon as a board says that it plays; ``"answered"`` when the disk has the answer.

    Raises :class:`ExperimentError` for a folder of another session, or one that another process writes into.
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
        ``began_s`` and ``ended_s``, and of a board ``board_s``, the board's time of the recording's first row. A play
        on a board has begun when the board has said so.
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
        """Plays a scene, and keeps its recording with the trial that runs, once that is answered.

        On the simulator, ``settings`` are those of :class:`frixel.Simulator`; of the same ones, the recording of before
        is returned, as long as it is among the last 256 MiB of this run. With a board, ``on``, it plays for ``seconds``
        (:meth:`frixel.Device.record`).

        Without a trial there is nothing to keep it with: then play by :class:`frixel.Simulator` or
        :meth:`frixel.Device.record`.
        """
        self._folder.check_open()
        if not (on is None or isinstance(on, Device)):
            raise refusal("`on`", "a board, of Device.open", on)
        if on is not None and (settings or seconds is None):
            raise ParameterError("a play on a board takes `seconds`, and no settings of the simulator")
        if self._trial_now is None:
            raise ExperimentError(
                "no trial runs, with which this play could be kept: call it within `play` or `answer` of `run`, or "
                "play by Simulator or Device.record"
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

        Returns the number of plays, which are the same. Raises :class:`ExperimentError` for a trial without any, and
        :class:`frixel.PlayError` where a play differs, or was on a board.
        """
        if whole("number", number, 0) >= len(self._folder.rows):
            raise ExperimentError(f"trial {number} is not answered: there are {len(self._folder.rows)}, from 0")
        plays = self._folder.rows[number]["plays"]
        if not plays:
            raise ExperimentError(f"trial {number} played nothing through its session: play by `session.play`")
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
        """Presents the trials of a block, and returns its answers, those of an earlier run included.

        ``play`` presents a trial, by :meth:`play`, and returns when the person has felt it. ``answer`` returns the
        number of the presentation that felt stronger, 0 or 1; where the task is same-different, 1 for "different".
        ``practice`` are levels of trials before the first one, which count for nothing. After every ``catch_every``
        trials of the method, a trial at level 0 follows. ``on_break`` is called with the number of trials so far, after
        every ``break_every``; an exception in it or in ``play`` and ``answer`` ends the run, and the same program goes
        on there when it opens the session again.
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
            raise ExperimentError("the run before this one was cut off: open the session again, and it goes on there")
        self._is_cut_off = True
        answers = Answers()
        for practised in practised_levels:
            self._trial(play, answer, block, practised, is_practice=True)
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
        """What the answers of a block say: see :func:`frixel.experiment.estimate`."""
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
        # By the number alone, so that a resumed session presents what it would have.
        target = int(np.random.default_rng([self._seed, number]).integers(2))
        trial = Trial(number, block, level, target, is_practice, is_catch)
        self._repeated += 1
        if number < len(self._folder.rows):
            return self._recorded(trial)
        if number > 0 and self._folder.rows[-1]["run"] != self._run:
            _LOG.warning(
                "the session goes on with trial %d: those before it are answered, and if the run before ended in it, "
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
                raise ExperimentError(f"trial {number}: an answer is 0 or 1, and this one is {response!r}")
            times = {"played_s": played_s, "presented_s": presented_s, "answered_s": answered_s}
            correct = bool(response == (1 if is_same_different else target))
            answered = {"response": int(response), "correct": correct, "run": self._run, "plays": self._kept_plays()}
            self._folder.append({**asdict(trial), **answered, **times})
            self._mark("answered")
        return correct

    @contextmanager
    def _presenting(self, trial: Trial) -> Iterator[None]:
        """The time in which a trial runs. Says what is lost if it is left by an exception."""
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
        """The plays of the trial, as its row has them, once the disk has their recordings."""
        # A play may be there twice.
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
        """A play of the simulator: that of before, if it is the same."""
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
            # The next trial with the same play gets its read-only columns as they are.
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
