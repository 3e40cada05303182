"""Scores, which are those of the command."""

from __future__ import annotations

import json
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import frixel
import pytest
from frixel import ParameterError, Scene, SceneError, Stroke

FLAT = {"layer": [{"kind": "constant", "friction_fraction": 0.5}]}
SHORT = ["--strokes", "1", "--seeds", "1", "--seconds", "0.5"]
SHORT_SETTINGS: dict[str, Any] = {"strokes": 1, "seeds": 1, "seconds": 0.5}


@pytest.mark.parametrize(
    ("options", "settings"),
    [
        ([*SHORT, "--people", "3"], {**SHORT_SETTINGS, "people": 3, "jobs": 1}),
        (["--strokes", "2", "--seeds", "2", "--seconds", "0.5"], {"strokes": 2, "seeds": 2, "seconds": 0.5}),
        ([*SHORT, "--stroke", "human-rough", "--touch", "500"], {"stroke": "human-rough", "touch": "500"}),
        (
            [*SHORT[2:], "--stroke", "sweep", "--ideal", "--finger", "dry"],
            {"stroke": "sweep", "ideal": True, "finger": "dry"},
        ),
        (
            ["--strokes", "1", "--seconds", "0.5", "--median-speed-mm-per-s", "80", "--seeds", "1", "--touch", "200"],
            {"median_speed_mm_per_s": 80, "touch": "200"},
        ),
    ],
)
def test_a_score_has_the_bits_of_the_command(
    tmp_path: Path, scenes: Path, options: list[str], settings: dict[str, Any]
) -> None:
    path = scenes / "brick.toml"
    command = [os.environ["FRIXEL"], "score", str(path), "--json", "--out", str(tmp_path), *options]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    found = frixel.score(Scene.load(path), **{**SHORT_SETTINGS, **settings})
    assert found.summary == json.loads(printed)
    for name, text in found.files.items():
        assert (tmp_path / name).read_text() == text
    assert found.verdict == json.loads(printed)["verdict"]
    assert found.words.lstrip().startswith(found.verdict)
    assert [row["layer"] for row in found.layers] == [row["layer"] for row in found.summary["layers"]]
    assert found.numbers["error"]["mean"] == found.summary["metrics"][0]["mean"]
    assert {type(row["contrast_weber_steps"]) for row in found.layers} == {float}
    assert len(found.plays) == len(found.summary["plays"])


def test_a_score_is_data_that_can_be_sent_elsewhere() -> None:
    found = frixel.score(FLAT, **SHORT_SETTINGS, people=2)
    assert pickle.loads(pickle.dumps(found)) == found
    assert found.summary["simulated_fingers"] == 2
    row = found.layers[0]
    assert (row["layer"], row["simulated_fingers"], row["border_with"]) == ("layer 1 (constant)", 2, None)
    assert frixel.score(FLAT, **SHORT_SETTINGS, people=2, jobs=2) == found
    assert frixel.score(FLAT, **SHORT_SETTINGS, people=2, stroke=Stroke.straight((10, 40), (90, 40))) != found
    assert "<pre>" in found._repr_html_()


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"people": 0}, "people must be a whole number from 1 to 1000, but is 0"),
        ({"strokes": 1.5}, "strokes must be a whole number from 1 to 1000, but is 1.5"),
        ({"seconds": 0}, "seconds must be a number from 0.001 to 86400, but is 0"),
        ({"median_speed_mm_per_s": "fast"}, "median_speed_mm_per_s must be a number from 1 to 1000, but is 'fast'"),
        ({"jobs": 0}, "jobs must be a whole number from 1 to 1000, but is 0"),
        ({"stroke": "natural"}, 'a stroke must be "human", "human-rough", "sweep" or a Stroke'),
        ({"stroke": 3}, 'a stroke must be "human", "human-rough", "sweep" or a Stroke, but is 3'),
        ({"people": 1000, "seeds": 1000}, "are 4000000 plays, and at most 100000 are scored: give fewer, or split"),
        ({"people": 1000, "seconds": 600}, "are 2400000 s of strokes, and 36000 s fit into memory: give fewer or"),
        ({"stroke": "sweep", "median_speed_mm_per_s": 50}, "only human strokes have a median speed: leave it out"),
        ({"touch": "50"}, "no bundled touch source is named `50`"),
    ],
)
def test_what_is_not_taken_is_said(settings: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ParameterError, match=sentence):
        frixel.score(FLAT, **settings)


