"""What a notebook shows."""

from __future__ import annotations

import base64
import re
import zlib
from html.parser import HTMLParser

import numpy as np
from frixel import Scene, Simulator, Stroke

HALF = {
    "layer": [
        {"kind": "constant", "friction_fraction": 0},
        {
            "kind": "constant",
            "friction_fraction": 1,
            "region": {"x_mm": 0, "y_mm": 0, "width_mm": 60, "height_mm": 80},
        },
    ]
}


def test_a_scene_is_shown_as_its_map() -> None:
    html = Scene.from_dict(HALF)._repr_html_()
    HTMLParser().feed(html)
    data = re.search(r"base64,([^\"]+)", html)
    assert data is not None
    picture = base64.b64decode(data[1])
    assert picture.startswith(b"\x89PNG")
    begin = picture.index(b"IDAT")
    length = int.from_bytes(picture[begin - 4 : begin], "big")
    rows = np.frombuffer(zlib.decompress(picture[begin + 4 : begin + 4 + length]), np.uint8).reshape(320, 481)
    assert rows[160, 10] <= 1, "black on the left"
    assert rows[160, 470] >= 254, "white on the right"


def test_a_name_in_a_scene_is_text() -> None:
    layer = {"kind": "constant", "friction_n": 40, "name": "<script>alert(1)</script>"}
    html = Scene.from_dict({"layer": [layer]})._repr_html_()
    assert "<script" not in html
    assert "&lt;script" in html


def test_a_recording_is_shown_as_a_chart() -> None:
    html = Simulator(HALF, stroke=Stroke.straight((10, 40), (110, 40)), ideal=True).run()._repr_html_()
    HTMLParser().feed(html)
    assert html.count("<path") == 2
    paths = re.findall(r'd="M([^"]+)"', html)
    heights = [float(point.split()[1]) for point in paths[1].split("L")]
    assert max(heights) - min(heights) > 150, "the step is in the chart"
    lifted = Simulator(HALF, stroke=Stroke.from_arrays([0, 1], [10, 20], [40, 40])).run(2)
    assert lifted._repr_html_()
