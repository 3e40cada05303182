"""Plays on the simulator, and their recordings."""

from __future__ import annotations

import csv
import dataclasses
import json
import os
import pickle
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import frixel
import numpy as np
import pyarrow.parquet as parquet
import pytest
from frixel import Finger, ParameterError, Recording, Scene, Simulator, Stroke

FLAT = {"layer": [{"kind": "constant", "friction_fraction": 0.5}]}
DECIMALS = {"t_s": 6, "x_mm": 4, "y_mm": 4, "speed_mm_s": 3, "reference_n": 9, "commanded_n": 9, "felt_n": 9}


def bits(recording: frixel.Recording) -> dict[str, bytes]:
    """The bytes of each column."""
    return {name: values.tobytes() for name, values in recording.items()}


def felt_csv(tmp_path: Path, scene: Path, *options: str) -> list[dict[str, str]]:
    """The rows that the command writes."""
    command = [os.environ["FRIXEL"], "play", str(scene), "--port", "sim", "--out", str(tmp_path / "out"), *options]
    subprocess.run(command, check=True, capture_output=True)
    with (tmp_path / "out" / "felt.csv").open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize(
    ("name", "options", "arguments", "seconds"),
    [
        ("brick", [], {}, None),
        ("slider", ["--seed", "7", "--seconds", "1.5"], {"seed": 7}, 1.5),
        ("brick", ["--finger-seed", "3", "--touch", "500", "--seconds", "1"], {"person": 3, "touch": "500"}, 1),
        ("brick", ["--ideal", "--csv-hz", "500", "--seconds", "1"], {"ideal": True, "rows_per_s": 500}, 1),
        ("brick", ["--skin", "no-leakage", "--seconds", "1"], {"leakage": False}, 1),
        ("brick", ["--skin", "mean-square", "--seconds", "1"], {"mean_square": True}, 1),
        ("brick", ["--finger", "dry", "--seconds", "1"], {"finger": "dry"}, 1),
        ("brick", ["--stroke", "human", "--seed", "5", "--seconds", "2"], {"stroke": Stroke.human(5), "seed": 5}, 2),
        (
            "brick",
            ["--from", "10,20", "--to", "100,60", "--speed", "80", "--minimum-jerk"],
            {"stroke": Stroke.straight((10, 20), (100, 60), speed_mm_s=80, minimum_jerk=True)},
            None,
        ),
    ],
)
def test_a_play_has_the_bits_of_the_command(
    tmp_path: Path, scenes: Path, name: str, options: list[str], arguments: dict[str, object], seconds: float | None
) -> None:
    path = scenes / f"{name}.toml"
    rows = felt_csv(tmp_path, path, *options)
    recording = frixel.run({"scene": Scene.load(path), "seconds": seconds, **arguments})
    assert recording.rows == len(rows) > 400
    assert [row["flags"] for row in rows] == recording["flags"].tolist()
    for column, decimals in {**DECIMALS, "voltage_v_rms": 4, "dac_code": 0}.items():
        written = np.array([float(row[column] or "nan") for row in rows])
        # Half a step of the file is the most that its rounding takes away.
        np.testing.assert_allclose(recording[column], written, rtol=0, atol=0.5001 * 10.0**-decimals, err_msg=column)
    assert np.isfinite(recording["felt_n"]).sum() > 100


def test_the_same_settings_give_the_same_bits_here_and_in_another_process() -> None:
    cell = {"scene": FLAT, "seed": 3, "person": 1, "stroke": Stroke.human(2), "seconds": 0.5}
    here = frixel.run(cell)
    assert bits(here) == bits(frixel.run(cell))
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        there = pool.submit(frixel.run, cell).result()
    assert bits(here) == bits(there)
    other = frixel.run({**cell, "seed": 4})
    assert bits(here) != bits(other)


