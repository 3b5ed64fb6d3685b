"""The inputs of a model from a recorded run."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.gaps import fill_gaps, level_where_missing
from odometry.models.inputs import Inputs
from odometry.run import Run


def inputs_of(run: Run) -> Inputs:
    """What a model is told at each row (N,) of odometry.csv.

    Empty cells of roll, pitch and accelerations are interpolated in time and held at the ends.
    Roll and pitch are level where they were not recorded; accelerations are None unless both
    were.
    """
    speeds = run.odometry.stack("v_left", "v_right")
    return Inputs(speeds, *attitude_of(run), _accelerations(run))


def attitude_of(run: Run) -> tuple[FloatArray, FloatArray]:
    """Roll and pitch (N,) at each row of odometry.csv, as `inputs_of` fills them."""
    roll, pitch = (
        level_where_missing(run.odometry.stamps_s, run.odometry.columns.get(name))
        for name in ("roll", "pitch")
    )
    return roll, pitch


def _accelerations(run: Run) -> FloatArray | None:
    columns = [run.odometry.columns.get(name) for name in ("accel_x", "accel_y")]
    recorded = [column for column in columns if column is not None and not np.isnan(column).all()]
    if len(recorded) < len(columns):
        return None
    return np.stack([fill_gaps(run.odometry.stamps_s, column) for column in recorded], axis=-1)
