"""A board that plays, at a serial port or simulated."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _frixel
from ._arguments import array, check_callable, flag, number, refusal, shown, whole
from ._arguments import text as checked_text
from .errors import FrixelError, ParameterError, PlayError
from .recording import COLUMNS, Recording
from .scene import Scene

__all__ = ["Device", "Telemetry"]

WAIT_MAX_S = 1e9
"""Longest wait, s."""

SIMULATED = "sim"
"""The port of the simulated board, which plays a scene that a board refuses as a draft."""

STEP_S = 0.05
"""Longest time between two checks for an interrupt, s."""


@dataclass(frozen=True)
class Telemetry:
    """A board's report on one tick."""

    t_s: float
    """Time since power-on, s; wraps after 2^32 ticks."""
    state: str
    """`disarmed`, `armed`, `active` or `faulted`."""
    flags: tuple[str, ...]
    """Limits of the output and state of the finger, one word each (`docs/design/outputs.md`)."""
    x_mm: float
    """Estimated place of the finger, from the left edge of the screen."""
    y_mm: float
    """Estimated place of the finger, from the top edge of the screen."""
    speed_mm_s: float
    """Estimated sliding speed."""
    commanded_electric_friction_n: float
    """Electric friction that the board commands, N: what the drive adds to the friction without voltage."""
    voltage_v_rms: float
    """Rms voltage of the envelope, V."""


