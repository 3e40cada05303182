"""Checks of arguments. Each error names the argument, the expected value, and what was found."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from operator import index
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import ParameterError

SHOWN_MAX = 64
"""Largest number of characters of a value in a message."""


def refusal(name: str, expected: str, found: object) -> ParameterError:
    """The exception for an argument that is not as `expected`."""
    return ParameterError(f"{name} must be {expected}, but is {shown(found)}")


def shown(value: object) -> str:
    """A value for messages, cut at 64 characters."""
    try:
        text = repr(value)
    except Exception:
        text = f"<{type(value).__name__}>"
    return text if len(text) <= SHOWN_MAX else text[: SHOWN_MAX - 1] + "…"


def whole(name: str, value: object, least: int, most: int = 2**64 - 1) -> int:
    """A whole number from `least` to `most`."""
    try:
        number = None if isinstance(value, (bool, np.bool_)) else index(value)  # type: ignore[arg-type]
    except TypeError:
        number = None
    if number is None or not least <= number <= most:
        raise refusal(name, f"a whole number from {least} to {most}", value)
    return number


def real(name: str, value: object, expected: str = "a number") -> float:
    """A number, finite or not."""
    if isinstance(value, (str, bytes, bytearray, bool, np.bool_)):
        raise refusal(name, expected, value)
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError) as error:
        raise refusal(name, expected, value) from error


def positive(name: str, value: object) -> float:
    """A finite number above 0."""
    found = real(name, value, "a number above 0")
    if not (math.isfinite(found) and found > 0.0):
        raise refusal(name, "a number above 0", value)
    return found


def number(name: str, value: object, least: float, most: float = math.inf) -> float:
    """A finite number from `least` to `most`."""
    expected = f"a number from {least:g} to {most:g}" if math.isfinite(most) else f"a number from {least:g}"
    found = real(name, value, expected)
    if not (math.isfinite(found) and least <= found <= most):
        raise refusal(name, expected, value)
    return found


def flag(name: str, value: object) -> bool:
    """`True` or `False`, or NumPy's."""
    if not isinstance(value, (bool, np.bool_)):
        raise refusal(name, "True or False", value)
    return bool(value)


def text(name: str, value: object) -> str:
    """A text that can be encoded as UTF-8."""
    if not isinstance(value, str) or any("\ud800" <= character <= "\udfff" for character in value):
        raise refusal(name, "a string", value)
    return value


def path(name: str, value: str | PathLike[str]) -> Path:
    """The path of a file or folder."""
    try:
        found = os.fspath(value)
        os.fsencode(found)
    except (TypeError, UnicodeEncodeError) as error:
        raise refusal(name, "a path", value) from error
    if not isinstance(found, str) or "\0" in found:
        raise refusal(name, "a path", value)
    return Path(found)


def check_callable(name: str, value: object) -> None:
    """Refuse a value that is not callable."""
    if not callable(value):
        raise refusal(name, "a function", value)


def mapping(name: str, value: Mapping[Any, Any]) -> Mapping[str, Any]:
    """A dictionary whose keys are texts."""
    if not isinstance(value, Mapping):
        raise refusal(name, "a dictionary", value)
    for key in value:
        text(f"a key of {name}", key)
    return value


def each(name: str, values: Iterable[Any]) -> Iterator[Any]:
    """The values of a list, or of another iterable except a text."""
    if isinstance(values, (str, bytes)):
        raise refusal(name, "a list", values)
    try:
        return iter(values)
    except TypeError as error:
        raise refusal(name, "a list", values) from error


def array(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Numbers, as an array of their shape."""
    if np.ma.is_masked(values):
        raise ParameterError(f"{name} has masked elements: leave them out")
    try:
        taken = np.asarray(values)
    except (TypeError, ValueError) as error:
        raise refusal(name, "numbers in an array or a list", values) from error
    if taken.dtype.kind == "O":
        # NumPy would convert None in such an array to nan.
        return np.array([real(name, value) for value in taken.flat], dtype=np.float64).reshape(taken.shape)
    if taken.dtype.kind not in "iuf":
        raise refusal(name, "numbers in an array or a list", values)
    return taken.astype(np.float64)


def check_finite(name: str, values: NDArray[np.float64], *, or_nan: bool = False) -> None:
    """Refuse an array with an element that is not finite, by its index."""
    wrong = np.argwhere(np.isinf(values) if or_nan else ~np.isfinite(values))
    if len(wrong):
        place = ", ".join(map(str, wrong[0]))
        expected = "finite or NaN" if or_nan else "finite"
        raise refusal(f"{name}[{place}]" if place else name, expected, float(values[tuple(wrong[0])]))


def participant_code(value: object) -> str:
    """The code of a participant, by the rule of `frixel play --participant`."""
    if not (isinstance(value, str) and re.fullmatch(r"[A-Za-z0-9_.-]{1,32}", value)):
        raise ParameterError(
            f"participant {shown(value)}: use a code of 1 to 32 letters, digits, -, _ and ., not a name"
        )
    return value
