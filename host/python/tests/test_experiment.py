"""Methods, estimates, and the simulated observer."""

import doctest
import io
import itertools
import math
import re
from typing import Any

import numpy as np
import pytest
from frixel import ParameterError
from frixel.experiment import (
    SAME_DIFFERENT,
    TWO_ALTERNATIVES,
    Answers,
    ConstantStimuli,
    Grid,
    Method,
    Observer,
    QuestPlus,
    Task,
    UpDown,
    _estimate,
    estimate,
    magnitude_exponent,
)
from frixel.experiment.coverage import LEVELS, measure, methods
from numpy.typing import NDArray

from .conftest import REPOSITORY


def level_of(method: Method) -> float:
    """The next level of a method that has not ended."""
    level = method.next_level()
    assert level is not None
    return level


def test_every_level_of_constant_stimuli_comes_once_in_each_round() -> None:
    method = ConstantStimuli([0.1, 0.2, 0.4], 4, seed=3)
    levels = []
    while (level := method.next_level()) is not None:
        levels.append(level)
        method.answer(level, True)
    assert [sorted(levels[start : start + 3]) for start in range(0, 12, 3)] == [[0.1, 0.2, 0.4]] * 4
    assert len({tuple(levels[start : start + 3]) for start in range(0, 12, 3)}) > 1


@pytest.mark.parametrize("levels", [[[0.1, 0.2], [0.1, 0.3]], 0.1, []])
def test_levels_are_a_list(levels: Any) -> None:
    for make in (lambda: QuestPlus(levels, TWO_ALTERNATIVES, trials=5), lambda: ConstantStimuli(levels, 5)):
        with pytest.raises(ParameterError, match="levels must be a list of 1 to 1000 numbers, but is"):
            make()


def test_a_staircase_goes_down_after_so_many_right_answers_and_up_after_a_wrong_one() -> None:
    method = UpDown(0.8, trials=20, down=3, step=1.25)
    levels = []
    for correct in [True] * 6 + [False] + [True] * 3:
        levels.append(level_of(method))
        method.answer(0.0, correct)
    fast, slow = 1.25**2, 1.25
    down_twice = 0.8 / fast / fast
    expected = [0.8] * 3 + [0.8 / fast] * 3 + [down_twice] + [down_twice * slow] * 3
    assert levels == pytest.approx(expected)
    assert method.next_level() == pytest.approx(down_twice)


def test_a_staircase_gathers_where_levitt_says() -> None:
    observer = Observer(0.12, lapse=0.0, seed=5)
    method = UpDown(0.8, trials=6000, down=2, step=1.1)
    levels = []
    for _ in range(6000):
        level = level_of(method)
        levels.append(level)
        method.answer(level, observer.answers(level, TWO_ALTERNATIVES))
    middle = float(np.exp(np.mean(np.log(levels[1000:]))))
    assert observer.correct_share(middle, TWO_ALTERNATIVES) == pytest.approx(0.707, abs=0.02)


def test_quest_plus_chooses_what_leaves_the_least_entropy() -> None:
    grid = Grid(np.geomspace(0.01, 1.0, 12), np.array([1.0, 2.0]), np.array([0.0, 0.04]))
    method = QuestPlus(LEVELS, TWO_ALTERNATIVES, trials=5, grid=grid)
    for correct in [True, False, True]:
        method.answer(level_of(method), correct)
    prior = method.posterior.ravel()

    def entropy(density: NDArray[np.float64]) -> float:
        return -float(np.sum(density * np.log(np.maximum(density, 1e-300))))

    def left(level: float) -> float:
        right = grid.correct(level, TWO_ALTERNATIVES).ravel()
        share = float(right @ prior)
        return share * entropy(right * prior / share) + (1 - share) * entropy((1 - right) * prior / (1 - share))

    assert method.next_level() == min(LEVELS, key=left)
    assert method.expected_information() == pytest.approx([entropy(prior) - left(level) for level in LEVELS], abs=1e-9)


def test_quest_plus_agrees_with_another_implementation() -> None:
    questplus = pytest.importorskip("questplus", reason="questplus is not installed: pip install questplus")
    thresholds, slopes, lapses = np.geomspace(0.01, 1.0, 15), np.array([1.0, 1.6, 2.5]), np.array([0.0, 0.04])
    levels = [float(level) for level in np.geomspace(0.02, 0.9, 10)]
    for seed in range(SEQUENCES):
        own = QuestPlus(levels, TWO_ALTERNATIVES, trials=20, grid=Grid(thresholds, slopes, lapses))
        other = questplus.QuestPlus(
            stim_domain={"intensity": levels},
            param_domain={"threshold": thresholds, "slope": slopes, "lower_asymptote": [0.5], "lapse_rate": lapses},
            outcome_domain={"response": ["right", "wrong"]},
            func="weibull",
            stim_scale="linear",
        )
        observer = Observer(0.12, seed=seed)
        for _ in range(20):
            level = level_of(own)
            assert other.next_stim["intensity"] == pytest.approx(level)
            correct = observer.answers(level, TWO_ALTERNATIVES)
            own.answer(level, correct)
            other.update(stim={"intensity": level}, outcome={"response": "right" if correct else "wrong"})
        theirs = other.posterior.squeeze().transpose("threshold", "slope", "lapse_rate").values
        assert own.posterior[..., 0] == pytest.approx(theirs, abs=1e-9)