def test_a_stroke_from_arrays_goes_where_it_says() -> None:
    t_s = np.linspace(0, 1, 11)
    x_mm = 10 + 50 * t_s
    x_mm[5] = np.nan
    stroke = Stroke.from_arrays(t_s, x_mm, np.where(np.isnan(x_mm), np.nan, 30.0), load_n=np.full(11, 0.7))
    recording = Simulator(FLAT, stroke=stroke, ideal=True).run()
    at = np.searchsorted(recording["t_s"], 0.25)
    assert recording["x_mm"][at] == pytest.approx(22.5, abs=0.1)
    assert np.isnan(recording["x_mm"][np.searchsorted(recording["t_s"], 0.5)])
    light = Simulator(FLAT, stroke=Stroke.from_arrays([0, 1], [10, 60], [30, 30], [0.2, 0.2]), ideal=True).run()
    assert light["felt_n"][at] < recording["felt_n"][at], "a light finger has less friction"


def test_a_stroke_that_leaves_the_screen_is_doubted() -> None:
    stroke = Stroke.straight((100, 40), (140, 40), speed_mm_s=100)
    with pytest.warns(frixel.FrixelWarning, match=r"off the screen \(120 by 80 mm\) for 5\d\.\d % of the stroke"):
        Simulator(FLAT, stroke=stroke, ideal=True, rows_per_s=100).run()


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Simulator(FLAT, stroke=Stroke.straight((500, 20), (600, 20))).run(), "nowhere on the screen"),
        (lambda: Stroke.straight((5, 20), (60, 20), speed_mm_s=-5), "speed_mm_s must be a number above 0, but is -5"),
        (
            lambda: Simulator(FLAT, stroke=Stroke.straight((5, 20), (60, 20), speed_mm_s=20_000)).run(),
            "the finger slides at 20000 mm/s: give a speed above 0, at most 10000 mm/s",
        ),
        (lambda: Stroke.straight((5, np.nan), (60, 20)), "from_mm must be x and y in mm, but is"),
        (lambda: Stroke.human(1, seconds=-1), "seconds must be a number above 0, but is -1"),
        (Stroke, "a stroke is made by Stroke.straight, human or from_arrays"),
        (lambda: Simulator(FLAT, rows_per_s=7).run(1), "rows_per_s: 7 rows a second do not .*; give 5 or 8"),
        (lambda: Simulator(FLAT).run(-1), "a play lasts from one tick"),
        (lambda: Simulator(FLAT).run(float("nan")), "a play lasts from one tick"),
        (lambda: Simulator(FLAT, stroke="human"), "a stroke must be made by Stroke.straight, human or from_arrays"),  # type: ignore[arg-type]
        (lambda: Stroke.from_arrays([0, 1], [1, 2], [1]), "arrays of one length"),
        (lambda: Stroke.from_arrays([-1, 1], [1, 2], [1, 2]), r"t_s\[0\]: -1 is below 0: give time"),
        (lambda: Stroke.from_arrays([0, np.nan], [1, 2], [1, 2]), r"t_s\[1\] must be finite, but is nan"),
        (lambda: Stroke.from_arrays([0, 1], [1, 2], [1, 2], [0.5, 500]), r"load_n\[1\]: 500 .* at most 50$"),
        (lambda: Simulator(FLAT, stroke=Stroke.straight((5, 20), (5, 20))).run(), "give two places that differ"),
        (lambda: Stroke.from_arrays([0, 1], [1, np.nan], [1, 2]), r"x_mm\[1\]: unknown, where y_mm is known"),
        (lambda: Stroke.from_arrays([0, 1], [1, 2], [1, np.inf]), r"y_mm\[1\] must be finite or NaN, but is inf"),
        (lambda: Stroke.from_arrays([0], [1], [2]), "the stroke has one row only: give at least two"),
        (lambda: Stroke.from_arrays([1, 0], [1, 2], [1, 2]), r"t_s\[1\]: 0 comes after 1"),
        (lambda: Simulator("brick.toml"), r"\(Scene\.load reads a file\), but is 'brick.toml'"),  # type: ignore[arg-type]
        (lambda: Simulator(FLAT, seed=-1), "seed must be a whole number from 0 to 18446744073709551615, but is -1"),
        (lambda: Simulator(FLAT, person=1.5), "person must be a whole number from 0 to .*, but is 1.5"),  # type: ignore[arg-type]
        (lambda: Simulator(FLAT, rows_per_s=0), "rows_per_s must be a whole number from 1 to 40000, but is 0"),
        (
            lambda: Simulator(FLAT, rows_per_s=2**40).run(1),
            "rows_per_s must be a whole number from 1 to 40000, but is 1099511627776",
        ),
        (lambda: Simulator(FLAT, finger="me.toml"), "Finger.load reads a file"),
        (lambda: Simulator(FLAT, finger=3), "a finger must be a Finger, a name, or a table, but is 3"),  # type: ignore[arg-type]
        (lambda: Scene.from_dict(FLAT).map(0, 5), "width must be a whole number from 1 to 10000, but is 0"),
        (lambda: Stroke.straight((1,), (2, 3)), "from_mm must be x and y in mm"),  # type: ignore[arg-type]
        (lambda: Stroke.human(-1), "seed must be a whole number from 0 to 18446744073709551615, but is -1"),
        (lambda: Simulator(FLAT, touch="50"), "no bundled touch source is named `50`"),
    ],
)
def test_what_is_not_taken_is_said(make: object, sentence: str) -> None:
    assert callable(make)
    with pytest.raises(ParameterError, match=sentence):
        make()


