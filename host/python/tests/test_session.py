"""Sessions: answers, recordings, and how they go on."""

from __future__ import annotations

import errno
import hashlib
import itertools
import json
import os
import re
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as parquet
import pytest
from frixel import Device, ParameterError, PlayError, Recording, Scene, Simulator, Stroke
from frixel.experiment import (
    SAME_DIFFERENT,
    TWO_ALTERNATIVES,
    Answers,
    ConstantStimuli,
    ExperimentError,
    Grid,
    Method,
    Observer,
    QuestPlus,
    Session,
    Trial,
    UpDown,
    _session,
)
from frixel.experiment.coverage import LEVELS

TEXTS = {"bars.toml": "version = 1\n"}


class Person:
    """Answers by a simulated observer, and counts what was presented."""

    def __init__(self, fails_at: int | None = None) -> None:
        self.presented: list[Trial] = []
        self._fails_at = fails_at

    def play(self, trial: Trial) -> None:
        if trial.number == self._fails_at:
            raise KeyboardInterrupt
        self.presented.append(trial)

    def answer(self, trial: Trial) -> int:
        observer = Observer(0.12, seed=trial.number)
        return trial.target if observer.answers(trial.level, TWO_ALTERNATIVES) else 1 - trial.target


def opened(folder: Path, **changed: Any) -> Session:
    settings: dict[str, Any] = {"participant": "p01", "task": TWO_ALTERNATIVES, "seed": 7, "played": TEXTS, **changed}
    return Session(folder, **settings)


def run(session: Session, person: Person) -> Answers:
    method = QuestPlus(LEVELS, TWO_ALTERNATIVES, trials=12, grid=Grid(np.geomspace(0.01, 1.0, 15)))
    return session.run(method, person.play, person.answer, practice=[1.0, 1.0], catch_every=5)


def what_happened(row: dict[str, Any]) -> dict[str, Any]:
    """A row without what differs from run to run."""
    return {key: value for key, value in row.items() if not key.endswith("_s") and key != "run"}


def test_a_session_that_was_cut_off_goes_on_without_repeating_an_answer(tmp_path: Path) -> None:
    with opened(tmp_path / "whole") as session:
        whole, person = run(session, Person()), Person()
        rows = session.rows
    with opened(tmp_path / "cut") as session:
        with pytest.raises(KeyboardInterrupt):
            run(session, Person(fails_at=6))
        with pytest.raises(ExperimentError, match="open the session again"):
            run(session, Person())
    # As a crash in the middle of a write leaves it.
    with (tmp_path / "cut" / "trials.jsonl").open("ab") as file:
        file.write(b'{"number": 6, "bl')
    with opened(tmp_path / "cut") as session:
        assert len(session.rows) == 6
        assert run(session, person).table == whole.table
        without_times = [what_happened(row) for row in session.rows]
    assert [trial.number for trial in person.presented] == list(range(6, 16))
    assert without_times == [what_happened(row) for row in rows]
    assert [row["run"] for row in session.rows] == [0] * 6 + [1] * 10
    assert sum(row["is_practice"] for row in rows) == 2
    assert [row["level"] for row in rows if row["is_catch"]] == [0.0, 0.0]


def test_the_manifest_hashes_what_was_played_and_names_nobody(tmp_path: Path) -> None:
    opened(tmp_path).close()
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    assert manifest["played"] == {"bars.toml": "dbab12665d98aef021ba64953c61b0ed8a908cfb56a1c01e2fcb4b052b71a2a1"}
    assert str(tmp_path) not in (tmp_path / "manifest.json").read_text()
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"participant": "p02"}, "participant is 'p01' there, and 'p02' here"),
        ({"seed": 8}, "seed is 7 there"),
        ({"played": {"bars.toml": "version = 1\n# other\n"}}, "session: played differs in bars.toml: give"),
        ({"task": "2afc"}, "a task must be TWO_ALTERNATIVES or SAME_DIFFERENT, but is '2afc'"),
    ]
    for changed, said in wrong:
        with pytest.raises((ExperimentError, ParameterError), match=said):
            opened(tmp_path, **changed)
    values: list[tuple[dict[str, Any], str]] = [
        ({"seed": "7"}, "seed must be a whole number from 0"),
        ({"participant": "Jane Doe"}, r"use a code of 1 to 32 letters, digits, -, _ and \., not a name"),
        ({"participant": 7}, "participant 7: use a code"),
    ]
    for changed, said in values:
        with pytest.raises(ParameterError, match=said):
            opened(tmp_path, **changed)
    with pytest.raises(ExperimentError, match=r"cannot be made \(File exists\): give another"):
        opened(tmp_path / "manifest.json")


