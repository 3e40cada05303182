"""Experiments with people or simulated observers: choose levels, record answers, and estimate thresholds.

A *method* (:class:`ConstantStimuli`, :class:`UpDown`, :class:`QuestPlus`) chooses the level of each trial. A *task*
(:data:`TWO_ALTERNATIVES`, :data:`SAME_DIFFERENT`) has the guess rate: the share of correct answers from a person who
feels nothing. :func:`estimate` fits one psychometric function to the answers, whatever the method, and gives no
threshold for a person who guesses. :class:`Session` presents the trials, records its plays, and writes every answer to
the disk before the next trial. ``python -m frixel.experiment`` finds a detection threshold at the terminal.

A level is a number from 0 in any one unit, such as volts. For :class:`Observer`, it is a relative difference of
friction: 0.2 is 20 % more than the standard.
"""

from ._detection import perceptual_finger
from ._estimate import Answers, Estimate, magnitude_exponent
from ._estimate import estimate as estimate
from ._folder import ExperimentError
from ._methods import ConstantStimuli, Method, QuestPlus, UpDown
from ._observer import Observer
from ._psychometric import SAME_DIFFERENT, TWO_ALTERNATIVES, Grid, Task
from ._session import Session, Trial

__all__ = [
    "SAME_DIFFERENT",
    "TWO_ALTERNATIVES",
    "Answers",
    "ConstantStimuli",
    "Estimate",
    "ExperimentError",
    "Grid",
    "Method",
    "Observer",
    "QuestPlus",
    "Session",
    "Task",
    "Trial",
    "UpDown",
    "estimate",
    "magnitude_exponent",
    "perceptual_finger",
]
