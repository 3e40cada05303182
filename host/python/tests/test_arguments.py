"""Whatever a public function is given, it raises a `FrixelError` that names the argument, or takes it."""

from __future__ import annotations

import inspect
import io
import itertools
import os
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import frixel
import numpy as np
import pytest
from frixel import Device, Finger, FrixelError, Recording, Scene, Score, Screen, Simulator, Stroke, TouchSource
from frixel import experiment as asked
from frixel.model import Contact, SoftContact

PLATE = {"layer": [{"kind": "constant", "name": "plate", "friction_fraction": 0.5, "live": True}]}
STROKE = Stroke.straight((10, 40), (60, 40))
LEVELS = [0.1, 0.2]
CONTACT = Contact(radius_m=8e-3, stiffness_pa_per_m=1.8e7, friction_coefficient=0.5, gap_m=10e-6)
WRONG: list[Any] = [
    None,
    "x",
    "",
    "\0",
    "\ud800",
    b"x",
    object(),
    float("nan"),
    -1,
    -1e300,
    10**30,
    10**5000,
    True,
    [],
    {},
    [[1]],
    {1: 2},
]
# Classes that only hold what the module has made, exceptions, and what has no arguments.
HOLDERS = {"Fit", "Mistake", "Score", "States", "Telemetry", "Trial", "Estimate", "Method"}

VALUES: dict[str, Any] = {
    "answer": lambda trial: 0,
    "answers": asked.Answers([(0.1, True)]),
    "cell": {"scene": PLATE, "seconds": 0.01},
    "columns": {"t_s": np.array([0.0])},
    "contact": CONTACT,
    "correct": True,
    "date": None,
    "fields": {"friction_coefficient": 0.5, "normal_load_n": 0.5, "radius_mm": 8, "stiffness_pa_per_m": 1.8e7},
    "first_n": 0.2,
    "friction_coefficient": 0.5,
    "friction_n": 0.3,
    "from_mm": (10, 40),
    "gap_m": 1e-5,
    "gain": 0.5,
    "grid": asked.Grid.around(LEVELS),
    "guess_rates": (0.5,),
    "interval_v_rms": (19.0, 26.0),
    "jobs": 1,
    "key": "t_s",
    "lapses": [0.0],
    "layer": "plate",
    "level": 0.1,
    "levels": LEVELS,
    "made": "{}",
    "message": "no",
    "modulus_pa": 2e5,
    "name": "example",
    "noise": 0.1,
    "number": 0,
    "participant": "p1",
    "plan": {"scenes": {"plate": Scene.from_dict(PLATE)}, "people": 1},
    "play": lambda trial: None,
    "people": 1,
    "port": "sim",
    "profile": "example",
    "radius_m": 8e-3,
    "ratings": [1.0, 2.0],
    "repetitions": 1,
    "results": [],
    "sample_hz": 100,
    "samples": [0.0, 1.0],
    "scene": PLATE,
    "second_n": 0.3,
    "seconds": 0.01,
    "seed": 1,
    "seeds": 1,
    "settings": {},
    "shape_constant": 1.0,
    "slopes": [1.0],
    "start": 0.5,
    "stiffness_pa_per_m": 1.8e7,
    "stress_exponent": 0.5,
    "strokes": 1,
    "t_s": [0.0, 1.0],
    "tables": PLATE,
    "task": asked.TWO_ALTERNATIVES,
    "text": "",
    "threshold_v_rms": 22.0,
    "thresholds": [0.1, 0.2],
    "to_mm": (60, 40),
    "trials": 3,
    "voltage_v_rms": 100.0,
    "x_mm": [10.0, 60.0],
    "y_mm": [40.0, 40.0],
}
OWN: dict[tuple[str, str], Any] = {
    ("Device", "device"): None,
    ("Answers", "trials"): [(0.1, True)],
    ("Scene", "text"): b"version = 1\n",
    ("Scene.parse", "text"): "version = 1\n",
    ("Finger", "text"): None,
    ("Screen", "text"): None,
    ("TouchSource", "text"): None,
    ("TouchSource", "name"): "100",
    ("TouchSource.bundled", "name"): "100",
    ("TouchSource.of", "profile"): "100",
    ("Finger.with", "finger"): "dry",
    ("magnitude_exponent", "levels"): [0.1, 0.2, 0.4],
    ("magnitude_exponent", "ratings"): [1.0, 2.0, 3.0],
    ("Scene.with_finger", "finger"): "dry",
    ("Scene.with_screen", "screen"): "example",
    ("play", "cell"): "{}",
    ("Recording", "scene"): Scene.from_dict(PLATE),
    ("fit", "data"): {"voltage_v_rms": [0, 1], "normal_force_n": [1, 1], "friction_n": [1, 1]},
}


