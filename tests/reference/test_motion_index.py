"""Errors per metre on real recordings against those that their makers computed.

INDEX.csv of the recordings has, for each run, the mean error per metre of wheel travel over 2 m
windows, of the ideal differential drive and of a symmetric ICR fit. The two cut their windows
elsewhere and interpolate poses differently, so single runs differ by some per cent.
"""

import csv

import numpy as np
import pytest

from odometry.dead_reckoning import dead_reckon
from odometry.evaluation.relative import EvaluationConfig
from odometry.evaluation.score import reference_of, score
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.recording.run import Run

WINDOWS = EvaluationConfig(horizon_m=2.0, stride_m=2.0)


def scored(run, model, **values):
    model = MODELS[model]
    speeds = run.odometry.stack("v_left", "v_right")
    twists = model.twist(model.pack(values), Inputs(speeds))
    open_loop = dead_reckon(run.odometry.stamps_s, twists, np.zeros(3))
    return score(run, open_loop, reference_of(run)[1], WINDOWS)


@pytest.fixture(scope="module")
def ratios(shared_data):
    """Ours over theirs, (runs, 3): ideal translation, ICR translation and rotation."""
    folder = shared_data / "motion"
    found = []
    with (folder / "INDEX.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            run = Run.read(folder / row["run"])
            if run.pose is None:
                continue
            ideal = scored(run, "differential_drive", track_width=run.robot.track_width)
            fitted = scored(
                run, "icr_symmetric", alpha=float(row["alpha"]), b_hat=float(row["b_hat"])
            )
            assert abs(ideal.windows - float(row["n_win"])) <= 5
            found.append(
                [
                    ideal.mean_translation_per_m / float(row["ideal_te_per_m"]),
                    fitted.mean_translation_per_m / float(row["icr_te_per_m"]),
                    fitted.mean_rotation_deg_per_m / float(row["icr_he_deg_per_m"]),
                ]
            )
    return np.array(found)


def test_the_runs_agree_in_the_median(ratios):
    assert len(ratios) == 26
    np.testing.assert_allclose(np.median(ratios, axis=0), 1, atol=0.03)


def test_each_run_agrees_roughly(ratios):
    np.testing.assert_allclose(ratios[:, 0], 1, atol=0.15)
    np.testing.assert_allclose(ratios[:, 1:], 1, atol=0.4)