SEQUENCES = 5


def test_psignifit_reads_the_table_and_finds_the_same_threshold() -> None:
    psignifit = pytest.importorskip("psignifit", reason="psignifit is not installed: pip install psignifit")
    observer = Observer(0.12, lapse=0.0, seed=2)
    answers = Answers()
    method = ConstantStimuli([0.03, 0.08, 0.15, 0.3, 0.6], 80, seed=2)
    while (level := method.next_level()) is not None:
        correct = observer.answers(level, TWO_ALTERNATIVES)
        method.answer(level, correct)
        answers.add(level, correct)
    found = estimate(answers, TWO_ALTERNATIVES)
    fitted = psignifit.psignifit(
        np.array(answers.table), experiment_type="2AFC", sigmoid="weibull", stimulus_range=[0.02, 1.0]
    )
    # At our place on the way from guessing to always right: theirs is in the middle.
    theirs, intervals = fitted.threshold(1 - math.exp(-1), unscaled=True)
    assert found.interval is not None
    assert found.threshold is not None
    low, high = intervals["0.95"]
    assert found.interval[0] < theirs < found.interval[1]
    assert low < found.threshold < high


@pytest.mark.parametrize("task", [TWO_ALTERNATIVES, SAME_DIFFERENT], ids=lambda task: task.name)
@pytest.mark.parametrize("name", list(methods(TWO_ALTERNATIVES, 0)))
def test_intervals_contain_the_truth_and_guessers_get_no_threshold(task: Task, name: str) -> None:
    people = 60
    coverage, bias, refused, fooled = measure(task, name, range(2000, 2000 + people))
    # Of 60 intervals that contain the truth with 95 %, fewer than 51 do once in 1,600 runs.
    assert coverage * (people - refused) >= 51 - refused
    assert abs(bias) < 0.2
    # Where false alarms have to be found out as well, evidence of 90 trials is short for one observer in eight.
    assert refused <= (4 if task == TWO_ALTERNATIVES else 15)
    # Of 60 guessers, at most one in 1,000 each: more than 1 is fooled once in 570 runs.
    assert fooled <= 1


def test_an_observer_that_compares_frictions_is_right_as_often_as_one_that_compares_levels() -> None:
    observer = Observer(0.12, lapse=0.0, seed=9)
    right = sum(observer.stronger(0.28, 0.28 * 1.15) for _ in range(4000)) / 4000
    # Four standard deviations of a share of 4,000.
    assert right == pytest.approx(observer.correct_share(0.15, TWO_ALTERNATIVES), abs=0.026)


def of_counts(rows: list[tuple[float, int, int]]) -> Answers:
    """Answers of (level, correct, total)."""
    return Answers((level, number < right) for level, right, total in rows for number in range(total))


@pytest.mark.parametrize("unit", [1e-9, 1.0, 20.0, 1e12])
def test_thresholds_are_found_in_any_unit(unit: float) -> None:
    clear = of_counts([(unit, 18, 30), *((factor * unit, 30, 30) for factor in (2, 3, 4, 5))])
    found = estimate(clear, TWO_ALTERNATIVES).threshold
    assert found is not None
    assert 1.05 < found / unit < 1.55
    levels, right = (0.5, 1, 2, 3, 4), (17, 18, 23, 27, 29)
    rows = [(level * unit, count, 30) for level, count in zip(levels, right, strict=True)]
    slow = estimate(of_counts(rows), TWO_ALTERNATIVES)
    assert slow.threshold is not None
    assert slow.interval is not None
    assert 1.55 < slow.threshold / unit < 3
    assert 1.5 < slow.interval[0] / unit < 2.2 < slow.interval[1] / unit < 3.1


def test_every_method_takes_levels_of_any_unit() -> None:
    for unit in (1e-9, 25.0, 1e12):
        threshold = 2 * unit
        all_methods: list[Method] = [
            ConstantStimuli([unit, 2 * unit, 4 * unit], 10),
            UpDown(8 * unit, trials=30),
            QuestPlus([unit, 2 * unit, 4 * unit], TWO_ALTERNATIVES, trials=30),
        ]
        for method in all_methods:
            levels = []
            while (level := method.next_level()) is not None:
                levels.append(level)
                method.answer(level, level >= threshold)
            assert len(levels) == 30
            assert min(levels) < threshold < 2 * max(levels)


@pytest.mark.parametrize("answer", ["False", "0", -1, 0, 1, 1.0, None])
def test_an_answer_is_true_or_false(answer: Any) -> None:
    with pytest.raises(ParameterError, match="correct must be True or False, but is"):
        Answers([(0.2, answer)])
    with pytest.raises(ParameterError, match="correct must be True or False, but is"):
        UpDown(0.5, trials=3).answer(0.5, answer)
    assert Answers([(0.2, np.bool_(True)), (0.2, np.False_)]).table == [(0.2, 1, 2)]