def public() -> Iterator[tuple[str, Any]]:
    """Every public class and function by its name."""
    for module in (frixel, frixel.model, frixel.sweep, frixel.experiment):
        for name in module.__all__:
            found = getattr(module, name)
            is_exception = isinstance(found, type) and issubclass(found, Exception)
            if callable(found) and not is_exception and name not in HOLDERS and not isinstance(found, asked.Task):
                yield name, found


def callables(instances: dict[type, Any]) -> Iterator[tuple[str, Callable[..., object]]]:
    """Functions, constructors and methods, bound."""
    for name, found in public():
        if not (isinstance(found, type) and found is Stroke):
            yield name, found
        if isinstance(found, type):
            for method, _ in inspect.getmembers(found, callable):
                if not method.startswith("_") and method not in ("keys", "items", "values"):
                    yield f"{name}.{method}", getattr(instances.get(found, found), method)


def arguments(name: str, act: Callable[..., object], tmp_path: Path) -> dict[str, Any]:
    """The valid arguments of a function that it cannot do without, and all others with the values of their names."""
    files = {"path": tmp_path / "new", "folder": tmp_path / "folder", "file": io.StringIO(), "method": None}
    given: dict[str, Any] = {}
    for parameter in inspect.signature(act).parameters.values():
        if parameter.kind in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL):
            continue
        key = (name, parameter.name)
        value = OWN.get(key, files.get(parameter.name, VALUES.get(parameter.name, parameter.default)))
        assert value is not parameter.empty, f"give {key} a value in OWN or VALUES"
        given[parameter.name] = value
    if "method" in given:
        given["method"] = asked.ConstantStimuli(LEVELS, 1) if name == "Session.run" else "load cell"
    return given


@pytest.fixture
def instances(tmp_path: Path) -> Iterator[dict[type, Any]]:
    """An instance of each class whose methods are called."""
    with (
        Device.open("sim") as device,
        asked.Session(tmp_path / "session", "p1", asked.TWO_ALTERNATIVES, seed=1) as session,
    ):
        device.play(PLATE)
        yield {
            Device: device,
            Scene: Scene.from_dict(PLATE),
            Simulator: Simulator(PLATE, stroke=STROKE),
            Recording: Simulator(PLATE, stroke=STROKE).run(0.01),
            asked.Session: session,
            asked.Answers: asked.Answers([(0.1, True)]),
            asked.ConstantStimuli: asked.ConstantStimuli(LEVELS, 2),
            asked.UpDown: asked.UpDown(0.5, trials=9),
            asked.QuestPlus: asked.QuestPlus(LEVELS, asked.TWO_ALTERNATIVES, trials=9),
            asked.Observer: asked.Observer(0.1),
            asked.Grid: asked.Grid([0.1, 0.2]),  # type: ignore[arg-type]
        }


# Methods that need what another test makes, or whose arguments others check: sweep.Study, closing.
SKIPPED = {"Device.close", "Device.stop", "Session.close", "Study", "Study.write"}


