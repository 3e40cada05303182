"""Boards that play: the simulated one, and the one of `frixel sim` behind a pseudo-terminal."""

from __future__ import annotations

import csv
import os
import signal
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from frixel import Device, FrixelWarning, ParameterError, PlayError, SceneError, Telemetry

from .conftest import REPOSITORY

SCENE = {
    "layer": [
        {"kind": "constant", "name": "base", "friction_fraction": 0.3, "live": True},
        {"kind": "constant", "name": "click", "friction_fraction": 0.3, "live": True, "start": "off"},
    ]
}
STREAM = {"layer": [{"kind": "stream", "low_fraction": 0.1, "high_fraction": 0.9}]}


def commanded_electric_n(device: Device) -> float:
    """The largest electric friction that is asked for within a tenth of a second."""
    return max(message.commanded_electric_friction_n for message in device.telemetry(0.1))


def states(device: Device, seconds: float = 0.1) -> set[str]:
    """What the board says of its state."""
    return {message.state for message in device.telemetry(seconds)}


def test_a_scene_plays_and_stops() -> None:
    with Device.open("sim") as device:
        assert states(device) == {"disarmed"}
        device.play(SCENE)
        device.wait(1.0)
        messages = list(device.telemetry(0.5, messages_per_s=200))
        assert len(messages) in range(95, 106)
        assert {message.state for message in messages} == {"active"}
        assert max(message.voltage_v_rms for message in messages) > 20
        assert all(isinstance(message, Telemetry) for message in messages)
        assert np.allclose(np.diff([message.t_s for message in messages]), 0.005)
        device.stop()
        assert states(device) == {"disarmed"}
        device.play(SCENE)
        assert states(device) == {"active"}
    assert device.state == "disarmed"


def test_layers_change_while_they_play() -> None:
    with Device.open("sim") as device:
        device.play(SCENE)
        device.wait(1.0)
        base = commanded_electric_n(device)
        assert device.set_layer("base", gain=0.5) == []
        assert commanded_electric_n(device) == pytest.approx(0.5 * base, rel=0.02)
        device.set_layer(1, on=False)
        assert commanded_electric_n(device) == 0
        device.trigger("click", 0.05)
        assert commanded_electric_n(device) == pytest.approx(base, rel=0.02)
        assert commanded_electric_n(device) == 0, "the trigger has ended"
        assert device.replace({"layer": [{"kind": "constant", "friction_fraction": 0.6}]}) == []
        assert commanded_electric_n(device) == pytest.approx(2 * base, rel=0.02)
        device.replace({"layer": [{"kind": "constant", "name": "alone", "friction_fraction": 0.6, "live": True}]})
        with pytest.raises(ParameterError, match="gain 50 is refused"):
            device.set_layer("alone", gain=50)


def test_a_stream_is_played() -> None:
    with Device.open("sim") as device:
        device.play(STREAM)
        device.wait(1.0)
        device.stream(np.full(8000, 1.0), 8000)
        high = commanded_electric_n(device)
        device.wait()
        device.wait(0.1)
        assert commanded_electric_n(device) == 0, "it is over"
        device.stream(np.zeros(8000), 8000)
        assert 0 < commanded_electric_n(device) < 0.5 * high


def broken(how: str) -> Device:
    """A device whose block was left while it played."""
    device = Device.open("sim")
    with device:
        device.play(SCENE)
        device.wait(0.1)
        if how == "exception":
            raise ZeroDivisionError
        if how == "interrupt":
            raise KeyboardInterrupt
        for message in device.telemetry():
            assert message.state == "active"
            if how == "iterator left":
                return device
    return device


