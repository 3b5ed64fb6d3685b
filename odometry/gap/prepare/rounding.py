"""Rounding of the reference, which is counted as its noise."""

from collections.abc import Sequence

import numpy as np

from odometry.positions.rounding import LEAST_STEP_M, exact_steps_m, rounding_step_m
from odometry.recording.run import Run
from odometry.windows.dense.dense import DenseWindows


def rounded_m(run: Run) -> float:
    """Step to which measured positions of a run were rounded; 0 where no rounding is detected.

    That of which all are multiples: in a coarse step a slow robot stays for longer than the
    neighbours last by which others are found, and a part of it is found then.
    """
    if run.pose is None:
        return 0.0
    positions = run.pose.stack("x", "y")
    known = np.isfinite(positions).all(axis=1)
    exact_m = float(exact_steps_m(positions[known]).max())
    if exact_m >= LEAST_STEP_M:
        return exact_m
    return rounding_step_m(run.pose.stamps_s[known], positions[known])


def rounding_notes(*groups: Sequence[DenseWindows]) -> tuple[str, ...]:
    """What a reader should know of runs with rounded positions, each run once."""
    said = (
        f"{one.run.folder.name}: positions are rounded to {one.rounded_m:.2g} m, which counts as "
        "noise of the reference"
        for scenes in groups
        for one in scenes
        if one.rounded_m
    )
    return tuple(dict.fromkeys(said))
