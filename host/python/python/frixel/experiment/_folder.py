"""The folder of a session, which survives a kill, a full disk and a power cut."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import re
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, BinaryIO

from .. import _frixel
from .._files import read_bytes
from ..errors import FrixelError
from ..recording import Recording

RECORDINGS = "recordings"
"""The folder of the recordings, and their key in the manifest."""

_RECORDING = re.compile(RECORDINGS + r"/[0-9a-f]{64}\.parquet")


class ExperimentError(FrixelError):
    """An error that prevents a session from beginning or going on, with what to do."""


class Folder:
    """`manifest.json`, `trials.jsonl` with a line for each answered trial, and `recordings`.

    A recording is written first, then the manifest that names it, then the line of its trial: a kill at any moment
    leaves the folder consistent.
    """

    def __init__(self, path: Path, manifest: dict[str, Any]) -> None:
        self._path = path
        try:
            if not path.is_dir():
                path.mkdir(parents=True, exist_ok=True)
                _sync_folder(path.parent)
        except OSError as error:
            raise ExperimentError(f"the folder {path} cannot be made ({error.strerror}): give another") from error
        self._lock = _locked(path / ".lock")
        try:
            self._manifest = self._begun(manifest)
            self.rows = _rows(path / "trials.jsonl")
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Lets another process write into the folder."""
        if not self._lock.closed:
            _unlock(self._lock)
            self._lock.close()

    def keep(self, recordings: Sequence[Recording], participant: str) -> list[str]:
        """Writes recordings, each under the SHA-256 of its bytes, and then their names into the manifest.

        Returns their paths in the folder.
        """
        self.check_open()
        names = [self._kept(recording, participant) for recording in recordings]
        scenes = {
            name: {"scene": sha256(recording.scene.text.encode())}
            for name, recording in zip(names, recordings, strict=True)
        }
        if not scenes.keys() <= self._manifest[RECORDINGS].keys():
            every = {**self._manifest[RECORDINGS], **scenes}
            self._write_manifest({**self._manifest, RECORDINGS: dict(sorted(every.items()))})
        return names

    def _kept(self, recording: Recording, participant: str) -> str:
        folder = self._path / RECORDINGS
        try:
            if not folder.is_dir():
                folder.mkdir()
                _sync_folder(self._path)
            content = recording._parquet(participant)
        except (OSError, FrixelError) as error:
            raise _unwritable("a recording", error) from error
        name = f"{RECORDINGS}/{sha256(content)}.parquet"
        # A file of this name has the same content.
        write(self._path / name, content, "a recording", overwrite=True)
        return name

    def recording(self, name: str) -> bytes:
        """The bytes of a recording, checked against its SHA-256."""
        try:
            content = read_bytes(self._path / name, ExperimentError)
        except ExperimentError as error:
            raise ExperimentError(f"{error}, or take it from a copy") from error
        found = sha256(content)
        if found != Path(name).stem:
            raise ExperimentError(f"{name} was changed: its SHA-256 is {found}; take it from a copy")
        return content

    def append(self, row: dict[str, Any]) -> None:
        """Adds a line, and waits until it is on the disk. Removes a line that does not fit.

        A line that was complete before an interrupt counts as a row.
        """
        self.check_open()
        path = self._path / "trials.jsonl"
        line = (json.dumps(row) + "\n").encode()
        before = path.stat().st_size if path.exists() else None
        whole = (before or 0) + len(line)
        try:
            with path.open("ab") as file:
                file.write(line)
                file.flush()
                os.fsync(file.fileno())
            if before is None:
                _sync_folder(self._path)
        except OSError as error:
            # If the part of a line cannot be removed now, opening the folder removes it.
            with suppress(OSError):
                os.truncate(path, before or 0)
            answer = f"the answer of trial {row['number']}"
            raise _unwritable(answer, error) from error
        except BaseException:
            if path.exists() and path.stat().st_size == whole:
                self.rows.append(row)
            raise
        self.rows.append(row)

    def check_open(self) -> None:
        """Refuses a folder that is closed."""
        if self._lock.closed:
            raise ExperimentError("this session is closed: open it again to resume it")

    def _begun(self, manifest: dict[str, Any]) -> dict[str, Any]:
        """The manifest of the folder, checked against this one; a new one if the folder has none."""
        path = self._path / "manifest.json"
        if not path.exists():
            begun = {**manifest, RECORDINGS: {}}
            self._write_manifest(begun)
            return begun
        try:
            earlier = json.loads(read_bytes(path, ExperimentError))
        except ValueError as error:
            raise ExperimentError(f"{path.name} is not a manifest ({error}): give another folder") from error
        for name, value in manifest.items():
            found = earlier.get(name) if isinstance(earlier, dict) else None
            if found == value:
                continue
            differs = f"{name} is {found!r} there, and {value!r} here"
            if isinstance(found, dict) and isinstance(value, dict):
                # The values are hashes.
                keys = [key for key in {**found, **value} if found.get(key) != value.get(key)]
                differs = f"{name} differs in {', '.join(keys)}"
            raise ExperimentError(f"this folder belongs to another session: {differs}: give another folder")
        return {RECORDINGS: {}, **earlier}

    def _write_manifest(self, manifest: dict[str, Any]) -> None:
        write(self._path / "manifest.json", (json.dumps(manifest, indent=2) + "\n").encode(), "the manifest")
        self._manifest = manifest


