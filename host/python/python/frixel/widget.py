"""A scene to slide over in a notebook. Needs `anywidget`, which `pip install frixel[widget]` adds."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import traitlets

from .errors import FrixelError
from .profiles import Finger, Screen, TouchSource
from .scene import Scene

try:
    from anywidget import AnyWidget
except ModuleNotFoundError as error:
    raise FrixelError("frixel.widget needs anywidget: install frixel[widget], or anywidget alone") from error

__all__ = ["SceneWidget"]

MODULE = Path(__file__).with_name("widget.js")
"""The script of `<frixel-scene>` with a view for anywidget, built by `cargo xtask studio`."""


class _Argument(traitlets.TraitType[Any, Any]):
    """A trait whose value is converted by `of`, like an argument of a function."""

    def __init__(self, of: Callable[[Any], Any]) -> None:
        super().__init__()
        self.of = of

    def validate(self, obj: object, value: object) -> Any:
        return self.of(value)


class SceneWidget(AnyWidget):
    """A scene's map, a finger that a pointer or the arrow keys slide over it, and a scope of what it feels.

    A simulated board in the page plays the scene, without Python: nothing is sent back, and no port is opened. All
    widgets of a page share the board; it plays the scene under the pointer.

    Parameters
    ----------
    scene
        The scene, with its finger and screen, or the tables of its file.
    touch
        The touch source: a `TouchSource`, the name of a bundled one, or the fields of its file.

    Attributes
    ----------
    scene, touch
        The shown scene and touch source. Assigning to them updates the page.

    Raises
    ------
    FrixelError
        The package was built without the widget's script.
    ParameterError
        An argument is not a scene or a touch source.
    SceneError
        The tables of an argument have mistakes.
    """

    _esm = traitlets.Unicode().tag(sync=True)
    scene = _Argument(Scene.of).tag(sync=True, to_json=lambda scene, _: _sent_scene(scene))
    touch = _Argument(TouchSource.of).tag(sync=True, to_json=lambda touch, _: _sent_profile(touch))

    def __init__(
        self, scene: Scene | Mapping[str, Any], *, touch: TouchSource | str | int | Mapping[str, Any] = "100"
    ) -> None:
        super().__init__(_esm=_script(), scene=scene, touch=touch)


def _script() -> str:
    try:
        return MODULE.read_text(encoding="utf-8")
    except OSError as error:
        raise FrixelError(
            f"{MODULE} cannot be read ({error.strerror}): run `cargo xtask studio` in frixel's repository, and install "
            "the module from there again"
        ) from error


def _sent_scene(scene: Scene) -> dict[str, Any]:
    """The fields of a scene that `host/studio/web/element/widget.js` takes."""
    return {
        "text": scene.text,
        "files": scene.compiled.files,
        "finger": _sent_profile(scene._finger),
        "screen": _sent_profile(scene._screen),
    }


def _sent_profile(profile: Finger | Screen | TouchSource | None) -> str | None:
    """The name of a bundled profile, or the text of any other."""
    return None if profile is None else profile.text or profile.name
