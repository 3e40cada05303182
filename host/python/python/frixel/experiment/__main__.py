"""Find a person's detection threshold without a force sensor: python -m frixel.experiment FOLDER --port PATH.

In each trial a finger makes two strokes, one of which is rough, and the person types which. The folder keeps every
answer: the same command resumes a session that was cut off. At the end, finger.toml in the folder is the finger's
profile, with the threshold in volts. The threshold in newtons stays unknown: write scenes in fractions of what can be
reached.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import logging
import math
import queue
import sys
import threading
import wave
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from .. import Device, FrixelError, ParameterError, _frixel
from . import _detection as detection
from ._estimate import Answers, Estimate
from ._folder import ExperimentError, write
from ._methods import ConstantStimuli, Method, QuestPlus, UpDown
from ._observer import Observer
from ._psychometric import TWO_ALTERNATIVES
from ._session import Session, Trial

ARROWS = 8
"""Arrows that show the pace of a stroke."""
POLL_S = 0.05
"""Longest time between calls to the board while an answer is awaited, s."""
WRONG_MAX = 10
"""Number of consecutive answers that are neither 1 nor 2 after which the trials end."""
CHECKS_MAX = 30
"""Largest number of checks: final trials at the largest level, which tell whether the person feels or guesses."""
GUESSED = 1e-3
"""Evidence below which the checks end, because the person guesses."""
NOISE_S, NOISE_HZ = 60, 44_100


def parser() -> argparse.ArgumentParser:
    """The command line."""
    made = argparse.ArgumentParser("python -m frixel.experiment", description=__doc__)
    made.add_argument("folder", type=Path, metavar="FOLDER", help="folder of the session, one per person")
    made.add_argument("--port", help="serial port of the board, or `sim` for the simulated one")
    made.add_argument("--observer", type=int, metavar="SEED", help="let a simulated observer answer, without a board")
    made.add_argument("--participant", default="person", metavar="CODE", help="a code of the person, not a name")
    made.add_argument("--method", choices=["quest", "up-down"], default="quest", help="how levels are chosen")
    made.add_argument(
        "--trials", type=int, default=40, metavar="N", help="12 to 200, then up to 30 checks; %(default)s by default"
    )
    highest = _frixel.VOLTAGE_MAX_V_RMS
    voltage = f"highest voltage, at most {highest:g}"
    made.add_argument("--voltage", type=float, default=highest, metavar="V_RMS", help=voltage)
    made.add_argument("--screen", default="example", help="name of the screen under the finger, for the profile")
    made.add_argument("--seed", type=int, default=1, metavar="N", help="seed of the order of the strokes")
    made.add_argument("--arm", action="store_true", help="let a board that is not simulated drive its electrode")
    made.add_argument("--noise", type=Path, metavar="FILE.wav", help="write a minute of noise for headphones, and end")
    return made


class Board:
    """Plays trials on a board, and reads answers from standard input."""

    def __init__(self, port: str, voltage_v_rms: float, arm: bool) -> None:
        self._scene, self._voltage = detection.scene(voltage_v_rms), voltage_v_rms
        self._device = Device.open(port, arm=arm)
        self._is_playing = False
        self._lines: queue.Queue[str | None] = queue.Queue(64)
        threading.Thread(target=self._read, daemon=True).start()

    def close(self) -> None:
        """Disarm the board."""
        self._device.close()

    def play(self, trial: Trial) -> None:
        """Play the two strokes of a trial, and print their pace: an arrow for each part of a stroke."""
        if not self._is_playing:
            say("  Slide 7 cm to the right while arrows to the right appear, then back with the arrows to the left.")
            say("  Type 1 or 2 and Enter: which of the two strokes was rougher? Guess if you are not sure.")
            self._device.play(self._scene)
            self._is_playing = True
        say(f"  trial {trial.number + 1}: ", end="")
        for place, arrow in enumerate("><"):
            say(f"{place + 1} ", end="")
            self._device.stream(detection.samples(trial.level if place == trial.target else 0.0), detection.SAMPLE_HZ)
            for _ in range(ARROWS):
                say(arrow, end="")
                self._device.wait(detection.STROKE_S / ARROWS)
            say(" ", end="")
        self._device.wait(detection.FADE_S)

    def answer(self, trial: Trial) -> int:
        """The number that the person types, minus one."""
        for _ in range(WRONG_MAX):
            say(" 1 or 2? ", end="")
            line = self._line()
            if line is None:
                raise ExperimentError(f"the answers ended at trial {trial.number + 1}")
            if line.strip() in ("1", "2"):
                return int(line) - 1
        raise ExperimentError(f"{WRONG_MAX} answers to trial {trial.number + 1} were neither 1 nor 2")

    def _line(self) -> str | None:
        while True:
            try:
                return self._lines.get(timeout=POLL_S)
            except queue.Empty:
                # A board disarms itself if its host is silent.
                self._device.wait(POLL_S)

    def _read(self) -> None:
        # Only the first 4,096 characters of a line are kept.
        while line := sys.stdin.readline(4096):
            while not line.endswith("\n") and (rest := sys.stdin.readline(4096)):
                line = line if not rest.endswith("\n") else line + "\n"
            self._lines.put(line)
        self._lines.put(None)


def observer_of(seed: int) -> Observer:
    """An observer whose threshold lies between a hundredth and a half of the largest amplitude."""
    rng = np.random.default_rng([seed, 7])
    noise = math.exp(rng.uniform(math.log(0.008), math.log(0.3)))
    return Observer(noise, lapse=float(rng.uniform(0.0, 0.04)), seed=seed)


def method_of(name: str, trials: int) -> Method:
    """The method `quest` or `up-down`, set up for this many trials."""
    if name == "quest":
        return QuestPlus(detection.LEVELS, TWO_ALTERNATIVES, trials=trials)
    return UpDown(0.3, trials=trials, step=1.4, largest=1.0)


def ask(
    session: Session, method: Method, play: Callable[[Trial], object], answer: Callable[[Trial], int]
) -> tuple[Answers, Estimate]:
    """Run all trials, and then checks at the largest level until they tell feeling from guessing."""
    session.run(method, play, answer)
    for check in range(CHECKS_MAX + 1):
        answers = Answers((row["level"], row["correct"]) for row in session.rows)
        found = session.estimate(answers)
        if found.threshold is not None or found.evidence < GUESSED or check == CHECKS_MAX:
            break
        session.run(ConstantStimuli([1.0], 1), play, answer, block="check")
    return answers, found


def experiment(arguments: argparse.Namespace) -> None:
    """Run the session, and write the profile."""
    highest, trials = arguments.voltage, arguments.trials
    if not 1.0 <= highest <= _frixel.VOLTAGE_MAX_V_RMS:
        raise ParameterError(f"--voltage is 1 to {_frixel.VOLTAGE_MAX_V_RMS:.0f} V rms, found {highest:g}")
    if not 12 <= trials <= 200:
        raise ParameterError(f"--trials is 12 to 200, found {trials}")
    if (arguments.port is None) == (arguments.observer is None):
        raise ParameterError("give --port PATH, or --observer SEED for a simulated observer, who needs no board")
    observer = None if arguments.observer is None else observer_of(arguments.observer)
    settings = {
        "--method": arguments.method,
        "--trials": trials,
        "--voltage": highest,
        "--observer": arguments.observer,
        "--screen": arguments.screen,
    }
    with contextlib.ExitStack() as stack:
        board = None
        if observer is None:
            board = Board(arguments.port, highest, arguments.arm)
            stack.callback(board.close)
        # The log counts trials from 0, and this command from 1.
        logging.getLogger("frixel.experiment").setLevel(logging.ERROR)
        session = stack.enter_context(
            Session(
                arguments.folder,
                arguments.participant,
                TWO_ALTERNATIVES,
                seed=arguments.seed,
                played={option: json.dumps(value) for option, value in settings.items()},
            )
        )
        if session.rows:
            say(f"  resumes after trial {len(session.rows)}, the last one with an answer")

        def play(trial: Trial) -> None:
            if board is not None:
                board.play(trial)

        def answer(trial: Trial) -> int:
            if observer is None:
                assert board is not None
                return board.answer(trial)
            is_right = observer.answers(trial.level, TWO_ALTERNATIVES, trial=trial.number)
            return trial.target if is_right else 1 - trial.target

        answers, found = ask(session, method_of(arguments.method, trials), play, answer)
    if found.threshold is None or found.interval is None:
        raise ExperimentError(str(found))
    checks = len(answers) - trials
    counted = f"{trials} trials and {checks} check{'s' * (checks != 1)}"
    low, threshold, high = (
        float(volts) for volts in detection.voltage_of([found.interval[0], found.threshold, found.interval[1]], highest)
    )
    say(f"\n  threshold        {threshold:.1f} V rms ({low:.1f} to {high:.1f}), of {counted}")
    who = ""
    if observer is not None:
        truth = float(detection.voltage_of(observer.threshold(TWO_ALTERNATIVES), highest))
        say(f"  the observer     has a threshold of {truth:.1f} V rms")
        who = f", simulated observer {arguments.observer}"
    say("  note             the threshold is not a force: write scenes in fractions of the reach")
    name = {"quest": "QUEST+", "up-down": "up-down staircase"}[arguments.method]
    finger = detection.perceptual_finger(
        threshold,
        (low, high),
        method=f"two alternatives, {name}, {counted}, {detection.STIMULUS_HZ:.0f} Hz{who}",
        screen=arguments.screen,
    )
    path = arguments.folder / "finger.toml"
    if path.exists():
        say(f"  already exists   {path}")
        return
    assert finger.text is not None
    write(path, finger.text.encode(), "the profile")
    say(f"  wrote            {path}")


def write_noise(path: Path, seed: int) -> None:
    """Write white noise at a quarter of full scale, which masks the sound of an electrode."""
    noise = np.random.default_rng(seed).integers(-(2**13), 2**13, NOISE_S * NOISE_HZ, dtype=np.int16)
    if path.exists():
        raise ExperimentError(f"{path} already exists: give another name")
    content = io.BytesIO()
    with wave.open(content, "wb") as written:
        written.setnchannels(1)
        written.setsampwidth(2)
        written.setframerate(NOISE_HZ)
        written.writeframes(noise.astype("<i2").tobytes())
    _frixel.write_files({path: content.getvalue()}, False)
    say(f"  wrote            {path}")


def say(text: str, end: str = "\n") -> None:
    """Print without buffering."""
    print(text, end=end, flush=True)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command. Returns its exit code."""
    given = parser().parse_args(arguments)
    try:
        if given.noise is not None:
            write_noise(given.noise, given.seed)
        else:
            experiment(given)
    except FrixelError as error:
        print(f"frixel.experiment: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("frixel.experiment: interrupted; the same command resumes this session", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