def write(path: Path, content: bytes, what: str, *, overwrite: bool = False) -> None:
    """Writes a file under a temporary name and renames it when complete. `what` is its name in messages.

    Replaces a recording of a person only with `overwrite`.
    """
    try:
        _frixel.write_files({path: content}, overwrite)
    except FrixelError as error:
        raise _unwritable(what, error) from error


def sha256(content: bytes) -> str:
    """The SHA-256 in hexadecimal digits."""
    return hashlib.sha256(content).hexdigest()


def _unwritable(what: str, error: Exception) -> ExperimentError:
    reason = error.strerror if isinstance(error, OSError) else str(error)
    return ExperimentError(
        f"{what} cannot be written ({reason}): all answered trials are kept; check the free space, and run the session "
        "again"
    )


def _sync_folder(path: Path) -> None:
    """Waits until the names in a folder are on the disk."""
    if os.name == "posix":
        folder = os.open(path, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)


def _rows(path: Path) -> list[dict[str, Any]]:
    """The whole lines of a file. Removes the part of a line that a crash has left."""
    if not path.exists():
        return []
    content = read_bytes(path, ExperimentError)
    whole = content[: content.rfind(b"\n") + 1]
    if len(whole) < len(content):
        with path.open("r+b") as file:
            file.truncate(len(whole))
    rows = []
    for number, line in enumerate(whole.splitlines()):
        try:
            row = json.loads(line)
        except ValueError as error:
            raise _no_trial(path, number, str(error)) from error
        if (wrong := _mistake(row, number)) is not None:
            raise _no_trial(path, number, wrong)
        rows.append(row)
    return rows


def _mistake(row: object, number: int) -> str | None:
    """The mistake in the row of a trial; `None` if it is valid."""
    if not isinstance(row, dict):
        return "it is not an object"
    kinds = {"number": int, "run": int, "response": int, "correct": bool, "plays": list}
    for name, kind in kinds.items():
        if type(row.get(name)) is not kind:
            return f"{name} is {row.get(name)!r}"
    if row["number"] != number:
        return f"number is {row['number']}, expected {number}"
    for play in row["plays"]:
        recording = play.get("recording") if isinstance(play, dict) else None
        # Only the name of a file that a session writes, not any other path.
        if not (isinstance(recording, str) and _RECORDING.fullmatch(recording)):
            return f"the recording of a play is {recording!r}"
    return None


def _no_trial(path: Path, number: int, reason: str) -> ExperimentError:
    return ExperimentError(
        f"line {number + 1} of {path.name} is not a trial ({reason}): take the file from a copy, or cut it before "
        "this line to resume the session there"
    )


def _locked(path: Path) -> BinaryIO:
    """A file that this process has locked exclusively, until `_unlock` or its end."""
    taken = ExperimentError("another process is writing to this folder: wait until it ends, or give another one")
    try:
        file = path.open("ab")
    except OSError as error:
        raise _unlockable(error) from error
    try:
        if os.name == "nt":
            import msvcrt

            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined,unused-ignore]
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        file.close()
        is_taken = isinstance(error, BlockingIOError) or error.errno == errno.EACCES
        raise (taken if is_taken else _unlockable(error)) from error
    return file


def _unlockable(error: OSError) -> ExperimentError:
    return ExperimentError(f"this folder cannot be locked ({error.strerror}): give one on a local disk to write into")


def _unlock(file: BinaryIO) -> None:
    """Lets another process lock the file, even if a fork of this one still has it open."""
    if os.name == "nt":
        import msvcrt

        file.seek(0)
        msvcrt.locking(file.fileno(), msvcrt.LK_UNLCK, 1)  # type: ignore[attr-defined,unused-ignore]
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_UN)