def test_a_recording_becomes_tables() -> None:
    recording = Simulator(FLAT, seed=2).run(0.1)
    frame = recording.to_pandas()
    assert list(frame.columns) == list(frixel.COLUMNS) == list(recording)
    assert len(frame) == recording.rows == 100
    assert frame.attrs["seed"] == 2
    assert frame["flags"].iloc[-1] == str(recording["flags"][-1])
    dataset = recording.to_xarray()
    assert dataset.felt_n.attrs["units"] == "N"
    np.testing.assert_array_equal(dataset.t_s, recording["t_s"])
    copy = pickle.loads(pickle.dumps(recording))
    np.testing.assert_array_equal(copy["felt_n"], recording["felt_n"])
    assert "100 rows, 0.100 s" in repr(recording)


def test_a_recording_as_parquet_has_what_the_command_records(tmp_path: Path, scenes: Path) -> None:
    path, ours, theirs = scenes / "brick.toml", tmp_path / "ours.parquet", tmp_path / "theirs.parquet"
    felt_csv(tmp_path, path, "--seconds", "0.5", "--record", str(theirs))
    recording = Simulator(Scene.load(path)).run(0.5)
    recording.to_parquet(ours)
    assert ours.read_bytes() == theirs.read_bytes(), "the same play has the same file"
    one, other = (parquet.read_table(file) for file in (ours, theirs))
    assert one.column_names == other.column_names == list(frixel.COLUMNS)
    assert one.num_rows == 500
    metadata = parquet.read_metadata(ours).metadata
    assert metadata[b"frixel.scene"].decode() == path.read_text(encoding="utf-8")
    assert b"textures/" in metadata[b"frixel.files"]
    copy = pickle.loads(pickle.dumps(recording))
    copy.to_parquet(tmp_path / "copy.parquet")
    assert (tmp_path / "copy.parquet").read_bytes() == ours.read_bytes()
    with pytest.raises(frixel.FrixelError, match=r"ours\.parquet cannot be written .*: check the folder"):
        recording.to_parquet(tmp_path / "nowhere" / "ours.parquet")


def test_a_recording_of_a_person_is_replaced_only_with_overwrite(tmp_path: Path) -> None:
    path, simulated = tmp_path / "P07.parquet", Simulator(FLAT).run(0.1)
    simulated.to_parquet(path)
    simulated.to_parquet(path, participant="P07")
    made = json.loads(simulated.made)
    made["metadata"]["is_simulated"] = False
    dataclasses.replace(simulated, made=json.dumps(made)).to_parquet(path)
    stroke = tmp_path / "stroke.csv"
    stroke.write_text("t_s,x_mm,y_mm\n0,1,2\n")
    for kept in (path, stroke):
        content = kept.read_bytes()
        with pytest.raises(frixel.FrixelError, match="is a recording of a person: give another name, or `overwrite="):
            simulated.to_parquet(kept)
        assert kept.read_bytes() == content
        simulated.to_parquet(kept, overwrite=True)
        assert Recording.load(kept) == simulated


