"""Runs without the poses that are no measurement, or cut where the reference jumped."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from odometry.arrays import BoolArray
from odometry.effects.reference_outliers import JumpingPoses
from odometry.gap.isolated import Isolated
from odometry.gap.jumps import Jumps
from odometry.gap.outliers import Outliers
from odometry.run import Run


def cleaned_runs(
    measured: Sequence[Run], held_out: Sequence[Run], outliers: Outliers
) -> tuple[list[Run], list[Run]]:
    """The runs without these poses, or cut before each where it is good by itself."""
    jumping = isinstance(outliers.named.effect, JumpingPoses)
    without = cut_before if jumping else left_out
    return (
        [without(run, one) for run, one in zip(measured, outliers.measured, strict=True)],
        [without(run, one) for run, one in zip(held_out, outliers.held_out, strict=True)],
    )


def left_out(run: Run, found: Isolated | Jumps) -> Run:
    """The run without these poses."""
    if run.pose is None:
        return run
    return replace(run, pose=run.pose.rows(np.flatnonzero(~_off(run, found))))


def cut_before(run: Run, found: Isolated | Jumps) -> Run:
    """The run with a new `window` of its poses from each of these on."""
    if run.pose is None:
        return run
    steps = np.cumsum(_off(run, found)).astype(np.float64)
    if "window" in run.pose:
        _, numbers = np.unique(run.pose.columns["window"], return_inverse=True)
        steps = steps + (len(steps) + 1.0) * numbers
    columns = {**run.pose.columns, "window": steps}
    return replace(run, pose=replace(run.pose, columns=columns))


def _off(run: Run, found: Isolated | Jumps) -> BoolArray:
    """Which poses of a run (M,) are among those found."""
    pose_s = run.pose.stamps_s if run.pose is not None else np.empty(0)
    stamps_s = np.round(pose_s - run.odometry.stamps_s[0], 6)
    return np.asarray(np.isin(stamps_s, np.round(found.stamps_s[found.off], 6)))
