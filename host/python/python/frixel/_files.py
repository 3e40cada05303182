"""Files that the module reads."""

from __future__ import annotations

from os import PathLike

from . import _frixel
from ._arguments import path as checked_path
from .errors import FrixelError


def name_of(path: str | PathLike[str]) -> str:
    """The name of a file in messages: its path, with replacements for what UTF-8 cannot encode."""
    return str(checked_path("path", path)).encode(errors="replace").decode()


def read_bytes(path: str | PathLike[str], error: type[FrixelError], *, is_toml: bool = False) -> bytes:
    """The bytes of a regular file of at most 512 MiB, or 4 MiB if it is TOML.

    Raises an `error` with a sentence.
    """
    try:
        return _frixel.read_file(checked_path("path", path), is_toml)
    except OSError as reason:
        sentence = reason.strerror or reason
        raise error(f"{path} cannot be read ({sentence}): check the path") from reason
