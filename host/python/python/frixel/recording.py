"""What a play recorded: columns of equal length."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from html import escape
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _display, _frixel
from ._files import read_bytes
from .errors import PlayError, participant_code
from .scene import Scene

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["COLUMNS", "Recording", "replay"]

COLUMNS: Mapping[str, tuple[str, str]] = {name: (unit, meaning) for name, unit, meaning in _frixel.play_fields()}
"""Unit and meaning of each column."""

TICKS_PER_S = 40_000
"""Ticks of the simulated board a second."""


@dataclass(frozen=True, eq=False)
class Recording(Mapping[str, NDArray[Any]]):
    """Columns of equal length, by name: `recording["felt_n"]`.

    `COLUMNS` has the unit and the meaning of each. A number that is unknown is not a number; `flags` are texts.
    """

    columns: dict[str, NDArray[Any]]
    """The columns, each of shape (rows,)."""
    settings: dict[str, Any]
    """How the play was made, and by which version."""
    scene: Scene
    """The scene that was played."""
    made: str = field(repr=False)
    """What `frixel replay` needs beside the scene, JSON."""

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self.columns["t_s"])

    def to_pandas(self) -> pd.DataFrame:
        """A `pandas.DataFrame` with a column each; `attrs` has what made the recording."""
        import pandas as pd

        frame = pd.DataFrame(self.columns)
        frame.attrs.update(self.settings)
        return frame

    def to_xarray(self) -> Any:
        """An `xarray.Dataset` over `t_s`, with the unit and the meaning of each variable."""
        import xarray as xr

        described = {name: {"units": unit, "long_name": meaning} for name, (unit, meaning) in COLUMNS.items()}
        variables = {name: ("t_s", values, described[name]) for name, values in self.columns.items() if name != "t_s"}
        times = ("t_s", self.columns["t_s"], described["t_s"])
        return xr.Dataset(variables, coords={"t_s": times}, attrs=dict(self.settings))

    def to_parquet(self, path: str | PathLike[str], *, participant: str | None = None) -> None:
        """Write the columns as Parquet, in the format of `frixel play --record` (`docs/outputs.md`).

        All that made the play is in the metadata of the file, so that `frixel replay` plays it again: the scene with
        its files, finger, screen, touch source, stroke, seeds, rate and versions. `participant` is the code of a
        person, 1 to 32 letters, digits, `-`, `_` and `.`.

        Raises
        ------
        FrixelError
            The file cannot be written.
        ParameterError
            The participant is no code.
        """
        participant = None if participant is None else participant_code(participant)
        columns = {name: values.tolist() if values.dtype.kind == "U" else values for name, values in self.items()}
        _frixel.write_parquet(path, columns, self.scene.text, self.scene.compiled.files, self.made, participant)

    def _repr_html_(self) -> str:
        lines = {"wanted_n": ("#888", self["wanted_n"]), "felt_n": ("#c33", self["felt_n"])}
        return f"<p>{escape(repr(self)[1:-1])}</p>" + _display.chart(self["t_s"], lines, ("friction, N,", "time, s,"))

    def __repr__(self) -> str:
        end_s = self.columns["t_s"][-1] if self.rows else 0.0
        felt = self.columns["felt_n"]
        touched = np.isfinite(felt)
        range_n = f", felt {np.min(felt[touched]):.3f} to {np.max(felt[touched]):.3f} N" if touched.any() else ""
        return f"<frixel.Recording: {self.rows} rows, {end_s:.3f} s{range_n}>"


def replay(path: str | PathLike[str]) -> int:
    """Play a recording of the simulator again, from its file alone, and compare every bit, as `frixel replay` does.

    Returns
    -------
    int
        The number of rows, which are the same.

    Raises
    ------
    PlayError
        The bits differ, and where; or why it cannot be played again: it is of a board at a port, or of another version.
    """
    return _frixel.replay(read_bytes(path, "this recording", PlayError), str(path))
