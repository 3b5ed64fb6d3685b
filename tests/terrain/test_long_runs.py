"""What is computed of a long run takes in memory, by row of odometry."""

import tracemalloc

import numpy as np
import pytest

from odometry.estimation.estimate import Estimate, Innovation
from odometry.estimation.kept_estimates import KeptEstimates
from odometry.evaluation.odometer_uncertainty import odometer_uncertainty
from odometry.evaluation.score import reference_of
from odometry.parameters import ParameterSet
from odometry.recording.run import Run
from odometry.replays.estimates import Replay
from terrain.config import Config
from terrain.result.run_result import RunResult

MOST_BYTES = 175  # a row: 10 million of them, and 250 MB of libraries, are 2 GB
STEP_S, EVERY = 0.02, 50  # a pose every second


def long_run(make_run, rows):
    """A robot that winds about, each row an estimate that knows it, with poses once a second."""
    t = STEP_S * np.arange(rows)
    left, right = 0.8 + 0.3 * np.sin(t / 7), 0.8 + 0.3 * np.cos(t / 11)
    poses = np.column_stack([0.8 * t, np.sin(t / 5), 0.1 * np.sin(t / 3)])
    columns = np.column_stack([t, left, right, (right - left) / 0.8])
    rows_of = {
        "odometry": "t,v_left,v_right,gyro_z\n"
        + "".join("{:.2f},{:.4f},{:.4f},{:.4f}\n".format(*row) for row in columns),
        "pose": "t,x,y,yaw\n"
        + "".join(
            "{:.2f},{:.4f},{:.4f},{:.4f}\n".format(stamp, *pose)
            for stamp, pose in zip(t[::EVERY], poses[::EVERY], strict=True)
        ),
    }
    run = Run.read(make_run(**rows_of))
    sure, measured = 1e-4 * np.eye(9), Innovation(np.zeros(3), 1.0, accepted=True)
    states = np.tile([0.0, 0.0, 0.0, 0.4, -0.4, 0.0, 0.0, 1.0, 1.0], (rows, 1))
    states[:, :3] = poses
    estimates = KeptEstimates(
        Estimate(
            stamp_s,
            states[row],
            sure,
            columns[row, 1:3],
            "grass",
            yaw_rate_rad_s=columns[row, 3],
            believed_yaw_rate_rad_s=columns[row, 3],
            innovation=measured if row % EVERY == 0 else None,
        )
        for row, stamp_s in enumerate(t.tolist())
    )
    return run, Replay(estimates)


def peak_bytes(make_run, rows):
    """Of what is made of estimates that lie on disk, beside the run itself."""
    run, replay = long_run(make_run, rows)
    name, reference = reference_of(run)
    tracemalloc.start()
    known = ParameterSet()
    uncertainty = odometer_uncertainty(run, replay)
    result = RunResult(
        run, Config(), known, "grass", None, replay, name, reference, known, uncertainty
    )
    assert result.scores
    for _ in uncertainty.covariance_blocks():
        pass
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


@pytest.mark.slow
def test_what_is_computed_of_a_long_run_takes_few_bytes_a_row(make_run):
    few, many = (peak_bytes(make_run, rows) for rows in (10_000, 30_000))
    assert (many - few) / 20_000 < MOST_BYTES - 40  # the table of odometry takes 40
