"""Files that the module reads."""

from __future__ import annotations

from os import PathLike

from . import _frixel
from ._arguments import path as checked_path
from .errors import FrixelError


def name_of(path: str | PathLike[str]) -> str:
    """What messages call a file: its path, as far as UTF-8 can hold it."""
    return str(checked_path("path", path)).encode(errors="replace").decode()


def read_bytes(path: str | PathLike[str], what: str, error: type[FrixelError], *, is_toml: bool = False) -> bytes:
    """The bytes of a regular file of at most 512 MiB, 4 MiB if it is TOML, which messages call `what`.

    Raises an `error` with a sentence.
    """
    try:
        return _frixel.read_file(checked_path("path", path), is_toml)
    except OSError as reason:
        sentence = reason.strerror or reason
        raise error(f"{path}: {what} cannot be read ({sentence}): check the path") from reason
