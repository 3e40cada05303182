"""Profiles of fingers, screens and touch sources, each the text of a TOML file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any, ClassVar

from . import _frixel, _toml
from ._arguments import mapping, refusal, shown
from ._arguments import text as checked_text
from ._files import name_of, read_bytes
from .errors import ParameterError, SceneError

if TYPE_CHECKING:
    from typing_extensions import Self

__all__ = ["Finger", "Screen", "TouchSource"]


@dataclass(frozen=True)
class _Profile:
    text: str | None
    """The text of the file; `None` for a bundled profile."""
    name: str
    """Its name in messages."""

    kind: ClassVar[str]

    def __post_init__(self) -> None:
        if self.text is not None:
            checked_text("text", self.text)
        checked_text("name", self.name)
        _frixel.check_profile(self.kind, self)

    @classmethod
    def bundled(cls, name: str) -> Self:
        """The bundled profile of this name.

        Raises
        ------
        ParameterError
            No bundled profile has this name.
        """
        return cls(None, name)

    @classmethod
    def bundled_names(cls) -> list[str]:
        """The names of the bundled profiles."""
        return _frixel.bundled_profiles(cls.kind)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Self:
        """Read a file.

        Raises
        ------
        SceneError
            The file cannot be read, or has mistakes.
        """
        content, name = read_bytes(path, SceneError, is_toml=True), name_of(path)
        return cls(_frixel.profile_text(cls.kind, content, name), name)

    @classmethod
    def parse(cls, text: str) -> Self:
        """Read the text of a file.

        Raises
        ------
        SceneError
            The text has mistakes.
        """
        return cls(text, f"<{cls.kind}>")

    @classmethod
    def from_dict(cls, fields: Mapping[str, Any]) -> Self:
        """Make a profile from the fields of its file.

        Raises
        ------
        SceneError
            A field is missing, unknown, or out of range.
        """
        return cls.parse(_toml.dumps(mapping("fields", fields)))

    @classmethod
    def of(cls, profile: Self | str | Mapping[str, Any]) -> Self:
        """Convert an argument to a profile: a profile itself, the name of a bundled one, or the fields of its file."""
        if isinstance(profile, str):
            if profile.endswith(".toml"):
                raise ParameterError(
                    f"{shown(profile)}: a string is the name of a bundled {cls.kind}; {cls.__name__}.load reads a file"
                )
            return cls.bundled(profile)
        if isinstance(profile, Mapping):
            return cls.from_dict(profile)
        if not isinstance(profile, cls):
            raise refusal(f"a {cls.kind}", f"a {cls.__name__}, a name, or a table", profile)
        return profile


class Finger(_Profile):
    """A finger's parameters on a screen, and their origin; `docs/design/scene-reference.md` has all fields.

    ======================== ============================================== ====
    field                    meaning                                        unit
    ======================== ============================================== ====
    `friction_coefficient`   friction coefficient on the bare screen
    `normal_load_n`          how hard the finger presses                    N
    `radius_mm`              radius of curvature at the contact             mm
    `stiffness_pa_per_m`     Winkler-Fuss stiffness                         Pa/m
    `skin_gap_um`            skin and air above the coating, as a gap:      um
                             thickness over permittivity
    `origin`                 `assumed`, `perceptual`, `measured` or
                             `empirical`
    ======================== ============================================== ====

    >>> Finger.from_dict({"friction_coefficient": 0.5, "normal_load_n": 0.5, "radius_mm": 8, "skin_gap_um": 4.74,
    ...                   "stiffness_pa_per_m": 1.8e7, "origin": "assumed"}).name
    '<finger>'
    """

    kind = "finger"


class Screen(_Profile):
    """A screen: its size, its coating, the limits of its drive (`docs/design/scene-reference.md`, `[screen]`)."""

    kind = "screen"


class TouchSource(_Profile):
    """Rate, latency and reliability of a touchscreen's reports of the finger (`docs/design/touch.md`)."""

    kind = "touch source"

    @classmethod
    def of(cls, profile: Self | str | int | Mapping[str, Any]) -> Self:
        """Convert an argument to a touch source: itself, a bundled name ("500" or 500), or the fields of its file."""
        is_number = isinstance(profile, int) and not isinstance(profile, bool)
        return super().of(shown(profile) if is_number else profile)  # type: ignore[arg-type]
