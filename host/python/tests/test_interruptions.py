"""What goes wrong in the middle of an experiment: at most the trial that runs is lost, and a sentence says so."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .interrupted_session import INTERRUPTED
from .test_device import VirtualBoard

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals, limits and pseudo-terminals are those of Unix")

PROGRAM = Path(__file__).with_name("interrupted_session.py")
TRIALS = 6


class Child:
    """The session in a process of its own."""

    def __init__(self, folder: Path, port: str = "sim") -> None:
        command = [sys.executable, str(PROGRAM), str(folder), port]
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, text=True)
        self.markers: list[tuple[str, int]] = []

    def answer_until(self, marker: str | None, number: int = INTERRUPTED) -> bool:
        """Answers each trial until this marker of a trial comes. Whether it came before the program ended."""
        assert self.process.stdout is not None
        for line in self.process.stdout:
            name, trial = line.split()
            self.markers.append((name, int(trial)))
            if self.markers[-1] == (marker, number):
                return True
            if name == "presented":
                self.answer()
        return False

    def answer(self) -> None:
        """Answers the trial that runs."""
        assert self.process.stdin is not None
        self.process.stdin.write("0\n")
        self.process.stdin.flush()

    def ended(self) -> str:
        """What it said on standard error, once it has ended."""
        return self.process.communicate()[1]


def rows(folder: Path) -> list[dict[str, Any]]:
    """The whole lines of a session's file."""
    return [
        json.loads(line) for line in (folder / "trials.jsonl").read_text().splitlines(keepends=True) if "\n" in line
    ]


def goes_on(folder: Path, before: list[dict[str, Any]], start: Callable[[], Child]) -> None:
    """The same program ends the session: the answers of before are still there, and each other trial comes once."""
    assert [row["number"] for row in before] == list(range(INTERRUPTED))
    child = start()
    assert not child.answer_until(None)
    said = child.ended()
    assert child.process.returncode == 0, said
    assert "the session goes on with trial 2: those before it are answered" in said
    assert [number for name, number in child.markers if name == "began"] == list(range(INTERRUPTED, TRIALS))
    after = rows(folder)
    assert after[:INTERRUPTED] == before
    assert [row["number"] for row in after] == list(range(TRIALS))
    kept = {path.name for path in (folder / "recordings").iterdir()}
    manifest = json.loads((folder / "manifest.json").read_text())
    assert (
        {Path(name).name for name in manifest["recordings"]}
        == kept
        >= {Path(play["recording"]).name for row in after for play in row["plays"]}
    )


@pytest.mark.parametrize("marker", ["began", "play", "presented"])
def test_a_killed_process_has_lost_the_trial_that_ran(tmp_path: Path, marker: str) -> None:
    child = Child(tmp_path)
    assert child.answer_until(marker)
    child.process.kill()
    child.ended()
    goes_on(tmp_path, rows(tmp_path), lambda: Child(tmp_path))


@pytest.mark.parametrize("what", ["a recording", "the answer of trial 2"])
def test_a_full_disk_loses_the_trial_that_ran(tmp_path: Path, what: str) -> None:
    import resource

    child = Child(tmp_path)
    assert child.answer_until("presented")
    written = [path.stat().st_size for path in (tmp_path / "recordings").iterdir()]
    # The limit of the process stands for the disk: a write beyond it fails in the middle.
    trials = tmp_path / "trials.jsonl"
    if what == "a recording":
        room = min(written) // 2
    else:
        # Spaces at the end of the last line: recordings fit below the limit, and the next line does not.
        trials.write_text(trials.read_text()[:-1] + " " * (2 * max(written)) + "\n")
        room = trials.stat().st_size + 20
    resource.prlimit(child.process.pid, resource.RLIMIT_FSIZE, (room, room))
    child.answer()
    said = child.ended()
    assert child.process.returncode == 1
    assert f"{what} cannot be written (" in said
    assert "File too large" in said
    assert "all answered trials are kept; check the free space, and run the session again" in said
    assert "trial 2 is lost: it was not answered; those before it are kept" in said
    assert not list(tmp_path.rglob("*frixel-tmp")), "what did not fit takes no room"
    goes_on(tmp_path, rows(tmp_path), lambda: Child(tmp_path))


def at_the_interrupted_trial(folder: Path, board: VirtualBoard) -> Child:
    """The session, while its board plays in the trial in which something goes wrong.

    On a busy machine a board may stop before: then the same program goes on, as it is meant to.
    """
    for _ in range(5):
        child = Child(folder, board.port)
        if child.answer_until("active"):
            return child
        child.ended()
    raise AssertionError("the board stopped five times")


def test_a_pulled_cable_loses_the_trial_that_ran(tmp_path: Path) -> None:
    board = VirtualBoard(tmp_path / "board")
    child = at_the_interrupted_trial(tmp_path, board)
    board.server.kill()
    board.server.communicate()
    said = child.ended()
    assert child.process.returncode == 1
    assert "frixel.errors.PlayError: " in said
    assert "trial 2 is lost: it was not answered; those before it are kept" in said
    goes_on(tmp_path, rows(tmp_path), lambda: Child(tmp_path))


def test_a_closed_lid_loses_the_trial_that_ran(tmp_path: Path) -> None:
    board = VirtualBoard(tmp_path / "board")
    child = at_the_interrupted_trial(tmp_path, board)
    child.process.send_signal(signal.SIGSTOP)
    # Four times as long as a board waits for its host.
    time.sleep(1.0)
    child.process.send_signal(signal.SIGCONT)
    said = child.ended()
    board.server.kill()
    board.server.communicate()
    assert child.process.returncode == 1
    assert "frixel.errors.PlayError: " in said
    assert "trial 2 is lost: it was not answered; those before it are kept" in said
    goes_on(tmp_path, rows(tmp_path), lambda: Child(tmp_path))