def test_a_session_has_one_writer(tmp_path: Path) -> None:
    with opened(tmp_path), pytest.raises(ExperimentError, match="another process is writing"):
        opened(tmp_path)
    session = opened(tmp_path)
    session.close()
    with pytest.raises(ExperimentError, match="this session is closed: open it again"):
        session.play(plates(0.1), stroke=STROKE)


def test_another_method_is_not_gone_on_with(tmp_path: Path) -> None:
    with opened(tmp_path) as session:
        session.run(ConstantStimuli([0.1, 0.2], 2), lambda trial: None, lambda trial: 0)
    with opened(tmp_path) as session, pytest.raises(ExperimentError, match="trial 0 had level"):
        session.run(ConstantStimuli([0.3, 0.4], 2), lambda trial: None, lambda trial: 0)


def test_a_method_presents_its_trials_in_one_run(tmp_path: Path) -> None:
    methods: list[Method] = [
        ConstantStimuli([0.1], 2),
        UpDown(0.1, trials=2),
        QuestPlus([0.1, 0.2], TWO_ALTERNATIVES, trials=2),
    ]
    for number, method in enumerate(methods):
        with opened(tmp_path / f"{number}") as session:
            assert len(session.run(method, lambda trial: None, lambda trial: 0)) == 2
            with pytest.raises(ParameterError, match="another run: make a new one for each `run`"):
                session.run(method, lambda trial: None, lambda trial: 0)
        with opened(tmp_path / f"next-{number}") as session:
            with pytest.raises(ParameterError, match="another run: make a new one for each `run`"):
                session.run(method, lambda trial: None, lambda trial: 0)
            assert session.rows == []


def test_a_method_is_for_the_task_of_its_session(tmp_path: Path) -> None:
    with opened(tmp_path) as session:
        method = QuestPlus([0.1, 0.2], SAME_DIFFERENT, trials=2)
        said = "the method is for the task same-different, and the session for 2afc: give both"
        with pytest.raises(ParameterError, match=said):
            session.run(method, lambda trial: None, lambda trial: 0)
        assert session.rows == []


def test_an_answer_that_is_none_is_refused(tmp_path: Path) -> None:
    for answer in (2, True, np.bool_(False)):
        said = re.escape(f"an answer must be 0 or 1, but is {answer!r}: write int(...)")
        with opened(tmp_path) as session, pytest.raises(ExperimentError, match=said):
            session.run(ConstantStimuli([0.1], 1), lambda trial: None, lambda trial, answer=answer: answer)  # type: ignore[misc]
    assert not (tmp_path / "trials.jsonl").exists()


def test_breaks_come_between_trials_and_not_while_answers_are_read_again(tmp_path: Path) -> None:
    breaks: list[int] = []
    settings: dict[str, Any] = {"break_every": 2, "on_break": breaks.append}
    with opened(tmp_path) as session:
        session.run(ConstantStimuli([0.1], 4), lambda trial: None, lambda trial: 0, **settings)
    assert breaks == [2, 4]
    with opened(tmp_path) as session:
        session.run(ConstantStimuli([0.1], 4), lambda trial: None, lambda trial: 0, **settings)
    assert breaks == [2, 4, 4]


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda row: {}, "number is None"),
        (lambda row: [row], "it is not an object"),
        (lambda row: {**row, "number": 0}, "number is 0, expected 1"),
        (lambda row: {**row, "run": None}, "run is None"),
        (lambda row: {**row, "correct": 1}, "correct is 1"),
        (lambda row: {**row, "plays": [{"recording": "../../secret.parquet"}]}, "the recording of a play is '../../"),
    ],
)
def test_a_line_that_is_no_trial_is_said_and_the_rest_is_kept(
    tmp_path: Path, change: Callable[[dict[str, Any]], object], reason: str
) -> None:
    with opened(tmp_path) as session:
        session.run(ConstantStimuli([0.1], 3), lambda trial: None, lambda trial: 0)
    path = tmp_path / "trials.jsonl"
    lines = path.read_text().splitlines()
    lines[1] = json.dumps(change(json.loads(lines[1])))
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(ExperimentError, match=re.escape(f"line 2 of trials.jsonl is not a trial ({reason}")) as raised:
        opened(tmp_path)
    assert "take the file from a copy, or cut it before this line" in str(raised.value)
    path.write_text(lines[0] + "\n")
    with opened(tmp_path) as session:
        assert len(session.rows) == 1, "the folder is not locked, and what was said helps"


