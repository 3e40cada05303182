"""What a play recorded: columns of equal length."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["COLUMNS", "Recording"]

COLUMNS: Mapping[str, tuple[str, str]] = {
    "t_s": ("s", "Time since the scene began to play, at the end of the row"),
    "x_mm": ("mm", "The finger's place from the left edge of the screen"),
    "y_mm": ("mm", "The finger's place from the top edge of the screen"),
    "speed_mm_s": ("mm/s", "The finger's speed"),
    "wanted_n": ("N", "The reference: friction of the scene at the finger's place, mean over the row"),
    "asked_n": ("N", "The board's target, mean over the row"),
    "felt_n": ("N", "Friction that the finger felt, mean over the row"),
    "natural_n": ("N", "The part of the felt friction that the finger has without the drive"),
    "electrode_v_rms": ("V", "Rms voltage on the electrode over the row"),
    "voltage_v_rms": ("V", "Rms voltage of the envelope"),
    "dac_code": ("1", "The last code in the row that went to the DAC"),
    "flags": ("1", "Every flag that the board reported in the row, as bits (docs/outputs.md)"),
}
"""Unit and meaning of each column."""


@dataclass(frozen=True, eq=False)
class Recording(Mapping[str, NDArray[Any]]):
    """Columns of equal length, by name: `recording["felt_n"]`. What is unknown is not a number.

    `COLUMNS` has the unit and the meaning of each.
    """

    columns: dict[str, NDArray[Any]]
    """The columns, each of shape (rows,)."""
    settings: dict[str, Any] = field(default_factory=dict)
    """What made the recording."""

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

    def __repr__(self) -> str:
        end_s = self.columns["t_s"][-1] if self.rows else 0.0
        felt = self.columns["felt_n"]
        touched = np.isfinite(felt)
        range_n = f", felt {np.min(felt[touched]):.3f} to {np.max(felt[touched]):.3f} N" if touched.any() else ""
        return f"<frixel.Recording: {self.rows} rows, {end_s:.3f} s{range_n}>"
