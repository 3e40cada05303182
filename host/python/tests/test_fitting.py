"""Fits of fingers."""

from __future__ import annotations

import csv
import datetime
import json
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from frixel import FitError, ParameterError, Scene, fit, model

DAY = datetime.date(2026, 11, 23)


def measured() -> dict[str, np.ndarray]:
    """Strokes of a made-up finger, with the drive on in every second half, and a sensor's noise."""
    noise = np.random.default_rng(7)
    finger = model.Contact(radius_m=8e-3, stiffness_pa_per_m=1.8e7, friction_coefficient=0.5, gap_m=10e-6)
    stroke = np.repeat(np.arange(24), 200)
    voltage = np.where(np.arange(4800) % 200 < 100, 0.0, np.array([75.0, 100.0, 150.0])[stroke % 3])
    load = np.array([0.46, 0.49, 0.51, 0.54])[stroke % 4]
    friction = model.eval(finger, voltage, load).friction_n * (1 + 0.01 * noise.standard_normal(4800))
    return {"voltage_v_rms": voltage, "normal_force_n": load, "friction_n": friction, "stroke": stroke}


def test_a_fit_is_that_of_the_command(tmp_path: Path) -> None:
    data = measured()
    fitted = fit(data, date=DAY)
    assert fitted.summary["friction_coefficient"] == pytest.approx(0.5, rel=0.01)
    with (tmp_path / "data.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(data)
        writer.writerows(zip(*(column.tolist() for column in data.values()), strict=True))
    command = [os.environ["FRIXEL"], "finger", "fit", str(tmp_path / "data.csv"), "--json"]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    assert json.loads(printed) == fitted.summary
    assert "2026-11-23" in (fitted.finger.text or "")
    scene = Scene.from_dict({"layer": [{"kind": "constant", "friction_fraction": 0.5}]})
    natural, _ = scene.with_finger(fitted.finger).reach_n
    assert natural == pytest.approx(0.5 * fitted.summary["normal_load_n"], rel=0.01)
    assert str(fitted) == fitted.words


def test_a_finger_with_a_law_of_its_own_is_fitted() -> None:
    fitted = fit(measured(), law="empirical", date=DAY)
    assert "empirical" in (fitted.finger.text or "")


def test_data_that_give_no_finger_are_refused() -> None:
    data = measured()
    with pytest.raises(FitError):
        fit({**data, "voltage_v_rms": np.zeros(4800)})
    with pytest.raises(FitError, match="the header has no column friction_n: name the column so, in newtons"):
        fit({name: data[name] for name in ("voltage_v_rms", "normal_force_n")})
    with pytest.raises(FitError, match=r"no column normal_force_n \(it has normal_n\): name the column so, in newtons"):
        fit({"voltage_v_rms": data["voltage_v_rms"], "friction_n": data["friction_n"], "normal_n": data["friction_n"]})
    with pytest.raises(FitError, match="or use `voltage_v_rms` 75"):
        fit({**data, "voltage_v_rms": data["voltage_v_rms"] / 2})
    with pytest.raises(FitError, match="or leave out `normal_load_n`"):
        fit(data, normal_load_n=50)
    with pytest.raises(FitError, match="`without` nowhere: there is no such stroke"):
        fit(data, without=["nowhere"])
    with pytest.raises(FitError, match="the data have no columns"):
        fit({})
    with pytest.raises(ParameterError, match="columns must have the same length, found"):
        fit({**data, "friction_n": data["friction_n"][1:]})
    with pytest.raises(ParameterError, match="must be 'contact' or 'empirical', but is 'power'"):
        fit(data, law="power")  # type: ignore[arg-type]


@pytest.mark.parametrize("column", ["voltage_v_rms", "normal_force_n", "friction_n"])
@pytest.mark.parametrize("row", [0, 77, 4799])
def test_a_number_that_is_missing_is_named_by_row_and_column(column: str, row: int, tmp_path: Path) -> None:
    data = {name: values.astype(float) for name, values in measured().items()}
    data[column][row] = np.nan
    said = f'row {row + 2}, column {column}: expected a number, found "nan": correct the cell or delete the row'
    with pytest.raises(FitError, match=f"^{re.escape(said)}$"):
        fit(data)
    pandas = pytest.importorskip("pandas")
    with pytest.raises(FitError, match=f"^{re.escape(said)}$"):
        fit(pandas.DataFrame(data))
    pandas.DataFrame(data).to_csv(tmp_path / "data.csv", index=False, na_rep="nan")
    command = [os.environ["FRIXEL"], "finger", "fit", str(tmp_path / "data.csv")]
    refused = subprocess.run(command, capture_output=True, text=True)
    assert said in refused.stderr


def test_columns_are_read_as_those_of_a_file() -> None:
    data = measured()
    fitted = fit(data, date=DAY)
    unknown = fit({**data, "speed_mm_s": np.full(4800, np.nan)}, date=DAY)
    assert unknown.summary == fitted.summary
    others = {name: values for name, values in data.items() if name not in ("friction_n", "stroke")}
    names = np.array(["#1,", 'a"b', "2;\n3"])[data["stroke"] % 3] + data["stroke"].astype(str)
    scaled = fit({"stroke": names, "Friction [mN]": 1e3 * data["friction_n"], **others}, date=DAY)
    assert scaled.summary["electric_friction_n"] == pytest.approx(fitted.summary["electric_friction_n"], rel=1e-9)
    assert "read `Friction [mN]` in millinewtons" in scaled.words
    with pytest.raises(FitError, match="row 3, column voltage_v_rms: -75 V is below zero"):
        fit({**data, "voltage_v_rms": np.where(np.arange(4800) == 1, -75.0, data["voltage_v_rms"])})