class Device:
    """A connected board. Use it in a `with` block, which always disarms and releases the board.

    **A board plays only while the program calls.** The library pings the board for one second after each call. Then the
    board sets its output to zero, and the next call raises `PlayError`. An idle notebook, a program that hangs or a
    breakpoint therefore loses the board. A program with nothing else to do calls `wait`.

    The time of `"sim"`, the simulated board, passes only in `wait` and `telemetry`, and faster than real time. Its
    plays are reproducible.
    """

    def __init__(self, device: _frixel.Device, port: str) -> None:
        if not isinstance(device, _frixel.Device):
            raise refusal("device", "opened by Device.open", device)
        self._opened, self._port, self._process = device, port, os.getpid()
        self._now_s, self._streaming, self._state = 0.0, False, "disarmed"
        self._take(device.look())

    @classmethod
    def open(cls, port: str, *, arm: bool = False) -> Device:
        """Connect to a board. It plays nothing yet.

        Parameters
        ----------
        port
            The path of a serial port (`frixel board ports` lists them), or `"sim"` for a simulated board, under a
            realistic finger that slides over the screen again and again.
        arm
            Let a board that is not simulated drive its electrode, with hundreds of volts. A person then presses and
            holds its arm switch before `play`.

        Raises
        ------
        PlayError
            The port does not exist, no board answers there, or the board has an electrode and `arm` is not given.
        """
        if not isinstance(port, str):
            raise refusal("a port", 'a path or "sim"', port)
        return cls(_frixel.Device(checked_text("port", port), flag("arm", arm)), port)

    @property
    def _device(self) -> _frixel.Device:
        """The open device, whose thread a forked child does not have."""
        if os.getpid() != self._process:
            raise PlayError(
                f"the board at {self._port} belongs to the process that opened it, and this is a fork of it: open it "
                'here, or start processes with multiprocessing.get_context("spawn")'
            )
        return self._opened

    def __enter__(self) -> Device:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        try:
            self.close()
        except FrixelError:
            # The error that ends the block says more than the error of closing.
            if kind is None:
                raise

    def close(self) -> None:
        """Disarm the board and release its port. Does nothing on a closed device.

        Raises
        ------
        PlayError
            The board did not confirm. Its output goes to zero by itself.
        """
        self._state = "unknown" if self._state in ("armed", "active") else self._state
        answer = self._device.close()
        if answer is not None:
            self._take(answer)

    def play(self, scene: Scene | Mapping[str, Any]) -> None:
        """Upload a scene and play it from its beginning, in place of any other.

        A real board needs its arm switch: released and pressed since it was last disarmed, and held while it plays.

        Raises
        ------
        SceneError
            The scene has mistakes, or this board cannot play it.
        PlayError
            The board refuses, for example because its arm switch is not held, or is gone.

        Warns
        -----
        FrixelWarning
            The simulated board plays a draft of the scene, clamped.
        """
        scene = Scene.of(scene)
        if self._port == SIMULATED:
            scene._warn_of_draft()
        self._take(self._device.play(scene.compiled))

    def replace(self, scene: Scene | Mapping[str, Any]) -> list[str]:
        """Play another scene from the next tick on, without a break.

        Layers of the same name keep what `set_layer` and `trigger` have set. If the board refuses the scene, the
        previous one keeps playing.

        Returns
        -------
        list of str
            Notes on the change, one sentence each; mostly none.

        Raises
        ------
        SceneError
            The scene has mistakes, or this board cannot play it.
        PlayError
            The board refuses, has stopped, or is gone.

        Warns
        -----
        FrixelWarning
            As `play`.
        """
        scene = Scene.of(scene)
        if self._port == SIMULATED:
            scene._warn_of_draft()
        return self._take(self._device.replace(scene.compiled))

    def set_layer(self, layer: str | int, *, on: bool | None = None, gain: float | None = None) -> list[str]:
        """Switch a layer on or off, or set the gain on its friction. An argument that is not given changes nothing.

        Parameters
        ----------
        layer
            Its name in the scene, or its number as in messages, from 1.
        on
            Whether it is on from now on.
        gain
            Gain in place of the scene's, from -100 to 100.

        Returns
        -------
        list of str
            A note on what is clamped from now on; mostly none.

        Raises
        ------
        ParameterError
            There is no such layer, or the gain leads out of reach. Nothing is changed.
        PlayError
            No scene plays, or the board has stopped, or is gone.
        """
        if on is None and gain is None:
            raise ParameterError("`on` or `gain` changes a layer: give one or both")
        if gain is not None:
            gain = number("gain", gain, -_frixel.GAIN_MAX, _frixel.GAIN_MAX)
        return self._take(self._device.set_layer(_layer(layer), None if on is None else flag("on", on), gain))

    def trigger(self, layer: str | int, seconds: float | None = None) -> list[str]:
        """Play a layer that is off for some time. A later call of `wait` or `telemetry` switches it off again.

        Parameters
        ----------
        layer
            Its name in the scene, or its number as in messages, from 1.
        seconds
            Duration, s. Default: that of its pattern or its first burst, or else 0.1 s.

        Returns
        -------
        list of str
            A note on what is clamped meanwhile; mostly none.

        Raises
        ------
        ParameterError
            There is no such layer, or a trigger of it would play nothing.
        PlayError
            No scene plays, or the board has stopped, or is gone.
        """
        if seconds is not None:
            seconds = number("seconds", seconds, 1e-6, _frixel.TRIGGER_MAX_S)
        return self._take(self._device.trigger(_layer(layer), seconds))

    def stream(self, samples: ArrayLike, sample_hz: int) -> None:
        """Begin to stream to the stream layers of the scene. The samples are sent in `wait` and `telemetry`.

        Parameters
        ----------
        samples
            Shape (n,): 0 is a layer's low friction, 1 its high one.
        sample_hz
            Samples a second, at most the board's ticks a second.

        Raises
        ------
        ParameterError
            A sample is not from 0 to 1, or the rate is out of range.
        PlayError
            No layer of the scene plays a stream, or the board has stopped, or is gone.
        """
        taken = np.ascontiguousarray(array("samples", samples))
        if taken.ndim != 1 or taken.size == 0:
            raise ParameterError(f"samples are an array of shape (n,) with at least one, found shape {taken.shape}")
        wrong = np.flatnonzero(~((taken >= 0) & (taken <= 1)))
        if wrong.size:
            raise ParameterError(f"a sample is a number from 0 to 1, found {taken[wrong[0]]} at index {wrong[0]}")
        rate = whole("sample_hz", sample_hz, 1, self._device.ticks_per_s)
        self._take(self._device.stream(taken, rate))

    def wait(self, seconds: float | None = None) -> None:
        """Let time pass on the board.

        Parameters
        ----------
        seconds
            Duration, at most 1e9 s. Default: until the stream has been played.

        Raises
        ------
        PlayError
            The board stopped by itself, or is gone.
        KeyboardInterrupt
            Ctrl-C. The board is disarmed.
        """
        until_s = math.inf if seconds is None else self._now_s + number("seconds", seconds, 0.0, WAIT_MAX_S)
        with self._disarming():
            while self._now_s < until_s and (seconds is not None or self._streaming):
                self._take(self._device.listen(self._step_s(until_s)))

    def telemetry(self, seconds: float | None = None, *, messages_per_s: int = 100) -> Iterator[Telemetry]:
        """Iterate over the board's telemetry while time passes on the board. The iterator may be left at any time.

        Parameters
        ----------
        seconds
            Duration, at most 1e9 s. Default: no end.
        messages_per_s
            Messages a second, at most 1000.

        Raises
        ------
        PlayError
            The board stopped by itself, or is gone.
        KeyboardInterrupt
            Ctrl-C. The board is disarmed.
        """
        lasts_s = math.inf if seconds is None else number("seconds", seconds, 0.0, WAIT_MAX_S)
        return self._messages(lasts_s, whole("messages_per_s", messages_per_s, 1, _frixel.TELEMETRY_MAX_HZ))

    def _messages(self, lasts_s: float, messages_per_s: int) -> Iterator[Telemetry]:
        # This also discards the messages received before.
        self._take(self._device.subscribe(messages_per_s))
        until_s = self._now_s + lasts_s
        try:
            while self._now_s < until_s:
                with self._disarming():
                    answer = self._device.listen(self._step_s(until_s))
                self._take(answer)
                for tick, state, flags, x_m, y_m, speed_m_s, commanded_electric_n, voltage_v_rms in answer[4]:
                    t_s = tick / self._device.ticks_per_s
                    place = 1e3 * x_m, 1e3 * y_m, 1e3 * speed_m_s
                    yield Telemetry(t_s, state, tuple(flags), *place, commanded_electric_n, voltage_v_rms)
        finally:
            if not self._device.is_closed:
                self._take(self._device.subscribe(0))

    def record(
        self,
        scene: Scene | Mapping[str, Any],
        seconds: float,
        *,
        messages_per_s: int = 100,
        on_active: Callable[[], object] | None = None,
    ) -> Recording:
        """Play a scene from its beginning, record the board's telemetry, and stop.

        Parameters
        ----------
        scene
            The scene to play.
        seconds
            Duration, s.
        messages_per_s
            Rows a second, at most 1000.
        on_active
            Called once, as soon as the board reports that it plays.

        Returns
        -------
        Recording
            The board's reports: place, speed, commanded friction, voltage and flags; `t_s` is 0 at the first row.
            Columns that only a simulator knows, such as felt friction, are NaN.

        Raises
        ------
        ParameterError
            A value is not accepted. Nothing is played.
        SceneError, PlayError, KeyboardInterrupt
            As `play` and `telemetry`. The board is disarmed.

        Warns
        -----
        FrixelWarning
            As `play`.
        """
        scene = Scene.of(scene)
        seconds = number("seconds", seconds, 1e-3, _frixel.STROKE_MAX_S)
        if on_active is not None:
            check_callable("on_active", on_active)
        messages_per_s = whole("messages_per_s", messages_per_s, 1, _frixel.TELEMETRY_MAX_HZ)
        messages: list[Telemetry] = []
        try:
            self.play(scene)
            is_reported = False
            for message in self.telemetry(seconds, messages_per_s=messages_per_s):
                if on_active is not None and not is_reported and message.state == "active":
                    on_active()
                    is_reported = True
                messages.append(message)
        except BaseException:
            # If the board is gone, its output goes to zero by itself.
            with suppress(FrixelError):
                self.stop()
            raise
        self.stop()
        columns: dict[str, NDArray[Any]] = {name: np.full(len(messages), np.nan) for name in COLUMNS}
        for name in ("t_s", "x_mm", "y_mm", "speed_mm_s", "voltage_v_rms"):
            columns[name] = np.array([getattr(message, name) for message in messages], dtype=float)
        natural_n, _ = scene.reach_n
        electric_n = [message.commanded_electric_friction_n for message in messages]
        columns["commanded_n"] = natural_n + np.array(electric_n, dtype=float)
        columns["t_s"] = columns["t_s"] - (messages[0].t_s if messages else 0.0)
        columns["flags"] = np.array(["+".join(message.flags) for message in messages], dtype=np.str_)
        settings = {
            "scene": scene.name,
            "seconds": seconds,
            "board": self.board,
            "board_s": messages[0].t_s if messages else self._now_s,
            "rows_per_s": messages_per_s,
        }
        return Recording(columns, settings, scene, self._device.made(messages_per_s))

    def stop(self) -> None:
        """Set the output to zero and disarm the board, which stays connected. `play` arms it again.

        Raises
        ------
        PlayError
            The board did not confirm. Its output goes to zero by itself.
        """
        self._take(self._device.stop())

    @property
    def state(self) -> str:
        """`disarmed`, `armed`, `active` or `faulted`, as last reported; `unknown` if the board was gone at the end."""
        if not self._device.is_closed:
            self._take(self._device.look())
        return self._state

    @property
    def board(self) -> str:
        """Kind of the board."""
        return self._device.board

    @property
    def notes(self) -> list[str]:
        """Notes on the board, one sentence each; mostly none."""
        return self._device.notes

    def __repr__(self) -> str:
        return f"<frixel.Device: {self.board} at {self._port}, {self._state}>"

    def _step_s(self, until_s: float) -> float:
        """Duration of the next step, s. At least two ticks: a remainder that is rounded to zero would never pass."""
        return min(STEP_S, max(until_s - self._now_s, 2 / self._device.ticks_per_s))

    @contextmanager
    def _disarming(self) -> Iterator[None]:
        """Disarms the board on an interrupt."""
        try:
            yield
        except KeyboardInterrupt:
            # If the board is gone, its output goes to zero by itself.
            with suppress(FrixelError):
                self.stop()
            raise

    def _take(self, answer: _frixel.Answer) -> list[str]:
        """Keep the board's report. Returns the sentences."""
        self._state, self._now_s, self._streaming, sentences, _ = answer
        return sentences


def _layer(layer: str | int) -> str:
    if isinstance(layer, bool) or not isinstance(layer, (str, int)):
        raise refusal("a layer", "its name or its number", layer)
    return checked_text("layer", layer) if isinstance(layer, str) else shown(layer)