def test_a_scene_that_is_none_or_refused_is_said() -> None:
    with pytest.raises(ParameterError, match=r"\(Scene\.load reads a file\), but is 'brick.toml'"):
        frixel.score("brick.toml")  # type: ignore[arg-type]
    with pytest.raises(SceneError, match="40"):
        frixel.score({"layer": [{"kind": "constant", "friction_n": 40}]})


@pytest.mark.skipif(os.name != "posix", reason="signals are sent as on Unix")
@pytest.mark.parametrize(
    "work",
    [
        "frixel.score(scene, strokes=1, seconds=60, seeds=100)",
        # Many strokes are made before the first one is played.
        "frixel.score(scene, people=60, strokes=1, seconds=600, seeds=1)",
        "frixel.sweep.play(cells[0])",
        # 250,000 combinations are compiled.
        "frixel.sweep.cells({**plan, 'parameters': values})",
        # 499 tables of 40,000 means are drawn and fitted.
        "frixel.fit(means)",
        "frixel.model.eval(soft, numpy.full(10_000_000, 150.0), 0.5)",
        "frixel.Scene.from_dict(rough).map(10_000, 8_000)",
    ],
)
def test_an_interrupt_ends_long_work(work: str) -> None:
    program = (
        "import frixel, numpy\nscene = {'layer': [{'kind': 'constant', 'friction_fraction': 0.5}]}\n"
        "plan = {'scenes': {'plate': scene}, 'people': 1, 'strokes': 1, 'seconds': 60, 'seeds': 100}\n"
        "values = {'layer.1.friction_fraction': {'from': 0.2, 'to': 0.3, 'count': 1000}}\n"
        "values['drive.voltage_max_v_rms'] = {'from': 40, 'to': 50, 'count': 250}\n"
        "cells = frixel.sweep.cells(plan)\n"
        "volts = [0.0, 75.0, 106.0, 150.0] * 10000\n"
        "means = {'voltage_v_rms': volts, 'normal_force_n': [0.5] * 40000, 'friction_se_n': [0.01] * 40000}\n"
        "means['friction_n'] = [0.25 + 5e-6 * v**2 for v in volts]\n"
        "soft = frixel.model.SoftContact(radius_m=8e-3, modulus_pa=1e5, stress_exponent=0.3, shape_constant=1.0, "
        "friction_coefficient=0.4, gap_m=6e-6)\n"
        "noise = {'kind': 'noise', 'wavelength_min_mm': 0.6, 'wavelength_max_mm': 1.5, 'low_fraction': 0.2}\n"
        "rough = {'layer': [{**noise, 'high_fraction': 0.4, 'blend': 'add'}] * 4}\n"
        f"print('begun', flush=True)\ntry:\n    {work}\nexcept KeyboardInterrupt:\n    print('interrupted')\n"
    )
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stdout.readline() == "begun\n"
    time.sleep(0.5)
    child.send_signal(signal.SIGINT)
    try:
        # Without the interrupt, the work takes longer.
        assert child.communicate(timeout=20)[0] == "interrupted\n"
    finally:
        child.kill()
        child.communicate()


def test_other_threads_run_while_a_score_is_computed() -> None:
    thread = threading.Thread(target=lambda: frixel.score(FLAT, jobs=1))
    thread.start()
    looks = 0
    while thread.is_alive():
        thread.join(0.001)
        looks += 1
    assert looks > 20
