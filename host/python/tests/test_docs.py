"""What documents and examples show is run."""

from __future__ import annotations

import doctest
import importlib
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import frixel
import matplotlib as mpl
import nbformat
import numpy as np
import pandas as pd
import pyarrow.parquet as parquet
import pytest
from frixel.experiment import TWO_ALTERNATIVES, Observer
from nbclient import NotebookClient

from .conftest import REPOSITORY

EXAMPLES = sorted((REPOSITORY / "host/python/examples").glob("*.py"))
NOTEBOOKS = sorted((REPOSITORY / "host/python/examples").glob("*.ipynb"))


def test_the_blocks_of_the_document_run_one_after_the_other(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    mpl.use("agg")
    monkeypatch.chdir(tmp_path)
    text = (REPOSITORY / "docs/python/module.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) >= 5
    names: dict[str, Any] = {}
    for block in blocks:
        exec(compile(block, "docs/python/module.md", "exec"), names)
    printed = capsys.readouterr().out
    assert "nan" in printed
    assert "3 8 " in printed, "the place of the mistake"
    assert (tmp_path / "play.parquet").stat().st_size > 0
    np.testing.assert_allclose(names["recordings"][2]["t_s"][-1], 0.5)


def test_other_programs_see_and_keep_what_a_recording_says(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, scenes: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    recording = frixel.Simulator(frixel.Scene.load(scenes / "brick.toml")).run(0.05)
    recording.to_parquet("P07.parquet", participant="P07")
    text = (REPOSITORY / "docs/design/outputs.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    names: dict[str, Any] = {}
    exec(compile(block, "docs/design/outputs.md", "exec"), names)
    assert (names["unit"], names["participant"]) == (b"mm", "P07")
    assert "scene_began" in json.dumps(names["markers"])
    assert (names["made"]["participant"], names["scene"]) == ("P07", recording.scene.text)
    # pyarrow and pandas write what they have read.
    parquet.write_table(names["table"], "kept.parquet")
    pd.read_parquet("P07.parquet").to_parquet("kept-too.parquet")
    for kept in ("kept.parquet", "kept-too.parquet"):
        assert pd.read_parquet(kept).attrs["frixel.recording"]["participant"] == "P07"
    schema = parquet.read_schema("kept.parquet")
    assert schema.metadata[b"frixel.scene"].decode() == recording.scene.text
    assert schema.field("x_mm").metadata[b"unit"] == b"mm"
    # What another program wrote is no recording any more.
    with pytest.raises(frixel.PlayError, match="its hash does not match its content"):
        frixel.replay("kept.parquet")


@pytest.mark.parametrize(
    "name",
    [
        "frixel._tables",
        "frixel.experiment._detection",
        "frixel.simulator",
        "frixel.profiles",
        "frixel.scoring",
        "frixel.sweep",
    ],
)
def test_the_examples_in_docstrings_are_true(name: str) -> None:
    failed, attempted = doctest.testmod(importlib.import_module(name))
    assert attempted > 0
    assert failed == 0


@pytest.mark.parametrize("example", EXAMPLES, ids=[path.stem for path in EXAMPLES])
def test_an_example_runs(example: Path, tmp_path: Path) -> None:
    subprocess.run([sys.executable, str(example)], check=True, cwd=tmp_path, env={"MPLBACKEND": "agg"}, timeout=600)


def test_there_are_notebooks() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["experiment_and_sweep", "figures_and_fit"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_a_notebook_runs(path: Path, tmp_path: Path) -> None:
    notebook = nbformat.read(path, as_version=4)
    codes = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not any(cell.outputs or cell.execution_count for cell in codes), "notebooks are kept without outputs"
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [output for cell in codes for output in cell.outputs]
    text = "".join(output.text for output in shown if output.output_type == "stream")
    pictures = {kind for output in shown if "data" in output for kind in output.data}
    if path.stem == "figures_and_fit":
        assert sum("image/png" in output.get("data", {}) for output in shown) == 4
        assert "friction map" in str(shown[-1].data["text/html"])
    else:
        lines = [line for line in text.splitlines() if line.startswith("observer ")]
        assert len(lines) == 10
        intervals = [re.search(r"threshold \S+, (\S+) to (\S+) ", line) for line in lines]
        truth = Observer(0.06).threshold(TWO_ALTERNATIVES)
        # Of ten intervals of 95 %, fewer than seven contain the truth once in 1,000 runs.
        assert sum(float(found[1]) < truth < float(found[2]) for found in intervals if found) >= 7
        assert "2 plays with the same bits" in text
        assert "40 cells" in text
        assert {"image/png", "image/svg+xml"} <= pictures
