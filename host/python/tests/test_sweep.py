"""Studies of many simulated fingers, on one process, on several, and on two workers of which one is killed."""

from __future__ import annotations

import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import psutil
import pytest
from dask.distributed import Client, LocalCluster, as_completed
from frixel import FrixelError, ParameterError, Scene, SceneError, sweep

from .conftest import REPOSITORY

GRATING = """version = 1
[[layer]]
kind = "grating"
wavelength_mm = 4
low_n = 0.0
high_n = 0.1
"""
PLAN = """scenes = ["grating.toml"]
people = 40
strokes = 1
seeds = 1
seconds = 0.5
[parameters]
"layer.1.high_n" = [0.02]
"""
FINGERS = 40


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    (tmp_path / "grating.toml").write_text(GRATING)
    (tmp_path / "plan.toml").write_text(PLAN)
    return tmp_path / "plan.toml"


def of_command(plan: Path) -> dict[str, bytes]:
    """The files that one process of the command writes."""
    out = plan.parent / "study"
    command = [os.environ["FRIXEL"], "sweep", str(plan), "-o", str(out), "--jobs", "1"]
    subprocess.run(command, check=True, capture_output=True)
    return {path.name: path.read_bytes() for path in out.iterdir() if path.is_file() and path.suffix != ".lock"}


@pytest.mark.skipif(os.name != "posix", reason="a worker is killed as on Unix")
def test_two_dask_workers_of_which_one_is_killed_give_the_bytes_of_one_process(plan: Path) -> None:
    cells = sweep.cells(plan)
    assert len(cells) == FINGERS
    local = {"host": "127.0.0.1", "dashboard_address": None, "worker_dashboard_address": None}
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, silence_logs="CRITICAL", **local) as cluster,
        Client(cluster) as client,
    ):
        workers: dict[str, int] = client.run(os.getpid)
        assert len(workers) == 2
        listening = {
            connection.laddr.ip
            for pid in [os.getpid(), *workers.values()]
            for connection in psutil.Process(pid).net_connections()
            if connection.status == psutil.CONN_LISTEN
        }
        assert listening == {"127.0.0.1"}
        futures = client.map(sweep.play, cells, pure=False)
        ended = as_completed(futures, timeout=300)
        for _ in range(FINGERS // 4):
            next(ended)
        left = sum(not future.done() for future in futures)
        assert left > FINGERS // 4, "the worker is killed in the middle"
        os.kill(next(iter(workers.values())), signal.SIGKILL)
        results = client.gather(futures, asynchronous=False)
        assert set(client.run(os.getpid).values()) != set(workers.values()), "a worker was lost"
    study = sweep.Study(results)
    assert study.files == of_command(plan)


def test_the_program_of_the_document_gives_the_bytes_of_the_command(plan: Path) -> None:
    plan.write_text(PLAN.replace("people = 40", "people = 2").replace("[0.02]", "[0.005, 0.02]"))
    text = (REPOSITORY / "docs/python/scale.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    program = plan.parent / "program.py"
    program.write_text(block)
    subprocess.run([sys.executable, program], check=True, cwd=plan.parent, timeout=300)
    written = {path.name: path.read_bytes() for path in (plan.parent / "study").iterdir()}
    shutil.rmtree(plan.parent / "study")
    assert written == of_command(plan)


def test_processes_share_the_work(plan: Path) -> None:
    cells = sweep.cells(plan)[::10]
    here = [sweep.play(cell) for cell in cells]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        assert list(pool.map(sweep.play, cells)) == here
    copy = pickle.loads(pickle.dumps(sweep.Study(here)))
    assert copy.files == sweep.Study(here).files


def test_a_study_is_rows_a_picture_and_files(tmp_path: Path) -> None:
    plate = Scene.parse(GRATING)
    fields: dict[str, Any] = {"people": 3, "strokes": 1, "seeds": 1, "seconds": 0.5}
    values = {"layer.1.high_n": [0.002, 0.1]}
    study = sweep.Study(map(sweep.play, sweep.cells({"scenes": {"1": plate}, **fields, "parameters": values})))
    assert [(row["scene"], row["layer.1.high_n"], row["simulated_fingers"]) for row in study.layers] == [
        ("1", 0.002, 3),
        ("1", 0.1, 3),
    ]
    low, high = (row["felt_share"] for row in study.layers)
    assert low < high == 1
    assert len(study.fingers) == 6
    assert {row["number"] for row in study.numbers} >= {"error", "delay_ms"}
    assert study._repr_svg_().startswith("<svg")
    assert "felt by 3 of 3" in str(study)
    study.write(tmp_path / "new" / "study")
    assert (tmp_path / "new" / "study" / "sweep.svg").read_bytes() == study.files["sweep.svg"]
    with pytest.raises(FrixelError, match="this study cannot be written"):
        study.write("/dev/null/study")


def test_a_study_does_not_replace_another_one_unasked(tmp_path: Path) -> None:
    fields: dict[str, Any] = {"scenes": {"grating": Scene.parse(GRATING)}, "strokes": 1, "seeds": 1, "seconds": 0.5}
    one, two = (sweep.Study(map(sweep.play, sweep.cells({**fields, "people": people}))) for people in (1, 2))
    one.write(tmp_path)
    one.write(tmp_path)

    def written() -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    with pytest.raises(FrixelError, match="is from another study: give another folder, or `overwrite=True`"):
        two.write(tmp_path)
    assert written() == one.files
    # One of the files cannot be written.
    in_the_way = tmp_path / ".sweep.svg.frixel-tmp"
    in_the_way.mkdir()
    with pytest.raises(FrixelError, match=r"sweep\.svg cannot be written"):
        two.write(tmp_path, overwrite=True)
    in_the_way.rmdir()
    assert written() == one.files, "a half-written study is not there"
    two.write(tmp_path, overwrite=True)
    assert written() == two.files


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"people": 0}, "people is 0: give a number from 1 to 1000000"),
        ({"peple": 3}, r"<plan>:\d+:1: the plan has no field `peple`: did you mean `people`"),
        ({"scenes": ["nowhere.toml"]}, "nowhere.toml cannot be read"),
        ({"scenes": {}}, "give the name of one scene file or more"),
        (
            {"scenes": "grating.toml"},
            "or a dictionary of scenes by their names, but is 'grating.toml'",
        ),
        (
            {"scenes": {"a": Scene.parse(GRATING).with_finger("dry")}},
            "the scene a is for another finger or screen .* and screens in `screens`",
        ),
        (
            {"scenes": {"a": Scene.parse(GRATING).with_screen("example")}},
            "the scene a is for another finger or screen",
        ),
        ({"scenes": {"a": "grating.toml"}}, r"\(Scene\.load reads a file\), but is 'grating.toml'"),
        ({"touch": ["50"]}, "give its file, from the plan's folder, or a bundled one"),
        ({"parameters": {"layer.2.high_n": [1]}}, "has no layer 2, but 1 layer: write layer.1"),
        (
            {"parameters": {"layer.1.high_n": 0.1}},
            r'<plan>:\d+:1: parameter "layer\.1\.high_n": give a list of values, or \{ from, to, count \}',
        ),
    ],
)
def test_a_plan_with_a_mistake_is_refused(fields: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ParameterError, match=sentence):
        sweep.cells({"scenes": {"grating": Scene.parse(GRATING)}, "people": 1, **fields})


