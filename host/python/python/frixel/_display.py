"""HTML of scenes and recordings, for notebooks."""

from __future__ import annotations

import base64
import struct
import zlib
from html import escape

import numpy as np
from numpy.typing import NDArray

CHART_PX = (640, 200)
"""Width and height of a chart."""
POINTS_MAX = 2000
"""Largest number of points of a line."""


def png(shades: NDArray[np.uint8]) -> bytes:
    """A picture in shades of grey, of shape (rows, columns), as a PNG file."""
    rows, columns = shades.shape
    header = struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)
    # Each row begins with its filter type: 0, none.
    pixels = np.hstack([np.zeros((rows, 1), np.uint8), shades]).tobytes()
    parts = ((b"IHDR", header), (b"IDAT", zlib.compress(pixels)), (b"IEND", b""))
    chunks = (
        struct.pack(">I", len(part)) + name + part + struct.pack(">I", zlib.crc32(name + part)) for name, part in parts
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunks)


def friction_map(friction_n: NDArray[np.float64], most_n: float) -> str:
    """A map as an element of HTML: white without electric friction, black at the largest that can be reached."""
    shades = (255 * (1 - np.clip(friction_n / most_n, 0, 1))).round().astype(np.uint8)
    data = base64.b64encode(png(shades)).decode()
    return f'<img alt="friction map" style="border: 1px solid #888" src="data:image/png;base64,{data}">'


def sentences(title: str, lines: list[str]) -> str:
    """A list with a title; nothing without lines."""
    items = "".join(f"<li>{escape(line)}</li>" for line in lines)
    return f"<p>{escape(title)}</p><ul>{items}</ul>" if lines else ""


def chart(x: NDArray[np.float64], lines: dict[str, tuple[str, NDArray[np.float64]]], labels: tuple[str, str]) -> str:
    """Lines over one axis as SVG, each with its name, colour and values; a value that is not a number is a gap."""
    width, height = CHART_PX
    known = np.concatenate([values[np.isfinite(values)] for _, values in lines.values()])
    if known.size == 0:
        return ""
    low, high = float(known.min()), float(known.max())
    across = (width - 1) / max(float(x[-1] - x[0]), 1e-12)
    up = (height - 1) / max(high - low, 1e-12)
    step = max(1, -(-x.size // POINTS_MAX))
    paths = []
    for colour, values in lines.values():
        pen, path = "M", []
        for place, value in zip(x[::step], values[::step], strict=True):
            if np.isfinite(value):
                path.append(f"{pen}{(place - x[0]) * across:.1f} {(high - value) * up:.1f}")
                pen = "L"
            else:
                pen = "M"
        paths.append(f'<path d="{" ".join(path)}" fill="none" stroke="{colour}"/>')
    legend = " ".join(f'<span style="color: {colour}">{escape(name)}</span>' for name, (colour, _) in lines.items())
    caption = (
        f"{escape(labels[0])} {low:.3g} to {high:.3g}, over {escape(labels[1])} {x[0]:.3g} to {x[-1]:.3g}: {legend}"
    )
    return f'<figure><svg width="{width}" height="{height}">{"".join(paths)}</svg><p>{caption}</p></figure>'
