"""A session with one participant: trials are presented, and every answer is on the disk before the next trial."""

from __future__ import annotations

import hashlib
import json
import os
import re
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ..errors import FrixelError
from ._estimate import Answers, Estimate, estimate
from ._methods import Method
from ._psychometric import Task

FORMAT = 1
_CODE = re.compile(r"[A-Za-z0-9_-]{1,32}")


class ExperimentError(FrixelError):
    """Why a session cannot begin or go on, and what to do."""


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


class Session:
    """The answers of one participant in a folder: ``manifest.json``, and ``trials.jsonl`` with a line for each trial.

    A folder that has trials already is gone on with, if its manifest is the same: no answered trial is repeated, and at
    most the one that ran is lost. ``participant`` is a code of letters, digits, ``-`` and ``_``, not a name.
    ``played`` is the text of all that is played, by a name of your choice; its SHA-256 stands in the manifest.

    Raises :class:`ExperimentError` for a folder of another session, or one that another process writes into.
    """

    def __init__(
        self, folder: str | Path, participant: str, task: Task, *, seed: int, played: Mapping[str, str | bytes]
    ) -> None:
        if not _CODE.fullmatch(participant):
            raise ExperimentError(
                f"participant {participant!r}: give a code of 1 to 32 letters, digits, - and _, and no name"
            )
        self._task, self._seed = task, seed
        self._folder = Path(folder)
        manifest = {
            "format": FORMAT,
            "participant": participant,
            "task": task.name,
            "seed": seed,
            "played": {name: _sha256(content) for name, content in sorted(played.items())},
        }
        self._folder.mkdir(parents=True, exist_ok=True)
        self._lock = _locked(self._folder / ".lock")
        self._path = self._folder / "trials.jsonl"
        try:
            _check_manifest(self._folder / "manifest.json", manifest)
            self._rows = _rows(self._path)
        except BaseException:
            self.close()
            raise
        self._replayed = 0
        self._begin_s = time.monotonic()

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Lets another process write into the folder."""
        self._lock.close()

    @property
    def rows(self) -> list[dict[str, Any]]:
        """The answered trials: the fields of :class:`Trial`, ``response``, ``correct``, and ``played_s``,
        ``presented_s`` and ``answered_s`` after the beginning of the run, in seconds.
        """
        return [dict(row) for row in self._rows]

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

        ``play`` presents a trial on a simulator, a board or the page, and returns when the person has felt it.
        ``answer`` returns the number of the presentation that felt stronger, 0 or 1; where the task is same-different,
        1 for "different". ``practice`` are levels of trials before the first one, which count for nothing. After every
        ``catch_every`` trials of the method, a trial at level 0 follows. ``on_break`` is called with the number of
        trials so far, after every ``break_every``; an exception in it or in ``play`` and ``answer`` ends the run, and
        the next one goes on there.
        """
        answers = Answers()
        for practised in practice:
            self._trial(play, answer, block, float(practised), is_practice=True)
        count = 0
        while (level := method.next_level()) is not None:
            correct = self._trial(play, answer, block, level)
            method.answer(level, correct)
            answers.add(level, correct)
            count += 1
            if catch_every and count % catch_every == 0:
                answers.add(0.0, self._trial(play, answer, block, 0.0, is_catch=True))
            if on_break and break_every and count % break_every == 0 and self._replayed == len(self._rows):
                on_break(count)
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
        number = self._replayed
        # By the number alone, so that a resumed session presents what it would have.
        target = int(np.random.default_rng([self._seed, number]).integers(2))
        trial = Trial(number, block, level, target, is_practice, is_catch)
        self._replayed += 1
        if number < len(self._rows):
            return self._recorded(trial)
        played_s = self._now_s()
        play(trial)
        presented_s = self._now_s()
        response = answer(trial)
        if response not in (0, 1):
            raise ExperimentError(f"trial {number}: an answer is 0 or 1, and this one is {response!r}")
        correct = bool(response == (1 if self._task.name == "same-different" else target))
        times = {"played_s": played_s, "presented_s": presented_s, "answered_s": self._now_s()}
        row = {**asdict(trial), "response": int(response), "correct": correct, **times}
        _append(self._path, row)
        self._rows.append(row)
        return correct

    def _recorded(self, trial: Trial) -> bool:
        row = self._rows[trial.number]
        differing = [name for name, value in asdict(trial).items() if row.get(name) != value]
        if differing:
            name = differing[0]
            raise ExperimentError(
                f"trial {trial.number} had {name} {row.get(name)!r}, and would now have {asdict(trial)[name]!r}: go on "
                "with the same methods, blocks and seeds, or give another folder"
            )
        return bool(row["correct"])

    def _now_s(self) -> float:
        return round(time.monotonic() - self._begin_s, 6)


def _sha256(content: str | bytes) -> str:
    return hashlib.sha256(content.encode() if isinstance(content, str) else content).hexdigest()


def _check_manifest(path: Path, manifest: dict[str, Any]) -> None:
    if not path.exists():
        written = path.with_suffix(".partial")
        written.write_text(json.dumps(manifest, indent=2) + "\n", encoding="utf-8")
        written.replace(path)
        return
    try:
        earlier = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ExperimentError(f"{path.name} is no manifest ({error}): give another folder") from error
    for name, value in manifest.items():
        if not isinstance(earlier, dict) or earlier.get(name) != value:
            found = earlier.get(name) if isinstance(earlier, dict) else None
            raise ExperimentError(
                f"this folder is that of another session: {name} is {found!r} there, and {value!r} here: "
                "give another folder"
            )


def _rows(path: Path) -> list[dict[str, Any]]:
    """The whole lines of a file. What a crash has left of a line is cut off."""
    if not path.exists():
        return []
    content = path.read_bytes()
    whole = content[: content.rfind(b"\n") + 1]
    if len(whole) < len(content):
        with path.open("r+b") as file:
            file.truncate(len(whole))
    rows = []
    for number, line in enumerate(whole.splitlines()):
        try:
            row = json.loads(line)
        except ValueError as error:
            raise ExperimentError(
                f"line {number + 1} of {path.name} is no trial ({error}): mend or remove it"
            ) from error
        rows.append(row)
    return rows


def _append(path: Path, row: dict[str, Any]) -> None:
    """Adds a line, and waits until the disk has it. A line that does not fit is cut off again."""
    line = (json.dumps(row) + "\n").encode()
    before = path.stat().st_size if path.exists() else 0
    try:
        with path.open("ab") as file:
            file.write(line)
            file.flush()
            os.fsync(file.fileno())
    except OSError as error:
        if path.exists():
            os.truncate(path, before)
        raise ExperimentError(
            f"the answer of trial {row['number']} cannot be written ({error.strerror}): the trials before it are kept; "
            "check the free space, and run the session again"
        ) from error


def _locked(path: Path) -> BinaryIO:
    """A file that one process at a time has locked, until it closes it or ends."""
    file = path.open("ab")
    try:
        if os.name == "nt":
            import msvcrt

            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        file.close()
        raise ExperimentError(
            "another process writes into this folder: wait for its end, or give another one"
        ) from error
    return file
