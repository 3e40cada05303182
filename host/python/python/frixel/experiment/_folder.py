"""The folder of a session: what is on the disk survives a kill, a full disk and a power cut."""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path
from typing import Any, BinaryIO

from ..errors import FrixelError
from ..recording import Recording

RECORDINGS = "recordings"
"""The folder of the recordings, and their key in the manifest."""


class ExperimentError(FrixelError):
    """Why a session cannot begin or go on, and what to do."""


class Folder:
    """`manifest.json`, `trials.jsonl` with a line for each answered trial, and `recordings`.

    Everything is written in an order that a kill at any moment leaves whole: a recording, the manifest that names it,
    the line of the trial that has it.
    """

    def __init__(self, path: Path, manifest: dict[str, Any]) -> None:
        self._path = path
        try:
            path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ExperimentError(f"the folder {path} cannot be made ({error.strerror}): give another one") from error
        self._lock = _locked(path / ".lock")
        try:
            self._manifest = self._begun(manifest)
            self.rows = _rows(path / "trials.jsonl")
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Lets another process write into the folder."""
        self._lock.close()

    def keep(self, recording: Recording, participant: str) -> str:
        """Writes a recording under the SHA-256 of its bytes, and into the manifest. Returns its path in the folder."""
        self._check_open()
        folder = self._path / RECORDINGS
        partial = folder / ".partial"
        try:
            folder.mkdir(exist_ok=True)
            recording.to_parquet(partial, participant=participant)
            name = f"{RECORDINGS}/{sha256(partial.read_bytes())}.parquet"
            _commit(partial, self._path / name)
        except (OSError, FrixelError) as error:
            partial.unlink(missing_ok=True)
            raise _unwritable("a recording", error, "check the free space, and run the session again") from error
        if name not in self._manifest[RECORDINGS]:
            scene = {"scene": sha256(recording.scene.text.encode())}
            recordings = {**self._manifest[RECORDINGS], name: scene}
            self._write_manifest({**self._manifest, RECORDINGS: dict(sorted(recordings.items()))})
        return name

    def recording(self, name: str) -> Path:
        """The path of a recording, whose bytes are those that were written."""
        path = self._path / name
        try:
            found = sha256(path.read_bytes())
        except OSError as error:
            raise ExperimentError(f"{name} cannot be read ({error.strerror}): take it from a copy") from error
        if found != path.stem:
            raise ExperimentError(f"{name} was changed: its SHA-256 is {found}; take it from a copy")
        return path

    def append(self, row: dict[str, Any]) -> None:
        """Adds a line, and waits until the disk has it. A line that does not fit is cut off again."""
        self._check_open()
        path = self._path / "trials.jsonl"
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
            answer = f"the answer of trial {row['number']}"
            raise _unwritable(answer, error, "check the free space, and run the session again") from error
        self.rows.append(row)

    def _check_open(self) -> None:
        if self._lock.closed:
            raise ExperimentError("this session is closed: open it again, and it goes on")

    def _begun(self, manifest: dict[str, Any]) -> dict[str, Any]:
        """The manifest of the folder, which agrees with this one; a new one if there is none."""
        path = self._path / "manifest.json"
        if not path.exists():
            begun = {**manifest, RECORDINGS: {}}
            self._write_manifest(begun)
            return begun
        try:
            earlier = json.loads(path.read_text(encoding="utf-8"))
        except ValueError as error:
            raise ExperimentError(f"{path.name} is no manifest ({error}): give another folder") from error
        for name, value in manifest.items():
            found = earlier.get(name) if isinstance(earlier, dict) else None
            if found != value:
                raise ExperimentError(
                    f"this folder is that of another session: {name} is {found!r} there, and {value!r} here: "
                    "give another folder"
                )
        return {RECORDINGS: {}, **earlier}

    def _write_manifest(self, manifest: dict[str, Any]) -> None:
        path = self._path / "manifest.json"
        partial = path.with_suffix(".partial")
        try:
            partial.write_text(json.dumps(manifest, indent=2) + "\n", encoding="utf-8")
            _commit(partial, path)
        except OSError as error:
            partial.unlink(missing_ok=True)
            raise _unwritable("the manifest", error, "check the free space, and run the session again") from error
        self._manifest = manifest


def sha256(content: bytes) -> str:
    """The SHA-256 in hexadecimal digits."""
    return hashlib.sha256(content).hexdigest()


def _unwritable(what: str, error: Exception, advice: str) -> ExperimentError:
    reason = error.strerror if isinstance(error, OSError) else str(error)
    return ExperimentError(f"{what} cannot be written ({reason}): all answered trials are kept; {advice}")


def _commit(partial: Path, path: Path) -> None:
    """Gives a file its name once the disk has all of it."""
    with partial.open("rb+") as file:
        os.fsync(file.fileno())
    partial.replace(path)
    if os.name == "posix":
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


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