def test_an_error_in_the_block_disarms(monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[Device] = []
    real_open = Device.open

    def noted(port: str) -> Device:
        opened.append(real_open(port))
        return opened[-1]

    monkeypatch.setattr(Device, "open", noted)
    with pytest.raises(ZeroDivisionError):
        broken("exception")
    with pytest.raises(KeyboardInterrupt):
        broken("interrupt")
    broken("iterator left")
    assert [device.state for device in opened] == ["disarmed"] * 3


def test_a_generator_that_is_left_disarms() -> None:
    devices = []

    def trials() -> Generator[str, None, None]:
        with Device.open("sim") as device:
            devices.append(device)
            device.play(SCENE)
            while True:
                yield device.state

    running = trials()
    assert next(running) == "active"
    running.close()
    assert devices[0].state == "disarmed"


@pytest.mark.parametrize("call", ["wait", "telemetry"])
def test_ctrl_c_disarms(call: str) -> None:
    device = Device.open("sim")
    device.play(SCENE)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        deque(device.telemetry(), 0) if call == "telemetry" else device.wait(1e9)
    timer.join()
    assert call == "telemetry" or device.state == "disarmed"
    device.close()
    assert device.state == "disarmed"


def test_what_is_not_taken_changes_nothing() -> None:
    with Device.open("sim") as device:
        with pytest.raises(PlayError, match="no scene plays"):
            device.set_layer("base", on=False)
        device.play(SCENE)
        device.wait(1.0)
        before = commanded_electric_n(device)
        with pytest.raises(ParameterError, match='did you mean "base"'):
            device.set_layer("bass", on=False)
        with pytest.raises(ParameterError, match="`on` or `gain` changes a layer"):
            device.set_layer("base")
        for gain in (float("nan"), 1e3, "loud"):
            with pytest.raises(ParameterError, match="gain must be a number from -100 to 100"):
                device.set_layer("base", gain=gain)  # type: ignore[arg-type]
        with pytest.raises(ParameterError, match=r"set_layer\(\"base\", on=False\)"):
            device.trigger("base")
        with pytest.raises(ParameterError, match=r"Scene\.load"):
            device.replace("scene.toml")  # type: ignore[arg-type]
        with pytest.raises(SceneError, match="constnt"):
            device.replace({"layer": [{"kind": "constnt"}]})
        with pytest.raises(PlayError, match="no layer of the playing scene is a stream"):
            device.stream([0.5], 1000)
        for samples in ([], [[0.5]], [2.0], [float("nan")]):
            with pytest.raises(ParameterError, match="sample"):
                device.stream(samples, 1000)
        with pytest.raises(ParameterError, match="sample_hz must be a whole number from 1 to 40000"):
            device.stream([0.5], 50_000)
        with pytest.raises(ParameterError, match="messages_per_s"):
            device.telemetry(messages_per_s=0)
        with pytest.raises(ParameterError, match="seconds must be a number"):
            device.wait(-1)
        assert commanded_electric_n(device) == before


def test_a_port_that_does_not_exist() -> None:
    with pytest.raises(PlayError, match="there is no port /dev/nowhere"):
        Device.open("/dev/nowhere")
    with pytest.raises(ParameterError, match='a path or "sim"'):
        Device.open(3)  # type: ignore[arg-type]


def test_a_draft_is_told() -> None:
    draft = {"layer": [{"kind": "constant", "friction_n": 3}]}
    with Device.open("sim") as device:
        for play in (device.play, device.replace, lambda scene: device.record(scene, 0.1)):
            with pytest.warns(FrixelWarning, match="played as a draft, clamped: .*3"):
                play(draft)


def test_a_closed_device_says_so() -> None:
    with Device.open("sim") as device:
        device.play(SCENE)
    device.close()
    calls: list[Callable[[], None]] = [lambda: device.wait(1), lambda: device.play(SCENE)]
    for call in calls:
        with pytest.raises(PlayError, match="this device is closed"):
            call()
    assert "disarmed" in repr(device)


class VirtualBoard:
    """`frixel sim`, with the file of what happened to its board."""

    def __init__(self, folder: Path) -> None:
        command = [os.environ["FRIXEL"], "sim", "--out", str(folder)]
        self.folder = folder
        self.server = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert self.server.stdout is not None
        self.port = self.server.stdout.readline().removeprefix("port: ").strip()

    def events(self) -> list[str]:
        """Ends the server, and returns the events of the board."""
        self.server.send_signal(signal.SIGINT)
        self.server.wait()
        with (self.folder / "events.csv").open(newline="") as file:
            return [",".join(row.values()) for row in csv.DictReader(file)]


@pytest.fixture
def virtual_board(tmp_path: Path) -> Iterator[VirtualBoard]:
    board = VirtualBoard(tmp_path / "sim")
    yield board
    board.server.kill()
    board.server.wait()
    if board.server.stdout is not None:
        board.server.stdout.close()


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"seconds": -1}, "seconds must be a number from 0.001 to 86400, but is -1"),
        ({"seconds": 1, "messages_per_s": 0}, "messages_per_s must be a whole number from 1 to 1000, but is 0"),
    ],
)
def test_a_record_with_a_wrong_value_plays_nothing(settings: dict[str, Any], sentence: str) -> None:
    with Device.open("sim") as device:
        with pytest.raises(ParameterError, match=sentence):
            device.record(SCENE, **settings)
        assert device.state == "disarmed"


def test_a_record_that_is_left_in_the_middle_disarms() -> None:
    with Device.open("sim") as device:
        with pytest.raises(ZeroDivisionError):
            device.record(SCENE, 1, on_active=lambda: 1 // 0)
        assert device.state == "disarmed"


def test_a_record_says_once_when_the_board_plays() -> None:
    with Device.open("sim") as device:
        states: list[str] = []
        device.record(SCENE, 0.2, on_active=lambda: states.append(device._state))
        assert states == ["active"]


def test_a_board_at_a_port_plays_and_is_disarmed(virtual_board: VirtualBoard) -> None:
    with Device.open(virtual_board.port) as device:
        device.play(SCENE)
        assert "active" in states(device, 0.3)
    assert device.state == "disarmed"
    with Device.open(virtual_board.port) as device:
        assert device.state == "disarmed"


def test_the_client_of_the_protocol_plays(virtual_board: VirtualBoard, tmp_path: Path) -> None:
    page = (REPOSITORY / "firmware/wire/PROTOCOL.md").read_text(encoding="utf-8")
    client = tmp_path / "client.py"
    client.write_text(page.split("```python\n")[1].split("```")[0], encoding="utf-8")
    command = [sys.executable, str(client), virtual_board.port]
    played = subprocess.run(command, capture_output=True, text=True, check=False)
    assert played.returncode == 0, played.stderr
    assert played.stdout.splitlines()[1:] == ["Armed Active", "Armed", "Disarmed"]


def test_an_idle_program_loses_its_board(virtual_board: VirtualBoard) -> None:
    with Device.open(virtual_board.port) as device:
        device.play(SCENE)
        time.sleep(2.5)  # The pings end after 1 s, and the scene's host timeout is a quarter of a second.
        with pytest.raises(PlayError, match="it had not heard from this host"):
            device.wait(0.1)
        assert device.state == "disarmed"
        device.play(SCENE)
        assert "active" in states(device)


def test_a_program_that_is_killed_loses_its_board(virtual_board: VirtualBoard) -> None:
    program = (
        f"import frixel, os, signal\ndevice = frixel.Device.open({virtual_board.port!r})\n"
        f"device.play({SCENE!r})\ndevice.wait(0.2)\nos.kill(os.getpid(), signal.SIGKILL)\n"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == -signal.SIGKILL
    time.sleep(1.0)
    with Device.open(virtual_board.port) as device:
        assert device.state == "disarmed"
    assert any("host" in event for event in virtual_board.events())
