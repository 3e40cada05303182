"""What documents and examples show is run."""

from __future__ import annotations

import doctest
import importlib
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest

from .conftest import REPOSITORY

EXAMPLES = sorted((REPOSITORY / "host/python/examples").glob("*.py"))


def test_the_blocks_of_the_document_run_one_after_the_other(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    mpl.use("agg")
    monkeypatch.chdir(tmp_path)
    text = (REPOSITORY / "docs/python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert len(blocks) >= 5
    names: dict[str, Any] = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    printed = capsys.readouterr().out
    assert "nan" in printed
    assert "3 8 " in printed, "the place of the mistake"
    assert (tmp_path / "play.parquet").stat().st_size > 0
    np.testing.assert_allclose(names["recordings"][2]["t_s"][-1], 0.5)


@pytest.mark.parametrize("name", ["frixel.simulator", "frixel.profiles"])
def test_the_examples_in_docstrings_are_true(name: str) -> None:
    failed, attempted = doctest.testmod(importlib.import_module(name))
    assert attempted > 0
    assert failed == 0


@pytest.mark.parametrize("example", EXAMPLES, ids=[path.stem for path in EXAMPLES])
def test_an_example_runs(example: Path, tmp_path: Path) -> None:
    subprocess.run([sys.executable, str(example)], check=True, cwd=tmp_path, env={"MPLBACKEND": "agg"}, timeout=600)