@pytest.mark.skipif(os.name != "posix", reason="limits are those of Unix")
def test_a_full_disk_leaves_the_earlier_recording(tmp_path: Path) -> None:
    import resource

    path, recording = tmp_path / "me.parquet", Simulator(FLAT).run(0.1)
    recording.to_parquet(path)
    content = path.read_bytes()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    # The limit of the process stands for the disk: a write beyond it fails in the middle.
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(content) // 2, hard))
    try:
        with pytest.raises(frixel.FrixelError, match=r"me\.parquet cannot be written \(File too large"):
            recording.to_parquet(path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert path.read_bytes() == content
    assert list(tmp_path.iterdir()) == [path], "what did not fit takes no room"


T_S = np.linspace(0, 0.6, 61)
X_MM = np.where(np.arange(61) == 30, np.nan, 10 + 50 * np.sqrt(T_S))
TOUCH = {"reports_per_s": 120, "latency_ms": 8, "lost_share": 0.05}
FINGER = {
    "friction_coefficient": 0.6,
    "normal_load_n": 0.45,
    "radius_mm": 7.7,
    "skin_gap_um": 4.1,
    "stiffness_pa_per_m": 1.7e7,
    "origin": "assumed",
}


@pytest.mark.parametrize(
    ("arguments", "seconds"),
    [
        ({}, None),
        ({"seed": 2**64 - 1, "ideal": True, "rows_per_s": 500}, 0.3),
        ({"person": 7, "touch": TOUCH, "stroke": Stroke.human(3, rough=True)}, 0.5),
        ({"stroke": Stroke.human(3, seconds=0.7), "seed": 11, "leakage": False}, None),
        ({"stroke": Stroke.straight((10.1, 20.3), (33.3, 21.7), speed_mm_s=77.7, minimum_jerk=True)}, None),
        ({"finger": FINGER, "screen": "example", "touch": "500", "rows_per_s": 40_000}, 0.2),
        ({"stroke": Stroke.from_arrays(T_S, X_MM, np.where(np.isnan(X_MM), np.nan, 100 / 3))}, None),
        ({"stroke": Stroke.from_arrays(T_S, 2 * X_MM, X_MM, np.where(T_S < 0.2, np.nan, 0.3 + T_S / 3))}, None),
    ],
)
# On the example screen the scene is a draft.
@pytest.mark.filterwarnings("ignore::frixel.FrixelWarning")
def test_the_command_plays_a_recording_again(
    tmp_path: Path, scenes: Path, arguments: dict[str, Any], seconds: float | None
) -> None:
    recording = Simulator(Scene.load(scenes / "brick.toml"), **arguments).run(seconds)
    recording.to_parquet(tmp_path / "me.parquet")
    assert replayed(tmp_path) == (0, f"me.parquet: the same bits, {recording.rows} rows of 12 columns")
    felt_n = recording["felt_n"].copy()
    row = int(np.flatnonzero(np.isfinite(felt_n))[7])
    felt_n[row] = np.nextafter(felt_n[row], 1)
    changed = dataclasses.replace(recording, columns={**recording.columns, "felt_n": felt_n})
    changed.to_parquet(tmp_path / "me.parquet")
    code, said = replayed(tmp_path)
    assert (code, f"does not play the same bits: row {row + 1}, column felt_n: " in said) == (1, True), said


def replayed(folder: Path) -> tuple[int, str]:
    """The exit code of `frixel replay`, and what it says last."""
    command = [os.environ["FRIXEL"], "replay", "me.parquet"]
    ended = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return ended.returncode, (ended.stdout or ended.stderr).splitlines()[-1]


def test_the_command_says_why_it_does_not_play_a_recording_again(tmp_path: Path) -> None:
    recording = Simulator(FLAT).run(0.1)
    made = json.loads(recording.made)
    made["metadata"]["frixel"] = "0.0.9"
    dataclasses.replace(recording, made=json.dumps(made)).to_parquet(tmp_path / "me.parquet")
    code, said = replayed(tmp_path)
    assert (code, "frixel 0.0.9 recorded it, and this is " in said) == (1, True), said
    # Beyond 4 MiB, a recording has the hash of a file.
    t_s = np.linspace(0, 1, 200_000)
    Simulator(FLAT, stroke=Stroke.from_arrays(t_s, 10 + t_s, 20 + t_s)).run(0.1).to_parquet(tmp_path / "me.parquet")
    code, said = replayed(tmp_path)
    assert (code, "only the hash of the large file stroke" in said) == (1, True), said


@pytest.mark.skipif(os.name != "posix", reason="signals are sent as on Unix")
def test_an_interrupt_ends_a_long_run() -> None:
    program = (
        "import frixel\nprint('begun', flush=True)\n"
        "scene = {'layer': [{'kind': 'constant', 'friction_fraction': 0.5}]}\n"
        "try:\n    frixel.run({'scene': scene, 'seconds': 80000})\n"
        "except KeyboardInterrupt:\n    print('interrupted')\n"
    )
    child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stdout.readline() == "begun\n"
    time.sleep(0.5)
    child.send_signal(signal.SIGINT)
    assert child.communicate()[0] == "interrupted\n"


def test_a_recording_is_read_as_it_was_written(tmp_path: Path, scenes: Path) -> None:
    scene = Scene.load(scenes / "brick.toml").with_finger(Finger.bundled("dry"))
    stroke = Stroke.from_arrays([0, 1], [10, 60], [30, 30])
    played = Simulator(scene, stroke=stroke, seed=3, person=2, touch=500).run(0.2)
    played.to_parquet(tmp_path / "one.parquet", participant="p1")
    read = Recording.load(tmp_path / "one.parquet")
    assert read == played
    assert read != Simulator(scene, stroke=stroke, seed=4, person=2, touch=500).run(0.2)
    assert read != 3
    assert {name: read.settings[name] for name in ("seed", "person", "touch", "rows_per_s", "seconds")} == {
        "seed": 3,
        "person": 2,
        "touch": "500",
        "rows_per_s": 1000,
        "seconds": 0.2,
    }
    read.to_parquet(tmp_path / "two.parquet")
    assert (tmp_path / "two.parquet").read_bytes() == (tmp_path / "one.parquet").read_bytes()
    assert frixel.replay(tmp_path / "two.parquet") == 200


def test_a_recording_of_a_board_is_read_as_it_was_written(tmp_path: Path) -> None:
    with frixel.Device.open("sim") as device:
        recorded = device.record(FLAT, 0.1)
    recorded.to_parquet(tmp_path / "board.parquet")
    read = Recording.load(tmp_path / "board.parquet")
    assert read == recorded
    assert read.settings["board"] == recorded.settings["board"]


def test_what_is_no_recording_of_a_play_is_told(tmp_path: Path) -> None:
    for name, content in {"empty": b"", "text": b"time,x"}.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(frixel.PlayError, match=name):
            Recording.load(tmp_path / name)


def test_columns_are_read_only_and_complete() -> None:
    recording = Simulator(FLAT).run(0.01)
    for values in recording.values():
        with pytest.raises(ValueError, match="read-only"):
            values[0] = values[1]
    with pytest.raises(KeyError, match="no column 'felt': did you mean 'felt_n'"):
        recording["felt"]
    assert "felt" not in recording
    assert recording._ipython_key_completions_() == list(frixel.COLUMNS)


def test_a_draft_is_told() -> None:
    draft = Scene.parse('version = 1\n[[layer]]\nkind = "constant"\nfriction_n = 9')
    with pytest.warns(frixel.FrixelWarning, match="played as a draft, clamped: .*9"):
        Simulator(draft).run(0.01)
