"""Experiments with people or simulated observers: choose levels, record answers, and estimate thresholds.

A *method* (:class:`ConstantStimuli`, :class:`UpDown`, :class:`QuestPlus`) chooses the level of each trial. A *task*
(:data:`TWO_ALTERNATIVES`, :data:`SAME_DIFFERENT`) says what a person who feels nothing answers. :func:`estimate` fits
one psychometric function to the answers, by whatever method they were gathered, and refuses to name a threshold for
somebody who guesses. :class:`Session` presents the trials, records what it plays, and keeps every answer on the disk
before the next one. ``python -m frixel.experiment`` finds what a person just feels, at the terminal.

A level is a number from 0 in any one unit, such as volts; of :class:`Observer` it is a relative difference of friction,
so that 0.2 is 20 % more than the standard.
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
