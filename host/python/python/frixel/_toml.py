"""Dictionaries as the text of a TOML file."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

from ._arguments import refusal
from .errors import ParameterError

NESTING_MAX = 64
"""Largest nesting depth of tables and lists."""

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def dumps(tables: Mapping[str, Any]) -> str:
    """The text of a file with these fields: values first, then tables, then lists of tables."""
    values: list[str] = []
    single: list[str] = []
    repeated: list[str] = []
    for key, value in tables.items():
        plain = _plain(value)
        if isinstance(plain, Mapping):
            single.append(f"\n[{_key(key)}]\n{_lines(plain)}")
        elif isinstance(plain, list) and plain and all(isinstance(item, Mapping) for item in plain):
            repeated.extend(f"\n[[{_key(key)}]]\n{_lines(item)}" for item in plain)
        else:
            values.append(f"{_key(key)} = {_inline(plain)}\n")
    return "".join(values + single + repeated)


def _lines(table: Mapping[str, Any]) -> str:
    return "".join(f"{_key(key)} = {_inline(_plain(value))}\n" for key, value in table.items())


def _plain(value: Any) -> Any:
    """NumPy's numbers and arrays as Python's own."""
    return value.tolist() if hasattr(value, "tolist") else value


def _key(key: object) -> str:
    if not isinstance(key, str):
        raise refusal("the name of a field", "a string", key)
    return key if _BARE_KEY.fullmatch(key) else _text(key)


def _text(text: str) -> str:
    # TOML, unlike JSON, requires the delete character to be escaped.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _inline(value: Any, depth: int = 0) -> str:
    if depth > NESTING_MAX:
        raise ParameterError(f"tables and lists may be nested at most {NESTING_MAX} deep: flatten them")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, int) and not -(2**63) <= value < 2**63:
        raise refusal("a whole number", "one of 64 bits", value)
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, Mapping):
        return (
            "{ " + ", ".join(f"{_key(key)} = {_inline(_plain(item), depth + 1)}" for key, item in value.items()) + " }"
        )
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_inline(_plain(item), depth + 1) for item in value) + "]"
    raise refusal("a field", "a string, a number, a list or a table", value)
