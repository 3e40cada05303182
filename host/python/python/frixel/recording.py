"""Recordings of plays: columns of equal length."""

from __future__ import annotations

import difflib
import json
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from html import escape
from importlib import import_module
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _display, _frixel
from ._arguments import flag, mapping, participant_code, refusal, shown
from ._arguments import path as checked_path
from ._arguments import text as checked_text
from ._files import name_of, read_bytes
from .errors import ColumnError, FrixelError, FrixelWarning, ParameterError, PlayError
from .profiles import Finger, Screen
from .scene import Scene

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["COLUMNS", "Recording", "replay"]

COLUMNS: Mapping[str, tuple[str, str]] = {name: (unit, meaning) for name, unit, meaning in _frixel.play_fields()}
"""Unit and meaning of each column."""


@dataclass(frozen=True, eq=False)
class Recording(Mapping[str, NDArray[Any]]):
    """Columns of equal length, by name: `recording["felt_n"]`.

    `COLUMNS` has the unit and the meaning of each. Unknown numbers are NaN; `flags` are texts. The arrays are
    read-only, since plays may share them. Two recordings are equal if they have the same columns, bit for bit, of the
    same scene.
    """

    columns: dict[str, NDArray[Any]]
    """The columns, each of shape (rows,)."""
    settings: dict[str, Any]
    """Settings of the play, and the version that made it."""
    scene: Scene
    """The scene that was played."""
    made: str = field(repr=False)
    """What `frixel replay` needs in addition to the scene, as JSON."""

    def __post_init__(self) -> None:
        columns = {}
        for name, values in mapping("columns", self.columns).items():
            if not (isinstance(values, np.ndarray) and values.ndim == 1):
                raise refusal(f"the column {shown(name)}", "an array of shape (rows,)", values)
            column = columns[name] = values.view()
            column.setflags(write=False)
        lengths = {name: len(values) for name, values in columns.items()}
        if "t_s" not in columns or len(set(lengths.values())) > 1:
            raise ParameterError(f"columns have one length, and t_s is one of them, found {shown(lengths)}")
        if not isinstance(self.scene, Scene):
            raise refusal("scene", "a Scene", self.scene)
        mapping("settings", self.settings)
        checked_text("made", self.made)
        object.__setattr__(self, "columns", columns)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Recording:
        """Read a recording of a play: a file of `to_parquet`, or of `frixel play --record`.

        Raises
        ------
        PlayError
            The file cannot be read, or is not a recording of a play.
        SceneError
            Its scene cannot be compiled: it has another version, or a picture was too large for the file.
        """
        content = read_bytes(path, PlayError)
        columns, text, files, profiles, made, is_cut_off = _frixel.read_parquet(content, name_of(path))
        if is_cut_off:
            warnings.warn(f"{name_of(path)} was cut off: it ends with its last whole rows", FrixelWarning, stacklevel=2)
        finger = None if profiles[0] is None else Finger(*profiles[0])
        screen = None if profiles[1] is None else Screen(*profiles[1])
        scene = Scene(text.encode(), name_of(path), files=files, finger=finger, screen=screen)
        metadata = json.loads(made)["metadata"]
        play = metadata["play"] or {}
        settings = {
            "frixel": metadata["frixel"],
            "scene": scene.name,
            "board": None if metadata["rig"] == "sim" else metadata["board"]["kind"],
            "rows_per_s": metadata["tick_hz"] // metadata["ticks_per_row"] if metadata["ticks_per_row"] else None,
            "seconds": play.get("seconds"),
            "seed": play.get("seed"),
            "person": play.get("finger_seed"),
            "touch": play.get("touch"),
            "ideal": play.get("ideal"),
            "leakage": not play["no_leakage"] if "no_leakage" in play else None,
            "mean_square": play.get("mean_square"),
        }
        given = {name: value for name, value in settings.items() if value is not None}
        return cls({name: np.asarray(values) for name, values in columns.items()}, given, scene, made)

    def __getitem__(self, name: str) -> NDArray[Any]:
        try:
            return self.columns[name]
        except (KeyError, TypeError) as error:
            near = difflib.get_close_matches(name, self.columns, 1, 0.5) if isinstance(name, str) else []
            advice = f"did you mean {near[0]!r}?" if near else f"there are {', '.join(self.columns)}"
            raise ColumnError(f"the recording has no column {shown(name)}: {advice}") from error

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.columns)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Recording):
            return NotImplemented
        scenes = [(recording.scene.text, recording.scene.compiled.files) for recording in (self, other)]
        same = [name for name, values in self.items() if name in other and _is_same(values, other[name])]
        return scenes[0] == scenes[1] and len(same) == len(self) == len(other)

    __hash__ = None  # type: ignore[assignment]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self.columns["t_s"])

    def to_pandas(self) -> pd.DataFrame:
        """A `pandas.DataFrame` with the columns; its `attrs` have the settings."""
        frame: pd.DataFrame = _installed("pandas").DataFrame(dict(self.columns))
        frame.attrs.update(self.settings)
        return frame

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` over `t_s`, with the unit and the meaning of each variable."""
        described = {name: {"units": unit, "long_name": meaning} for name, (unit, meaning) in COLUMNS.items()}
        variables = {name: ("t_s", values, described[name]) for name, values in self.columns.items() if name != "t_s"}
        times = ("t_s", self.columns["t_s"], described["t_s"])
        return _installed("xarray").Dataset(variables, coords={"t_s": times}, attrs=dict(self.settings))

    def to_parquet(self, path: str | PathLike[str], *, participant: str | None = None, overwrite: bool = False) -> None:
        """Write the columns as Parquet, in the format of `frixel play --record` (`docs/design/outputs.md`).

        The metadata of the file has everything that `frixel replay` needs to play it again: the scene with its files,
        finger, screen, touch source, stroke, seeds, rate and versions.

        Parameters
        ----------
        path
            The file. An earlier file stays until the new one is complete on the disk.
        participant
            The code of a person, 1 to 32 letters, digits, `-`, `_` and `.`.
        overwrite
            Also replace a recording of a person.

        Raises
        ------
        FrixelError
            The file cannot be written, or has a recording of a person; it is unchanged.
        ParameterError
            The participant's code is invalid.
        """
        path, overwrite = checked_path("path", path), flag("overwrite", overwrite)
        _frixel.write_files({path: self._parquet(participant)}, overwrite)

    def _parquet(self, participant: str | None) -> bytes:
        """The bytes of the file of `to_parquet`."""
        participant = None if participant is None else participant_code(participant)
        columns = {name: values.tolist() if values.dtype.kind == "U" else values for name, values in self.items()}
        return _frixel.parquet(columns, self.scene.text, self.scene.compiled.files, self.made, participant)

    def _repr_html_(self) -> str:
        lines = {"reference_n": ("#888", self["reference_n"]), "felt_n": ("#c33", self["felt_n"])}
        return f"<p>{escape(repr(self)[1:-1])}</p>" + _display.chart(self["t_s"], lines, ("friction, N,", "time, s,"))

    def __repr__(self) -> str:
        end_s = self.columns["t_s"][-1] if self.rows else 0.0
        felt = self.columns["felt_n"]
        touched = np.isfinite(felt)
        range_n = f", felt {np.min(felt[touched]):.3f} to {np.max(felt[touched]):.3f} N" if touched.any() else ""
        return f"<frixel.Recording: {self.rows} rows, {end_s:.3f} s{range_n}>"


def _is_same(one: NDArray[Any], other: NDArray[Any]) -> bool:
    return bool(np.array_equal(one, other, equal_nan=one.dtype.kind == other.dtype.kind == "f"))


def _installed(module: str) -> Any:
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        raise FrixelError(f"this needs {module}: install frixel[{module}], or {module} alone") from error


def replay(path: str | PathLike[str]) -> int:
    """Play a recording of the simulator again, from its file alone, and compare every bit, as `frixel replay` does.

    Returns
    -------
    int
        The number of rows, all of which are equal.

    Raises
    ------
    PlayError
        The bits differ, or the recording cannot be played again: it is from a board at a port, or of another version.
        The message says where, or why.
    """
    return _frixel.replay(read_bytes(path, PlayError), name_of(path))