def test_every_public_function_refuses_wrong_values_by_a_frixel_error(
    instances: dict[type, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    escaped: list[str] = []
    count = 0
    for name, act in callables(instances):
        if name in SKIPPED:
            continue
        for parameter in arguments(name, act, tmp_path):
            for wrong in WRONG:
                given = {**arguments(name, act, tmp_path), parameter: wrong}
                try:
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore")
                        found = act(**given)
                        if name == "Device.telemetry":
                            list(itertools.islice(found, 2))  # type: ignore[call-overload]
                        if isinstance(found, (Device, asked.Session)):
                            found.close()
                except FrixelError:
                    count += 1
                except Exception as error:
                    escaped.append(f"{name}({parameter}={type(wrong).__name__}): {error!r}")
    assert not escaped, "\n".join(escaped)
    assert count > 1000, "so many are refused"


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: Scene.parse(None), "text must be a string, but is None"),  # type: ignore[arg-type]
        (
            lambda: Contact(radius_m="8mm", stiffness_pa_per_m=1e7, friction_coefficient=0.5, gap_m=1e-5),  # type: ignore[arg-type]
            "radius_m must be a number, but is '8mm'",
        ),
        (lambda: asked.UpDown(0, trials=5), "start must be a number from 1e-100 to 1e+100, but is 0"),
        (lambda: Simulator(PLATE, ideal="no"), "ideal must be True or False, but is 'no'"),  # type: ignore[arg-type]
        (lambda: Device.open("sim", arm="no"), "arm must be True or False, but is 'no'"),  # type: ignore[arg-type]
        (lambda: frixel.model.eval("finger", 1.0), "contact must be a Contact or a SoftContact, but is 'finger'"),  # type: ignore[arg-type]
        (
            lambda: frixel.model.eval(CONTACT, ["1", "2"]),
            "voltage_v_rms must be numbers in an array or a list, but is ['1', '2']",
        ),
        (
            lambda: frixel.model.eval(CONTACT, np.ma.array([50.0, 60.0], mask=[False, True])),
            "voltage_v_rms has masked elements: leave them out",
        ),
        (lambda: frixel.model.eval(CONTACT, 50, [[0.5], [np.inf]]), "normal_load_n[1, 0] must be finite, but is inf"),
        (lambda: frixel.model.invert(CONTACT, np.nan), "friction_n must be finite, but is nan"),
        (
            lambda: frixel.model.eval(CONTACT, [1, 2], [1, 2, 3]),
            "voltage_v_rms has the shape (2,) and normal_load_n has the shape (3,), which do not broadcast: give one "
            "load, or as many as there are",
        ),
        (
            lambda: frixel.run({"scene": PLATE, "sed": 1}),
            "a cell has no 'sed': its keys are Simulator's arguments and `seconds`",
        ),
        (lambda: frixel.run({"seconds": 0.1}), "a cell lacks `scene`: give a Scene or its tables"),
        (lambda: Scene.load("x" * 100 + "\0"), "path must be a path, but is '" + "x" * 62 + "…"),
    ],
)
def test_a_refusal_names_the_argument(call: Callable[[], object], sentence: str) -> None:
    with pytest.raises(FrixelError) as caught:
        call()
    assert str(caught.value) == sentence


def test_a_touch_source_is_named_by_its_number_or_its_text() -> None:
    assert TouchSource.of(500) == TouchSource.of("500")
    assert Simulator(PLATE, touch=500).touch == TouchSource.bundled("500")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_a_forked_child_gets_an_error_and_the_parent_plays_on() -> None:
    program = """
import os, warnings
warnings.simplefilter("ignore")
from frixel import Device, PlayError
with Device.open("sim") as device:
    child = os.fork()
    if child == 0:
        try:
            device.wait(0.1)
        except PlayError as error:
            os._exit(0 if "fork" in str(error) else 2)
        os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    device.wait(0.1)
"""
    subprocess.run([sys.executable, "-c", program], check=True, timeout=60)


def test_units_stand_in_the_documents_of_contact_finger_and_fit() -> None:
    for thing, units in (
        (Contact, ["m", "Pa/m"]),
        (SoftContact, ["Pa"]),
        (Finger, ["mm", "um", "Pa/m", "N"]),
        (frixel.Fit, ["V rms"]),
    ):
        text = inspect.getdoc(thing) or ""
        assert all(unit in text for unit in units), thing
    assert Score.__doc__
    assert Screen.__doc__
