"""`python -m frixel.experiment`, as it is called: in a process of its own, with answers through a pipe."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import wave
from pathlib import Path

import pytest
from frixel import Finger, ParameterError, Scene, model
from frixel.experiment import TWO_ALTERNATIVES, Answers, Observer, estimate, perceptual_finger
from frixel.experiment import _detection as detection

ON_BOARD = ["--port", "sim", "--trials", "12"]


def ran(*arguments: object, answers: str = "") -> subprocess.CompletedProcess[str]:
    """Run the command."""
    command = [sys.executable, "-m", "frixel.experiment", *map(str, arguments)]
    return subprocess.run(command, input=answers, capture_output=True, text=True, timeout=300)


def rows(folder: Path) -> list[dict[str, object]]:
    """The trials of a session."""
    return [json.loads(line) for line in (folder / "trials.jsonl").read_text().splitlines()]


@pytest.mark.parametrize("method", ["quest", "up-down"])
def test_the_threshold_of_a_simulated_observer_is_found(method: str, tmp_path: Path) -> None:
    run = ran(tmp_path / "s", "--observer", 7, "--method", method)
    assert run.returncode == 0, run.stderr
    low, high = map(float, re.findall(r"threshold +\S+ V rms \((\S+) to (\S+)\)", run.stdout)[0])
    (truth,) = re.findall(r"observer +has a threshold of (\S+) V rms", run.stdout)
    assert low < float(truth) < high < 150
    assert re.search(r", of 40 trials and \d+ checks?$", run.stdout, re.MULTILINE)
    finger = Finger.load(tmp_path / "s/finger.toml")
    assert finger.text is not None
    assert "simulated observer 7" in finger.text
    # A scene takes it in place of the example finger, whose numbers it has.
    scene = Scene.from_dict({"layer": [{"kind": "constant", "friction_fraction": 0.5}]})
    assert scene.with_finger(finger).reach_n == scene.with_finger("example").reach_n
    again = ran(tmp_path / "s", "--observer", 7, "--method", method)
    assert "already exists" in again.stdout
    assert Finger.load(tmp_path / "s/finger.toml") == finger


def test_answers_through_a_pipe_are_kept_and_a_session_that_was_cut_off_goes_on(tmp_path: Path) -> None:
    folder = tmp_path / "s"
    short = ran(folder, *ON_BOARD, answers="1\nperhaps\n2\n")
    assert short.returncode == 1
    assert "trial 2: 1 >>>>>>>> 2 <<<<<<<<  1 or 2?" in short.stdout
    assert short.stderr.strip() == "frixel.experiment: the answers ended at trial 3"
    kept = rows(folder)
    assert [row["response"] for row in kept] == [0, 1]
    other = ran(folder, *ON_BOARD, "--voltage", 100)
    assert "belongs to another session: played differs in --voltage: give" in other.stderr
    simulated = ran(folder, "--observer", 3, "--trials", 12)
    assert "belongs to another session" in simulated.stderr, "no simulated answer is among those of a person"
    # Who always says 1 is right in half of the trials.
    guessed = ran(folder, *ON_BOARD, answers="1\n" * 45)
    assert guessed.returncode == 1
    assert "resumes after trial 2" in guessed.stdout
    assert "trial 2:" not in guessed.stdout
    assert "no better than guessing" in guessed.stderr
    assert rows(folder)[:2] == kept
    assert not (folder / "finger.toml").exists()


def test_ten_wrong_answers_end_it(tmp_path: Path) -> None:
    run = ran(tmp_path / "s", *ON_BOARD, answers="x\n" * 12)
    assert "10 answers to trial 1 were neither 1 nor 2" in run.stderr
    run = ran(tmp_path / "s", *ON_BOARD, answers=("x" * 10_000 + "\n") * 9)
    assert "the answers ended at trial 1" in run.stderr


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([], "give --port PATH, or --observer SEED"),
        (["--observer", "1", "--port", "sim"], "who needs no board"),
        (["--port", "nowhere"], "nowhere"),
        (["--observer", "1", "--trials", "11"], "--trials is 12 to 200, found 11"),
        (["--observer", "1", "--voltage", "nan"], "--voltage is 1 to 150 V rms, found nan"),
    ],
)
def test_what_is_not_taken_is_said_in_a_sentence(options: list[str], words: str, tmp_path: Path) -> None:
    run = ran(tmp_path / "s", *options)
    assert run.returncode == 1
    assert run.stderr.startswith("frixel.experiment: ")
    assert words in run.stderr
    assert not (tmp_path / "s").exists()


def test_help_and_noise(tmp_path: Path) -> None:
    assert "--observer" in ran("--help").stdout
    assert ran("--noise", tmp_path / "noise.wav", "unused").returncode == 0
    with wave.open(str(tmp_path / "noise.wav")) as noise:
        assert noise.getnframes() == 60 * noise.getframerate()
    assert "already exists" in ran("--noise", tmp_path / "noise.wav", "unused").stderr
    assert "cannot be written" in ran("--noise", tmp_path / "nowhere" / "noise.wav", "unused").stderr


def test_the_board_drives_the_voltage_of_a_level() -> None:
    scene = detection.scene(120.0)
    natural, most = scene.reach_n
    state = model.eval(detection.CONTACT, 120.0, detection.NORMAL_LOAD_N)
    assert most - natural == pytest.approx(float(state.electric_friction_n), rel=1e-5)
    assert float(detection.voltage_of(1.0, 120.0)) == pytest.approx(120.0)
    stroke = detection.samples(0.25)
    assert stroke.size == detection.STROKE_S * detection.SAMPLE_HZ
    assert stroke[0] == 0.0
    assert stroke.max() == pytest.approx(0.25, rel=5e-3)


def test_answers_of_a_guesser_are_no_threshold() -> None:
    guesser = Observer(float("inf"), lapse=0.0, seed=3)
    answers = Answers((level, guesser.answers(level, TWO_ALTERNATIVES)) for level in detection.LEVELS * 2)
    assert estimate(answers, TWO_ALTERNATIVES).threshold is None


def test_a_profile_needs_an_interval_around_its_threshold() -> None:
    text = perceptual_finger(22, (19, 26), method="of my own", screen="lab").text
    assert text is not None
    assert "threshold_interval_v_rms = [19.0, 26.0]" in text
    for interval in ((23, 26), (26, 19), (19,), 19):
        with pytest.raises(ParameterError, match="interval_v_rms"):
            perceptual_finger(22, interval, method="of my own")  # type: ignore[arg-type]
