"""Scenes, fingers and screens."""

from __future__ import annotations

import json
import os
import pickle
import subprocess
from pathlib import Path

import numpy as np
import pytest
from frixel import Finger, FrixelError, ParameterError, Scene, SceneError, Screen, TouchSource

FLAT = {"layer": [{"kind": "constant", "friction_fraction": 0.5}]}


def test_every_bundled_scene_is_read_and_pickled(scenes: Path) -> None:
    paths = sorted(scenes.glob("*.toml"))
    assert len(paths) > 10
    for path in paths:
        scene = Scene.load(path)
        copy = pickle.loads(pickle.dumps(scene))
        assert copy == scene
        assert copy.layers == scene.layers
        assert len(scene.layers) > 0


def test_all_mistakes_are_told_with_their_places() -> None:
    text = 'version = 1\n[[layer]]\nkind = "constnt"\n[[layer]]\nkind = "constant"\nfriction_n = "much"\n'
    with pytest.raises(SceneError) as caught:
        Scene.parse(text)
    error = caught.value
    assert isinstance(error, FrixelError)
    assert isinstance(error, ValueError)
    assert (error.line, error.column) == (3, 8)
    assert error.mistakes[0].nearest == "constant"
    assert error.mistakes[1].line == 6
    assert str(error).splitlines()[0] == f"<scene>:3:8: {error.mistakes[0].message}"
    assert pickle.loads(pickle.dumps(error)).mistakes == error.mistakes


def test_a_scene_that_is_no_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match=r"nothing\.toml cannot be read \(.+\): check the path"):
        Scene.load(tmp_path / "nothing.toml")
    with (tmp_path / "large.toml").open("wb") as large:
        large.truncate((4 << 20) + 1)
    with pytest.raises(SceneError, match="bytes, and at most 4194304 are read"):
        Scene.load(tmp_path / "large.toml")
    with pytest.raises(SceneError, match="a regular file is expected"):
        Scene.load("/dev/zero")
    with pytest.raises(SceneError, match="cannot be read"):
        Scene.load(tmp_path)
    (tmp_path / "brick.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(5 << 20))
    with pytest.raises(SceneError, match=r"brick\.png:1:1: this is a picture; expected a scene: make a scene"):
        Scene.load(tmp_path / "brick.png")
    with pytest.raises(SceneError, match=r"brick\.png:1:1: this is a picture; expected a finger profile: make a scene"):
        Finger.load(tmp_path / "brick.png")
    with pytest.raises(SceneError, match="this is a scene; expected a screen: play it with `frixel play`"):
        Screen.parse("version = 1\n")
    (tmp_path / "picture.toml").write_text('version = 1\n[[layer]]\nkind = "picture"\nfile = "brik.png"\n')
    with pytest.raises(SceneError):
        Scene.load(tmp_path / "picture.toml")


def test_tables_make_a_scene() -> None:
    tables = {
        "version": 1,
        "layer": [
            {"kind": "constant", "friction_n": np.float64(0.26), "name": 'say "hü"'},
            {
                "kind": "grating",
                "wavelength_mm": np.int64(4),
                "low_fraction": 0,
                "high_fraction": 0.9,
                "region": {"x_mm": 10, "y_mm": 10, "width_mm": 20, "height_mm": 20},
            },
        ],
        "drive": {"saturate": True},
    }
    scene = Scene.from_dict(tables)
    assert scene == Scene.parse(Scene.dict_text(tables))
    assert len(scene.layers) == 2
    assert 'say "hü"' in scene.layers[0]
    with pytest.raises(SceneError, match="contains a control or invisible character"):
        Scene.from_dict({"layer": [{"kind": "constant", "friction_n": 0.26, "name": "\n\x7f\\"}]})
    with pytest.raises(ParameterError, match="a field must be a string, a number, a list or a table, but is None"):
        Scene.from_dict({"layer": [{"kind": None}]})
    with pytest.raises(SceneError) as caught:
        Scene.from_dict({"layer": [{"kind": "constant", "frictio_n": 1}]})
    assert caught.value.mistakes[0].nearest == "friction_n"
    assert Scene.dict_text({"layer": [{"kind": "constant", "frictio_n": 1}]}).splitlines()[4] == "frictio_n = 1"


def test_another_finger_and_screen() -> None:
    scene = Scene.from_dict(FLAT)
    dry = scene.with_finger("dry")
    assert dry.reach_n != scene.reach_n
    assert pickle.loads(pickle.dumps(dry)).reach_n == dry.reach_n
    assert scene.with_screen("example").screen_mm == (120.0, 80.0)
    with pytest.raises(ParameterError, match="no bundled finger is named `dri`: did you mean `dry`"):
        scene.with_finger("dri")
    assert "dry" in Finger.bundled_names()
    assert TouchSource.bundled_names() == ["100", "200", "500"]
    assert Screen.bundled_names() == ["example"]
    with pytest.raises(SceneError) as caught:
        Finger.from_dict({"friction_coefficient": -1})
    assert caught.value.mistakes[0].file == "<finger>"


def test_a_map_is_the_friction_at_each_place() -> None:
    scene = Scene.from_dict(
        {
            "layer": [
                {"kind": "constant", "friction_fraction": 0.25},
                {
                    "kind": "constant",
                    "friction_fraction": 0.75,
                    "region": {"x_mm": 0, "y_mm": 0, "width_mm": 60, "height_mm": 80},
                },
            ]
        }
    )
    friction = scene.map(120, 80)
    assert friction.shape == (80, 120)
    natural, most = scene.reach_n
    np.testing.assert_allclose(friction[40, 10], 0.75 * (most - natural), rtol=1e-3)
    np.testing.assert_allclose(friction[40, 110], 0.25 * (most - natural), rtol=1e-3)


def test_a_check_says_what_the_command_says(scenes: Path) -> None:
    path = scenes / "brick.toml"
    report = Scene.load(path).check(touch="200")
    assert report["layers"] > 0
    assert report["judgement"]
    command = [os.environ["FRIXEL"], "check", str(path), "--touch", "200", "--json"]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    assert json.loads(printed) == report


def test_what_a_board_refuses_is_a_draft_and_not_checked() -> None:
    scene = Scene.from_dict({"layer": [{"kind": "constant", "friction_n": 40}]})
    assert scene.refusals
    with pytest.raises(SceneError, match="40"):
        scene.check()
