"""Tables in CSV, as rows of Python values."""

from __future__ import annotations

import re
from typing import Any

_CELL = re.compile(r'(?:"(?P<text>(?:[^"]|"")*)"|(?P<plain>[^,\n]*))(?P<end>[,\n])')


def rows(table: str) -> list[dict[str, Any]]:
    r"""The rows of a table, by the names of its columns: quoted cells as text, numbers as numbers, empty as `None`.

    >>> rows('layer,felt,share\n"1",2,0.5\n"a, ""b"" c",,maybe\n')
    [{'layer': '1', 'felt': 2, 'share': 0.5}, {'layer': 'a, "b" c', 'felt': None, 'share': 'maybe'}]
    """
    lines: list[list[Any]] = [[]]
    for cell in _CELL.finditer(table):
        text = cell["text"]
        lines[-1].append(_value(cell["plain"]) if text is None else text.replace('""', '"'))
        if cell["end"] == "\n":
            lines.append([])
    names, *values = lines[:-1]
    return [dict(zip(names, row, strict=True)) for row in values]


def _value(cell: str) -> Any:
    if not cell:
        return None
    for kind in (int, float):
        try:
            return kind(cell)
        except ValueError:
            pass
    return cell
