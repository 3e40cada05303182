"""`<frixel-scene>` as a widget of notebooks."""

from __future__ import annotations

import base64
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from frixel import Finger, FrixelError, ParameterError, Scene, SceneError, TouchSource, widget
from frixel.widget import SceneWidget

from .conftest import REPOSITORY

PLATE = {"layer": [{"kind": "constant", "friction_fraction": 0.5}]}
TEXTURED = """version = 1
[[layer]]
kind = "bitmap"
picture = "wall.png"
x_mm = 0
y_mm = 0
width_mm = 80
"""


def textured(scenes: Path) -> Scene:
    return Scene.parse(TEXTURED, files={"wall.png": (scenes / "textures/leather.png").read_bytes()})


def test_the_page_gets_text_files_and_profiles(scenes: Path) -> None:
    finger = "\n".join(
        line for line in (scenes / "fingers/dry.toml").read_text(encoding="utf-8").splitlines() if line[:1] != "#"
    )
    shown = SceneWidget(Scene.from_dict(PLATE).with_finger("dry").with_screen("example"), touch="500")
    state = shown.get_state(["scene", "touch"])
    text = Scene.dict_text(PLATE)
    assert state == {"scene": {"text": text, "files": {}, "finger": "dry", "screen": "example"}, "touch": "500"}

    shown.scene = textured(scenes).with_finger(Finger.parse(finger))
    picture = (scenes / "textures/leather.png").read_bytes()
    sent = {"text": TEXTURED, "files": {"wall.png": picture}, "finger": finger, "screen": None}
    assert shown.get_state("scene") == {"scene": sent}


def test_a_widget_takes_what_arguments_name_and_nothing_else() -> None:
    shown = SceneWidget(PLATE)
    assert (shown.scene, shown.touch) == (Scene.from_dict(PLATE), TouchSource.bundled("100"))
    for wrong in ["brick.toml", None]:
        with pytest.raises(ParameterError, match=r"Scene\.load reads a file"):
            SceneWidget(wrong)  # type: ignore[arg-type]
        with pytest.raises(ParameterError, match=r"Scene\.load reads a file"):
            shown.scene = wrong
    with pytest.raises(SceneError, match="friction_fractoin"):
        shown.scene = {"layer": [{"kind": "constant", "friction_fractoin": 0.5}]}
    with pytest.raises(ParameterError, match="50"):
        shown.touch = "50"
    assert shown.get_state(["scene", "touch"]) == SceneWidget(PLATE).get_state(["scene", "touch"])


def test_the_module_has_a_view_of_anywidget() -> None:
    module = SceneWidget(PLATE)._esm
    assert "export default { render };" in module
    assert "<frixel-scene>" in module


def test_without_its_script_the_widget_says_what_to_do(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(widget, "MODULE", tmp_path / "widget.js")
    with pytest.raises(FrixelError, match=r"widget\.js cannot be read .*: run `cargo xtask studio`"):
        SceneWidget(PLATE)


def test_anywidget_is_loaded_with_the_widget_only() -> None:
    code = """
import sys, frixel
print("anywidget" in sys.modules)
sys.modules["anywidget"] = None
try:
    import frixel.widget
except frixel.FrixelError as error:
    print(error)
"""
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said.splitlines() == ["False", "frixel.widget needs anywidget: install frixel[widget], or anywidget alone"]


def test_widgets_play_in_a_browser(scenes: Path, tmp_path: Path) -> None:
    second = Scene.load(scenes / "grating.toml").with_finger("dry")
    shown = [SceneWidget(textured(scenes)), SceneWidget(second, touch="500")]
    (tmp_path / "widget.js").write_text(shown[0]._esm, encoding="utf-8")
    states = [each.get_state(["scene", "touch"]) for each in shown]
    (tmp_path / "widgets.json").write_text(json.dumps(states, default=base64_text), encoding="utf-8")
    assert "STUDIO_PAGE" in os.environ, "run the tests with `cargo xtask ci python`"
    told = {"WIDGETS": str(tmp_path / "widgets.json"), "WIDGET_MODULE": str(tmp_path / "widget.js")}
    command = ["node", "--test", str(REPOSITORY / "host/studio/test/widget.mjs")]
    run = subprocess.run(command, env={**os.environ, **told}, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stdout


def base64_text(value: Any) -> str:
    return base64.b64encode(value).decode()
