"""Coverage of the stated intervals, and the share of guessers who get a threshold.

``python -m frixel.experiment.coverage`` prints a row for each method and task.
"""

from __future__ import annotations

import argparse
import math

import numpy as np

from ._estimate import Answers, Estimate, estimate
from ._methods import ConstantStimuli, Method, QuestPlus, UpDown
from ._observer import Observer
from ._psychometric import SAME_DIFFERENT, TWO_ALTERNATIVES, Grid, Task

LEVELS = [float(level) for level in np.geomspace(0.01, 1.5, 24)]
TRIALS = 90


def methods(task: Task, seed: int) -> dict[str, Method]:
    """The methods, each with the same number of trials."""
    constant = [float(level) for level in np.geomspace(0.03, 0.9, 9)]
    return {
        "constant stimuli": ConstantStimuli(constant, TRIALS // len(constant), seed=seed),
        "up-down": UpDown(0.8, trials=TRIALS),
        "QUEST+": QuestPlus(LEVELS, task, trials=TRIALS, grid=COARSE),
    }


COARSE = Grid(np.geomspace(0.002, 3.0, 41), np.geomspace(0.8, 3.0, 4), np.array([0.0, 0.02]))
"""A grid that is fine enough to choose levels."""


def run(method: Method, observer: Observer, task: Task) -> Estimate:
    """Asks an observer by a method, with a catch trial after every fifth trial if the guess rate is unknown."""
    answers = Answers()
    number = 0
    while (level := method.next_level()) is not None:
        correct = observer.answers(level, task)
        method.answer(level, correct)
        answers.add(level, correct)
        number += 1
        if not task.is_guess_rate_known and number % 5 == 0:
            answers.add(0.0, observer.answers(0.0, task))
    return estimate(answers, task)


def drawn(seed: int) -> Observer:
    """An observer with a threshold around published ones for steps of friction, 11 to 27 %."""
    rng = np.random.default_rng([seed, 7])
    return Observer(float(np.exp(rng.normal(math.log(0.12), 0.4))), lapse=float(rng.uniform(0.0, 0.05)), seed=seed)


def measure(task: Task, name: str, seeds: range) -> tuple[float, float, int, int]:
    """Coverage of the intervals, mean error of ln(threshold), refusals, and guessers with a threshold."""
    covered, errors, refused, fooled = 0, [], 0, 0
    for seed in seeds:
        observer = drawn(seed)
        found = run(methods(task, seed)[name], observer, task)
        if found.threshold is None or found.interval is None:
            refused += 1
        else:
            truth = observer.threshold(task)
            covered += found.interval[0] <= truth <= found.interval[1]
            errors.append(math.log(found.threshold / truth))
        guesser = Observer(math.inf, lapse=0.0, seed=seed)
        fooled += run(methods(task, seed)[name], guesser, task).threshold is not None
    return covered / max(len(seeds) - refused, 1), float(np.mean(errors)), refused, fooled


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--people", type=int, default=1000)
    parser.add_argument("--first", type=int, default=1000, help="seed of the first observer; 0 to 999 are for tuning")
    arguments = parser.parse_args()
    seeds = range(arguments.first, arguments.first + arguments.people)
    print("task,method,observers,coverage,bias_of_ln_threshold,refused,guessers_with_a_threshold")
    for task in (TWO_ALTERNATIVES, SAME_DIFFERENT):
        for name in methods(task, 0):
            coverage, bias, refused, fooled = measure(task, name, seeds)
            print(f"{task.name},{name},{len(seeds)},{coverage:.3f},{bias:+.3f},{refused},{fooled}", flush=True)


if __name__ == "__main__":
    main()
