"""Studies of many simulated fingers, in cells that processes and clusters can share.

`cells` makes the cells of a plan, `play` plays one of them, and a `Study` merges the results. `play` is a pure function
of a text, so that `map(sweep.play, cells)` works with processes, Dask and Slurm (`docs/python/scale.md`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any

from . import _frixel, _tables, _toml
from ._arguments import each, flag, mapping, refusal
from ._arguments import path as checked_path
from ._arguments import text as checked_text
from ._files import name_of, read_bytes
from .errors import FrixelError, ParameterError
from .scene import Scene

__all__ = ["Study", "cells", "play"]


def cells(plan: str | PathLike[str] | Mapping[str, Any]) -> list[str]:
    """The cells of a plan: one for each combination and simulated person, people varying fastest.

    Parameters
    ----------
    plan
        The path of a plan's file (`docs/python/scale.md`), or its fields; then `scenes` may be a dictionary of scenes
        by the names that results have, and the names of other files are those of the current folder.

    Returns
    -------
    list of str
        Texts with everything that the plays need, in the order of the plan.

    Raises
    ------
    ParameterError
        The plan has a mistake, or names a missing file, or a scene was given another finger or screen.
    SceneError
        A scene has mistakes, or a board refuses it with some of the values.

    >>> plate = Scene.from_dict({"layer": [{"kind": "constant", "friction_fraction": 0.5}]})
    >>> len(cells({"scenes": {"plate": plate}, "people": 2, "parameters": {"layer.1.friction_fraction": [0.1, 0.5]}}))
    4
    """
    if isinstance(plan, Mapping):
        scenes = plan.get("scenes", [])
        if not isinstance(scenes, (Mapping, list, tuple)):
            raise refusal("`scenes`", "a list of files, or a dictionary of scenes by their names", scenes)
        mapping("plan", plan)
        own = mapping("scenes", scenes) if isinstance(scenes, Mapping) else {}
        named = {name: Scene.of(scene) for name, scene in own.items()}
        text = _toml.dumps({**plan, "scenes": list(scenes)})
        for name, scene in named.items():
            if scene.is_for_another:
                raise ParameterError(
                    f"the scene {name} is for another finger or screen (with_finger, with_screen), and people have "
                    "their own fingers: give the scene as it is, and screens in `screens`"
                )
        sources = {name: (scene.text, scene.compiled.files) for name, scene in named.items()}
        return _frixel.sweep_cells(text.encode(), "<plan>", "", sources)
    path = checked_path("plan", plan)
    content = read_bytes(path, ParameterError, is_toml=True)
    return _frixel.sweep_cells(content, name_of(path), str(path.parent), {})


def play(cell: str) -> str:
    """Play one cell. Returns what its finger noticed, as a text: the same on every machine.

    Raises
    ------
    ParameterError
        The text is not a cell, or a cell of another version.
    SceneError
        A board refuses the scene with these values together.
    """
    if not isinstance(cell, str):
        raise refusal("a cell", "a string made by `sweep.cells`", cell)
    return _frixel.play_cell(checked_text("a cell", cell))


class Study:
    """The merged results of a plan's cells, in the order of the plan.

    Intervals are computed from the results of single fingers. A notebook shows the chart of the share of simulated
    fingers that notice each layer.

    Raises
    ------
    ParameterError
        A text is not a result.
    """

    def __init__(self, results: Iterable[str]) -> None:
        texts = list(each("results", results))
        if not texts or not all(isinstance(text, str) for text in texts):
            raise ParameterError("a study needs one result or more, strings made by `sweep.play`")
        lines, self.files = _frixel.study_files(texts)
        self.words = "\n".join(lines)

    files: dict[str, bytes]
    """The files that `frixel sweep` writes, byte for byte: `layers.csv`, `sweep.svg` and others, by their names."""
    words: str
    """The share of the fingers that notice each layer, as a text."""

    @property
    def layers(self) -> list[dict[str, Any]]:
        """One row per combination and layer: the share of the fingers that notice it, with its interval."""
        return self._rows("layers.csv")

    @property
    def fingers(self) -> list[dict[str, Any]]:
        """One row per finger and layer."""
        return self._rows("fingers.csv")

    @property
    def numbers(self) -> list[dict[str, Any]]:
        """One row per combination and metric of a score: its mean over the fingers, with its interval."""
        return self._rows("numbers.csv")

    def write(self, folder: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Write the files into a folder. Creates the folder if necessary.

        Parameters
        ----------
        folder
            The folder. If it has another study, nothing is written.
        overwrite
            Replace another study in the folder.

        Raises
        ------
        FrixelError
            A file cannot be written, and the earlier files are unchanged; or the folder has another study.
        """
        folder, overwrite = checked_path("folder", folder), flag("overwrite", overwrite)
        files = {folder / name: content for name, content in self.files.items()}
        try:
            folder.mkdir(parents=True, exist_ok=True)
            there = [] if overwrite else [path for path in files if path.exists()]
        except OSError as error:
            raise FrixelError(f"{folder}: this study cannot be written ({error.strerror})") from error
        for path in there:
            if read_bytes(path, FrixelError) != files[path]:
                raise FrixelError(
                    f"{path} is from another study: give another folder, or `overwrite=True` to replace that study"
                )
        _frixel.write_files(files, overwrite)

    def _rows(self, name: str) -> list[dict[str, Any]]:
        return _tables.rows(self.files[name].decode())

    def __str__(self) -> str:
        return self.words

    def _repr_svg_(self) -> str:
        return self.files["sweep.svg"].decode()
