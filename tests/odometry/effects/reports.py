"""Poses as a reference reports them, each tenth of a second."""

import numpy as np

from odometry.effects.interface.recorded import Reported

PERIOD_S = 0.1


def reported(poses, run=None):
    return Reported(PERIOD_S * np.arange(len(poses)), poses, run)


def at_stamps(stamps_s):
    """A robot that stood while these stamps were given."""
    return Reported(stamps_s, np.zeros((len(stamps_s), 3)))
