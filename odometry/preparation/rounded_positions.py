"""Positions that were rounded (float32, few digits): their steps as noise of the filter."""

import math
from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.poses.map_lines import drawn_to_lines
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.positions.rounding import steps_m


def with_rounding(
    stamps_s: FloatArray, positions: FloatArray, config: IcrEkfConfig
) -> tuple[IcrEkfConfig, tuple[FilterEvent, ...]]:
    """The settings of a filter whose positions (M, 2) come in steps, and the event of that.

    A position that was rounded to a step is off by up to half of it, with a standard deviation of
    step / sqrt(12). n positions in a row that have the same value are off by nearly the same:
    together they say what one of them says. On a straight line along an axis the other coordinate
    stays off, which no averaging lessens, and the sigmas of an estimate hold that. Unchanged where
    it is less than `position_sigma_m`.
    """
    steps = steps_m(stamps_s, positions)
    off_m = steps / math.sqrt(12)
    sigma_m = float(np.max(off_m * np.sqrt([_in_a_row(column) for column in positions.T])))
    new = np.append(True, (np.diff(positions, axis=0) != 0).any(axis=1))
    if sigma_m <= config.position_sigma_m or drawn_to_lines(positions[new]):
        return config, ()
    step_m, lasting_m = float(steps.max()), float(off_m.max())
    event = FilterEvent(
        "rounded_positions",
        float(stamps_s[0]),
        float(stamps_s[-1]),
        f"positions come in steps of {step_m:.2g} m: their noise in the filter is {sigma_m:.2g} m, "
        f"in place of {config.position_sigma_m:g} m, and the sigmas of x and y hold "
        f"{lasting_m:.2g} m",
        (lasting_m, sigma_m, step_m),
    )
    return replace(
        config,
        position_sigma_m=math.hypot(config.position_sigma_m, sigma_m),
        lasting_sigma_m=max(config.lasting_sigma_m, lasting_m),
        position_step_m=step_m,
    ), (event,)


def _in_a_row(values: FloatArray) -> float:
    """How many values (M,) in a row are the same, median; all where they change once or never."""
    changes = np.flatnonzero(np.diff(values))
    return float(np.median(np.diff(changes))) if len(changes) > 1 else float(len(values))
