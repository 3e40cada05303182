"""Scenes: the friction of a screen."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from html import escape
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _display, _frixel, _toml
from ._arguments import flag, mapping, number, refusal, whole
from ._arguments import path as checked_path
from ._arguments import text as checked_text
from ._files import name_of, read_bytes
from .errors import FrixelWarning, SceneError
from .profiles import Finger, Screen, TouchSource

__all__ = ["Scene"]

MAP_MAX_PX = 10_000
"""Largest width and height of a map, pixels."""
SPEED_MAX_MM_S = 10_000.0
"""Fastest finger of a map, mm/s."""


class Scene:
    """A scene without mistakes, for its screen and finger (`docs/design/scenes.md`).

    Made by `load`, `parse` or `from_dict`. It can be pickled, with the files that it names.
    """

    def __init__(
        self,
        text: bytes,
        name: str,
        *,
        folder: str | None = None,
        files: Mapping[str, bytes] | None = None,
        finger: Finger | None = None,
        screen: Screen | None = None,
    ) -> None:
        if not isinstance(text, bytes):
            raise refusal("text", "the bytes of a scene file (Scene.parse takes a string)", text)
        for what, value, kind in (("finger", finger, Finger), ("screen", screen, Screen)):
            if not (value is None or isinstance(value, kind)):
                raise refusal(what, f"a {kind.__name__}", value)
        folder = None if folder is None else str(checked_path("folder", folder))
        self._text, self.name, self._finger, self._screen = text, checked_text("name", name), finger, screen
        self.compiled = _frixel.Scene(text, name, folder, _named_files(files), finger, screen)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Scene:
        """Read a scene file, with the pictures and profiles that it names from its folder.

        Raises
        ------
        SceneError
            The file cannot be read, or has mistakes; each is listed with line and column.
        """
        text = read_bytes(path, SceneError, is_toml=True)
        return cls(text, name_of(path), folder=str(Path(path).parent))

    @classmethod
    def parse(cls, text: str, *, files: Mapping[str, bytes] | None = None) -> Scene:
        """Read the text of a scene file. `files` has the bytes of the pictures and profiles that it names.

        Raises
        ------
        SceneError
            The text has mistakes.
        """
        return cls(checked_text("text", text).encode(), "<scene>", files=files)

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], *, files: Mapping[str, bytes] | None = None) -> Scene:
        """Make a scene from the tables of its file. The default `version` is 1.

        Raises
        ------
        SceneError
            A table has mistakes. Lines and columns are those of `Scene.dict_text(tables)`.
        """
        return cls.parse(cls.dict_text(tables), files=files)

    @staticmethod
    def dict_text(tables: Mapping[str, Any]) -> str:
        """The text of the scene file with these tables."""
        return _toml.dumps({"version": 1, **mapping("tables", tables)})

    @classmethod
    def of(cls, scene: Scene | Mapping[str, Any]) -> Scene:
        """Convert an argument to a scene: a scene itself, or the tables of its file."""
        scene = cls.from_dict(scene) if isinstance(scene, Mapping) else scene
        if not isinstance(scene, Scene):
            raise refusal("a scene", "a Scene or its tables (Scene.load reads a file)", scene)
        return scene

    def with_finger(self, finger: Finger | str | Mapping[str, Any]) -> Scene:
        """The scene for another finger: a `Finger`, the name of a bundled finger, or the fields of its file.

        Raises
        ------
        SceneError
            The fields have mistakes, or the scene has mistakes for this finger.
        ParameterError
            No bundled finger has this name.
        """
        return self._for(Finger.of(finger), self._screen)

    def with_screen(self, screen: Screen | str | Mapping[str, Any]) -> Scene:
        """The scene on another screen: a `Screen`, the name of a bundled screen, or the fields of its file.

        Raises
        ------
        SceneError, ParameterError
            As `with_finger`.
        """
        return self._for(self._finger, Screen.of(screen))

    def _for(self, finger: Finger | None, screen: Screen | None) -> Scene:
        return Scene(self._text, self.name, files=self.compiled.files, finger=finger, screen=screen)

    @property
    def is_for_another(self) -> bool:
        """Whether `with_finger` or `with_screen` has replaced the finger or the screen of the text."""
        return self._finger is not None or self._screen is not None

    @property
    def text(self) -> str:
        """The text of the scene file."""
        return self._text.decode()

    @property
    def screen_mm(self) -> tuple[float, float]:
        """Width and height of the screen, mm."""
        return self.compiled.screen_mm

    @property
    def layers(self) -> list[str]:
        """Titles of the layers, from the bottom."""
        return self.compiled.layers

    @property
    def reach_n(self) -> tuple[float, float]:
        """Friction that the drive can reach on the finger, N: without voltage, and at the largest voltage."""
        return self.compiled.reach_n

    @property
    def refusals(self) -> list[str]:
        """Reasons for which a board refuses the scene, one sentence each; the simulator plays it as a draft."""
        return self.compiled.refusals

    def _warn_of_draft(self) -> None:
        """Warn that the simulated board plays the scene as a draft, if a board refuses it."""
        if self.refusals:
            message = f"a board refuses {self.name}, which is played as a draft, clamped: {'; '.join(self.refusals)}"
            warnings.warn(message, FrixelWarning, stacklevel=3)

    @property
    def notes(self) -> list[str]:
        """Reasons to doubt the scene, and what was rounded or clamped, one sentence each."""
        return self.compiled.notes

    def check(
        self, *, touch: TouchSource | str | int | Mapping[str, Any] = "100", board: bool = False
    ) -> dict[str, Any]:
        """The costs of the scene and what a finger will feel of it, as `frixel check --json` prints them.

        Parameters
        ----------
        touch
            The touch source: a `TouchSource`, the name of a bundled one, or the fields of its file.
        board
            Also report the smallest firmware image that plays the scene.

        Raises
        ------
        SceneError
            A board refuses the scene.
        """
        report: dict[str, Any] = json.loads(self.compiled.check(TouchSource.of(touch), flag("board", board)))
        return report

    def map(self, width: int = 1000, height: int = 800, *, speed_mm_s: float = 100.0) -> NDArray[np.float64]:
        """The electric friction that the scene asks for over the screen.

        Parameters
        ----------
        width, height
            Largest size in pixels, from 1 to 10,000; the map has the proportions of the screen.
        speed_mm_s
            Sliding speed of the finger, from 0 to 10,000 mm/s, for layers that depend on it.

        Returns
        -------
        numpy.ndarray
            Electric friction at the middle of each pixel, N, of shape (rows, columns), from the top left. Vibrations
            and streams are at their largest.

        Raises
        ------
        ParameterError
            A value is out of range.
        """
        return self.compiled.map(
            whole("width", width, 1, MAP_MAX_PX),
            whole("height", height, 1, MAP_MAX_PX),
            1e-3 * number("speed_mm_s", speed_mm_s, 0.0, SPEED_MAX_MM_S),
        )[0]

    def __repr__(self) -> str:
        width, height = self.screen_mm
        layers = "1 layer" if len(self.layers) == 1 else f"{len(self.layers)} layers"
        return f"<frixel.Scene {self.name}: {layers} on {width:g} mm x {height:g} mm>"

    def _repr_html_(self) -> str:
        natural, most = self.reach_n
        return (
            f"<p>{escape(repr(self)[1:-1])}; black is {1e3 * (most - natural):.3g} mN of electric friction</p>"
            + _display.friction_map(self.map(480, 320), most - natural)
            + _display.sentences("A board refuses it:", self.refusals)
            + _display.sentences("Notes:", self.notes)
        )

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scene) and self._state() == other._state()

    def __hash__(self) -> int:
        return hash(self._text)

    def _state(self) -> tuple[bytes, str, dict[str, bytes], Finger | None, Screen | None]:
        return self._text, self.name, self.compiled.files, self._finger, self._screen

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, self._state()


def _named_files(files: Mapping[str, bytes] | None) -> dict[str, bytes]:
    named = dict(mapping("files", {} if files is None else files))
    for name, content in named.items():
        if not isinstance(content, (bytes, bytearray)):
            raise refusal(f"the file {name!r}", "bytes", content)
    return named


def _restored(text: bytes, name: str, files: dict[str, bytes], finger: Finger | None, screen: Screen | None) -> Scene:
    return Scene(text, name, files=files, finger=finger, screen=screen)
