"""Errors of models at one place, and differences of them, written down by hand."""

import numpy as np

from odometry.comparison.evaluation import Evaluation
from odometry.comparison.statistics import Difference, Interval
from odometry.comparison.summary import Place
from odometry.windows.window_errors import WindowErrors

PLACE = Place("rover", "grass", 2.0)


class Counted(list):
    """Stands for windows of which only the number matters."""


def evaluation(run, **models):
    """Errors by model: translation in m per m, rotation in degrees per m ten times that."""
    errors = {
        name: WindowErrors(np.array(values), np.radians(10 * np.array(values)))
        for name, values in models.items()
    }
    count = len(next(iter(models.values())))
    return Evaluation("rover", "grass", run, "others", 2.0, Counted([0] * count), errors)


def difference(first, second, mean, low, high, *, quantity="translation"):
    return Difference(PLACE, quantity, first, second, 60, Interval(mean, low, high))