def test_the_answer_of_an_observer_to_a_trial_is_the_same_after_a_resume() -> None:
    whole, resumed = Observer(0.12, seed=3), Observer(0.12, seed=3)
    answers = [whole.stronger(0.28, 0.29, trial=number) for number in range(40)]
    assert [resumed.stronger(0.28, 0.29, trial=number) for number in range(20, 40)] == answers[20:]
    assert len(set(answers)) == 2


def test_a_guesser_is_told_so() -> None:
    observer = Observer(math.inf, lapse=0.0, seed=4)
    found = estimate(
        Answers((level, observer.answers(level, TWO_ALTERNATIVES)) for level in LEVELS * 4), TWO_ALTERNATIVES
    )
    assert found.threshold is None
    assert found.interval is None
    assert str(found).startswith("no better than guessing: 96 trials are ")
    assert str(estimate(Answers(), TWO_ALTERNATIVES)).startswith("no better than guessing: 0 trials")


def test_guessing_is_as_likely_as_the_average_of_all_answers_to_it() -> None:
    # Over every series of answers of one who guesses, the likelihood ratio has a mean of 1: so says Ville's inequality.
    levels = [0.05, 0.1, 0.2, 0.4]
    series = itertools.product([False, True], repeat=len(levels))
    grid = Grid.around(levels)
    ratios = [
        estimate(Answers(zip(levels, answers, strict=True)), TWO_ALTERNATIVES, grid).evidence for answers in series
    ]
    assert np.mean(ratios) == pytest.approx(1.0, abs=1e-9)


def test_levels_that_are_all_felt_bound_a_threshold_on_one_side_only() -> None:
    found = estimate(Answers([(0.5, True)] * 40), TWO_ALTERNATIVES)
    assert found.threshold is not None
    assert not found.is_bounded
    assert "present others" in str(found)


def test_the_threshold_of_an_observer_is_where_its_answers_say() -> None:
    observer = Observer(0.1)
    for task in (TWO_ALTERNATIVES, SAME_DIFFERENT):
        guess = observer.correct_share(0.0, task)
        share = observer.correct_share(observer.threshold(task), task)
        assert share == pytest.approx(guess + (1 - guess) * (1 - math.exp(-1)))
    assert math.isnan(observer.threshold(task)) is False
    with pytest.raises(ValueError, match=r"noise must be above 0 and at most 1 \(.*\), or infinite, but is 0"):
        Observer(0.0)
    with pytest.raises(ParameterError, match="or infinite, but is 6"):
        Observer(6)
    for felt_n in (0.0, math.nan):
        with pytest.raises(ParameterError, match="second_n must be a number above 0, but is"):
            observer.stronger(0.3, felt_n)


def test_an_exponent_is_recovered_with_its_interval() -> None:
    rng = np.random.default_rng(1)
    levels = np.repeat(np.geomspace(0.05, 0.8, 6), 8)
    ratings = 10.0 * levels**0.8 * np.exp(rng.normal(0.0, 0.15, levels.size))
    exponent, (low, high) = magnitude_exponent(levels, ratings)
    assert low < 0.8 < high
    assert high - low < 0.15
    assert low < exponent < high
    for wrong in ([0.0, 1.0, 2.0], [1.0, 1.0, 2.0]):
        with pytest.raises(ValueError, match=r"above zero|three levels"):
            magnitude_exponent(wrong, [1.0, 2.0, 3.0])


def test_the_table_of_answers_is_that_of_psignifit() -> None:
    answers = Answers([(0.2, True), (0.1, False), (0.2, False), (0.1, True), (0.2, True)])
    assert answers.table == [(0.1, 1, 2), (0.2, 2, 3)]
    file = io.StringIO()
    answers.write_csv(file)
    assert file.getvalue() == "level,correct,total\n0.1,1,2\n0.2,2,3\n"
    with pytest.raises(ValueError, match="a number from 0"):
        answers.add(float("nan"), True)


# The document


def test_the_experiment_of_the_document_finds_its_observers(capsys: pytest.CaptureFixture[str]) -> None:
    text = (REPOSITORY / "docs/python/experiments.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    exec(compile(block, "docs/python/experiments.md", "exec"), {})
    lines = capsys.readouterr().out.splitlines()
    numbers = [re.search(r"threshold (\S+), (\S+) to (\S+) ", line) for line in lines]
    intervals = [(float(found[2]), float(found[3])) for found in numbers if found]
    assert len(intervals) == len(lines) == 10
    # Of ten intervals of 95 %, fewer than seven contain the truth once in 1,000 runs.
    assert sum(low < Observer(0.06).threshold(TWO_ALTERNATIVES) < high for low, high in intervals) >= 7


def test_the_examples_in_docstrings_are_true() -> None:
    assert doctest.testmod(_estimate) == doctest.TestResults(failed=0, attempted=6)