@pytest.mark.skipif(os.name != "posix", reason="locks are those of Unix")
def test_a_folder_that_cannot_be_locked_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import fcntl

    def no_locks(*_: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    with monkeypatch.context() as patched:
        patched.setattr(fcntl, "flock", no_locks)
        with pytest.raises(ExperimentError, match=r"cannot be locked \(No locks available\)"):
            opened(tmp_path)
    (tmp_path / ".lock").unlink()
    (tmp_path / ".lock").mkdir()
    with pytest.raises(ExperimentError, match=r"cannot be locked \(Is a directory\)"):
        opened(tmp_path)


@pytest.mark.skipif(os.name != "posix", reason="processes fork as on Unix")
def test_a_closed_session_is_free_although_a_fork_lives_on(tmp_path: Path) -> None:
    session = opened(tmp_path)
    # As a forked worker has it: the same open file.
    copy = os.dup(session._folder._lock.fileno())
    session.close()
    opened(tmp_path).close()
    os.close(copy)


def test_an_interrupt_after_the_answer_is_on_the_disk_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    fsync = os.fsync
    with opened(tmp_path) as session:

        def interrupted(file: int) -> None:
            fsync(file)
            raise KeyboardInterrupt

        def answer(trial: Trial) -> int:
            monkeypatch.setattr(os, "fsync", interrupted)
            return 0

        with pytest.raises(KeyboardInterrupt):
            session.run(ConstantStimuli([0.1], 2), lambda trial: None, answer)
        monkeypatch.undo()
        assert len(session.rows) == 1
    assert "is lost" not in caplog.text
    with opened(tmp_path) as session:
        assert len(session.rows) == 1


def test_answered_is_marked_when_the_disk_has_the_answer(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    path = tmp_path / "trials.jsonl"
    lines: list[int] = []

    def on_marker(marker: str, trial: Trial) -> None:
        if marker == "answered":
            lines.append(path.read_bytes().count(b"\n"))
            raise KeyboardInterrupt

    with opened(tmp_path, on_marker=on_marker) as session, pytest.raises(KeyboardInterrupt):
        session.run(ConstantStimuli([0.1], 2), lambda trial: None, lambda trial: 0)
    assert lines == [1]
    assert "is lost" not in caplog.text


def test_a_closed_session_begins_no_trial(tmp_path: Path) -> None:
    markers: list[str] = []
    session = opened(tmp_path, on_marker=lambda marker, trial: markers.append(marker))
    session.close()
    with pytest.raises(ExperimentError, match="this session is closed: open it again"):
        session.run(ConstantStimuli([0.1], 1), lambda trial: None, lambda trial: 0)
    assert markers == []


STROKE = Stroke.straight((20, 40), (40, 40), speed_mm_s=100)


def plates(level: float) -> Scene:
    """A plate whose friction is higher by this part."""
    return Scene.from_dict({"layer": [{"kind": "constant", "above": "zero", "friction_n": 0.28 * (1 + level)}]})


def played(folder: Path, levels: list[float], **settings: Any) -> list[dict[str, Any]]:
    """The rows of a session that plays two plates in each trial on the simulator."""
    with opened(folder, played=None, **settings) as session:

        def play(trial: Trial) -> None:
            for number in range(2):
                level = trial.level if number == trial.target else 0.0
                session.play(plates(level), stroke=STROKE, ideal=True)

        session.run(ConstantStimuli(levels, 2), play, lambda trial: trial.target)
        return session.rows


def test_every_play_is_recorded_and_a_trial_is_replayed_bit_for_bit(tmp_path: Path) -> None:
    rows = played(tmp_path, [0.1, 0.2])
    assert [len(row["plays"]) for row in rows] == [2] * 4
    files = {play["recording"] for row in rows for play in row["plays"]}
    assert len(files) == 3, "equal plays have one file: two levels and the standard"
    with opened(tmp_path, played=None) as session:
        assert session.replay(2) == 2
        with pytest.raises(ExperimentError, match="trial 4 is not answered: there are 4"):
            session.replay(4)
        with pytest.raises(ParameterError, match="number must be a whole number from 0"):
            session.replay(-1)
    recording = tmp_path / rows[0]["plays"][0]["recording"]
    command = subprocess.run([os.environ["FRIXEL"], "replay", recording], capture_output=True, text=True, check=True)
    assert command.stdout.endswith("the same bits, 200 rows of 12 columns\n")


def test_the_manifest_has_the_hash_of_all_that_was_played_by_itself(tmp_path: Path) -> None:
    rows = played(tmp_path, [0.1, 0.2])
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    plays = {play["recording"]: {"scene": play["scene"]} for row in rows for play in row["plays"]}
    assert manifest["recordings"] == plays
    for name in manifest["recordings"]:
        content = (tmp_path / name).read_bytes()
        assert Path(name).stem == hashlib.sha256(content).hexdigest()
    texts = {hashlib.sha256(plates(level).text.encode()).hexdigest() for level in (0.0, 0.1, 0.2)}
    assert {play["scene"] for play in plays.values()} == texts
    metadata = parquet.read_metadata(tmp_path / next(iter(plays))).metadata
    assert json.loads(metadata[b"frixel.recording"])["participant"] == "p01"


@pytest.mark.skipif(os.name != "posix", reason="folders are synchronised as on Unix")
def test_a_new_name_is_on_the_disk_before_the_next_trial(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # The names of the files that the compiled part writes are tested in `host/files`.
    fsync = os.fsync
    named: set[Path] = set()

    def watched(file: int) -> None:
        fsync(file)
        for folder in [path for path in [tmp_path, *tmp_path.rglob("*")] if path.is_dir()]:
            if os.path.samestat(os.fstat(file), folder.stat()):
                named.update(folder.iterdir())

    monkeypatch.setattr(os, "fsync", watched)
    folder = tmp_path / "session"
    with opened(folder, played=None) as session:

        def play(trial: Trial) -> None:
            session.play(plates(trial.level), stroke=STROKE, ideal=True)
            if trial.number == 1:
                assert {folder / name for name in ["", "trials.jsonl", "recordings"]} <= named

        session.run(ConstantStimuli([0.1], 2), play, lambda trial: 0)


def test_a_recording_that_was_changed_is_not_replayed(tmp_path: Path) -> None:
    rows = played(tmp_path, [0.1])
    path = tmp_path / rows[0]["plays"][0]["recording"]
    path.write_bytes(path.read_bytes() + b" ")
    with opened(tmp_path, played=None) as session, pytest.raises(ExperimentError, match="was changed: its SHA-256 is"):
        session.replay(0)
    path.unlink()
    with opened(tmp_path, played=None) as session, pytest.raises(ExperimentError, match="take it from a copy"):
        session.replay(0)


def test_a_session_says_what_cannot_be_played(tmp_path: Path) -> None:
    with opened(tmp_path) as session, Device.open("sim") as device:
        with pytest.raises(ParameterError, match=r"a board from Device\.open, but is 'sim'"):
            session.play(plates(0.1), on="sim", seconds=1)  # type: ignore[arg-type]
        with pytest.raises(ParameterError, match="accepts `seconds`, but no settings"):
            session.play(plates(0.1), on=device)
        with pytest.raises(ParameterError, match="accepts `seconds`, but no settings"):
            session.play(plates(0.1), on=device, seconds=0.1, seed=3)
        session.run(ConstantStimuli([0.1], 1), lambda trial: None, lambda trial: 0)
        with pytest.raises(ExperimentError, match="no trial is running that this play could belong to"):
            session.play(plates(0.1), stroke=STROKE)
        assert session.rows[0]["plays"] == []
        with pytest.raises(ExperimentError, match="played nothing through its session"):
            session.replay(0)


def test_a_play_for_less_than_no_time_is_refused_before_it_begins(tmp_path: Path) -> None:
    markers: list[str] = []
    with (
        opened(tmp_path, on_marker=lambda marker, trial: markers.append(marker)) as session,
        Device.open("sim") as device,
    ):
        with pytest.raises(ParameterError, match=r"seconds must be a number from 0\.001"):
            session.run(
                ConstantStimuli([0.1], 1),
                lambda trial: session.play(plates(0.1), on=device, seconds=-1),
                lambda trial: 0,
            )
        assert device.state == "disarmed"
    assert markers == ["began"]


def test_a_session_plays_on_a_board_and_has_its_clock(tmp_path: Path) -> None:
    with opened(tmp_path) as session, Device.open("sim") as device:

        def play(trial: Trial) -> None:
            recording = session.play(plates(trial.level), on=device, seconds=0.5)
            assert recording["commanded_n"].max() > recording.scene.reach_n[0] + 0.01
            assert np.isnan(recording["felt_n"]).all()

        session.run(ConstantStimuli([0.1], 2), play, lambda trial: 0)
        first, second = (row["plays"][0] for row in session.rows)
        assert second["board_s"] - first["board_s"] >= 0.49
        table = parquet.read_table(tmp_path / first["recording"])
        assert table["t_s"][0].as_py() == 0
        assert table["t_s"][-1].as_py() == pytest.approx(0.49, abs=0.02)
        assert json.loads(parquet.read_metadata(tmp_path / first["recording"]).metadata[b"frixel.recording"])["tick_hz"]
        with pytest.raises(PlayError, match="cannot be played again: it was made on a virtual board"):
            session.replay(0)


def test_times_have_nothing_of_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Each look at the clock is a second, and each write a thousand.
    now_s = itertools.count(1.0)
    writes: list[float] = []
    parquet_of = Recording._parquet

    def slow(recording: Recording, participant: str | None) -> bytes:
        writes.extend(next(now_s) for _ in range(1000))
        return parquet_of(recording, participant)

    monkeypatch.setattr(time, "monotonic", lambda: next(now_s))
    monkeypatch.setattr(Recording, "_parquet", slow)
    for row in played(tmp_path, [0.1]):
        times = [row["played_s"], *(play[name] for play in row["plays"] for name in ("began_s", "ended_s"))]
        times += [row["presented_s"], row["answered_s"]]
        assert times == sorted(times)
        assert times[-1] - times[0] < 20
    assert len(writes) == 2000, "each of the two plays was written once"


def test_a_play_on_a_board_begins_when_the_board_plays(tmp_path: Path) -> None:
    states: list[str] = []

    def on_marker(marker: str, trial: Trial) -> None:
        if marker == "play":
            states.append(device._state)

    with opened(tmp_path, on_marker=on_marker) as session, Device.open("sim") as device:
        session.run(
            ConstantStimuli([0.1], 2),
            lambda trial: session.play(plates(trial.level), on=device, seconds=0.2),
            lambda trial: 0,
        )
    assert states == ["active", "active"]


def test_what_is_kept_for_the_same_play_has_a_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    runs: list[Simulator] = []
    run_it = Simulator.run

    def counted(simulator: Simulator, seconds: float | None = None) -> Recording:
        runs.append(simulator)
        return run_it(simulator, seconds)

    monkeypatch.setattr(Simulator, "run", counted)
    played(tmp_path / "all", [0.1, 0.2])
    assert len(runs) == 3, "two levels and the standard"
    runs.clear()
    monkeypatch.setattr(_session, "KEPT_MAX_BYTES", 1)
    played(tmp_path / "none", [0.1, 0.2])
    assert len(runs) == 8


def test_markers_come_at_their_moments(tmp_path: Path) -> None:
    markers: list[tuple[str, int]] = []
    rows = played(tmp_path, [0.1], on_marker=lambda marker, trial: markers.append((marker, trial.number)))
    names = ["began", "play", "play", "presented", "answered"]
    assert markers == [(name, number) for number in range(2) for name in names]
    for row in rows:
        first, second = row["plays"]
        times = [row["played_s"], first["began_s"], first["ended_s"], second["began_s"], second["ended_s"]]
        times += [row["presented_s"], row["answered_s"]]
        assert times == sorted(times)