def test_what_is_no_plan_no_cell_and_no_result_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"nowhere\.toml cannot be read"):
        sweep.cells(tmp_path / "nowhere.toml")
    (tmp_path / "finger.toml").write_text("friction_coefficient = 0.5\n")
    with pytest.raises(ParameterError, match="this is a finger profile; expected a plan of a sweep: pass it"):
        sweep.cells(tmp_path / "finger.toml")
    with pytest.raises(ParameterError, match=r"expected a cell made by `sweep\.cells`"):
        sweep.play("{}")
    with pytest.raises(ParameterError, match=r"a cell must be a string made by `sweep\.cells`, but is 3"):
        sweep.play(3)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match="a study needs one result or more"):
        sweep.Study([])
    with pytest.raises(ParameterError, match=r"expected a result made by `sweep\.play`"):
        sweep.Study(["{}"])
    (cell,) = sweep.cells({"scenes": {"grating": Scene.parse(GRATING)}, "people": 1})
    with pytest.raises(ParameterError, match=r"this cell is from frixel 0\.0\.9"):
        sweep.play(cell.replace('"version":"0.1.0"', '"version":"0.0.9"'))
    values = {"layer.1.high_n": [40]}
    with pytest.raises(SceneError, match=r"^<plan>:\d+:1: grating with layer\.1\.high_n = 40: grating:\d+:\d+: "):
        sweep.cells({"scenes": {"grating": Scene.parse(GRATING)}, "people": 1, "parameters": values})
    place: dict[str, list[int]] = {"x_mm": [20, 100], "y_mm": [10], "width_mm": [10, 80], "height_mm": [10]}
    values = {f"layer.1.region.{field}": numbers for field, numbers in place.items()}
    *_, last = sweep.cells({"scenes": {"grating": Scene.parse(GRATING)}, "people": 1, "parameters": values})
    with pytest.raises(SceneError, match="past the right edge"):
        sweep.play(last)
